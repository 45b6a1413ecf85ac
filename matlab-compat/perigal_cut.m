function perigal_cut (h, bonds)
% PERIGAL_CUT  Cut bonds of a session, between two steps.
%
%   PERIGAL_CUT (H, BONDS): numbers of bonds, or a logical mask over all of them, as in perigal_get (H, 'bonds'); bonds
%   between points are cut in both directions. Before the first step it is as if they had never been there; later their
%   energy counts as dissipated. They are not counted as broken. Not where cracks grow by facets; after the first step not
%   with event stepping or contact.
%
%   Errors: perigal:argument.
%
%   Example
%     h = perigal_session ('data/kalthoff/scene.yaml', 'set', {'spacing', '4 mm'});
%     b = perigal_get (h, 'bonds');
%     x = perigal_get (h, 'place');
%     perigal_cut (h, find (b.set == 1 & (b.place(:, 2) < 20e-3) ~= (x(b.point, 2) < 20e-3)))
%     perigal_close (h)
%
%   See also PERIGAL_GET, PERIGAL_SESSION.

    if nargin < 2
        error ('perigal:argument', 'perigal_cut: needs a session and bonds');
    end
    if islogical (bonds)
        info = call_mex ('about', h);
        if numel (bonds) ~= info.bonds
            error ('perigal:argument', 'perigal_cut: a mask has an entry for each of the %d bonds', info.bonds);
        end
        bonds = find (bonds);
    end
    if ~isnumeric (bonds) || ~isreal (bonds)
        error ('perigal:argument', 'perigal_cut: bonds must be numbers or a logical mask');
    end
    call_mex ('cut', h, double (bonds(:)));
end

% SPDX-License-Identifier: GPL-3.0-or-later
