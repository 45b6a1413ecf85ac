function [f, W] = perigal_bond_force (h, u)
% PERIGAL_BOND_FORCE  Forces of bonds on points, or on an array, for displacements.
%
%   [F, W] = PERIGAL_BOND_FORCE (H, U): U (m) and F (N) are points x coordinates, W (J/m3) is the stored energy density of
%   each point. H is a handle of PERIGAL_BONDS or what PERIGAL_FCBM returned: then U and F have the size of its mask with
%   one more dimension, (y, x, [z,] component), and W the size of the mask; outside of the mask U is not read and F and W
%   are 0.
%
%   Errors: perigal:argument (shapes, displacements that are not finite, no open handle).
%
%   Example
%     op = perigal_fcbm (true (20, 30), 1e-3, '3 spacing', 5e20, 'thickness', 1e-3);
%     f = perigal_bond_force (op, 1e-6 * rand (20, 30, 2));
%
%   See also PERIGAL_BONDS, PERIGAL_FCBM.

    who = 'perigal_bond_force';
    if nargin < 2
        error ('perigal:argument', '%s: needs a handle and displacements', who);
    end
    if ~isnumeric (u) || ~isreal (u)
        error ('perigal:argument', '%s: displacements must be real numbers', who);
    end
    u = double (full (u));
    if ~isstruct (h)
        if nargout > 1
            [f, W] = call_mex ('bonds_force', h, u);
        else
            f = call_mex ('bonds_force', h, u);
        end
        return;
    end
    sites = prod (h.size);
    if numel (u) ~= sites * h.dimension || ~isequal (size (u), [h.size, h.dimension])
        error ('perigal:argument', '%s: displacements are %s, not %s', who, mat2str (size (u)), mat2str ([h.size, h.dimension]));
    end
    u = reshape (u, sites, h.dimension);
    [part, energy] = call_mex ('bonds_force', h.handle, u(h.site, :));
    f = zeros (sites, h.dimension);
    f(h.site, :) = part;
    f = reshape (f, [h.size, h.dimension]);
    W = zeros (h.size);
    W(h.site) = energy;
end

% SPDX-License-Identifier: GPL-3.0-or-later
