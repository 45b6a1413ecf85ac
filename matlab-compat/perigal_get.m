function [value, unit] = perigal_get (h, name)
% PERIGAL_GET  What a session is, and its fields.
%
%   INFO = PERIGAL_GET (H): title, dimension, points, unknowns, bonds, spacing, horizon, thickness, force, solver,
%   time_step, loads (names), place (m), point_volume (m3), step, time, load_factor, broken, done, energies (J), warnings.
%   V = PERIGAL_GET (H, NAME) with the name of one of these returns it alone.
%   [V, UNIT] = PERIGAL_GET (H, FIELD) returns a field, points x components: 'displacement', 'velocity', 'damage', 'strain',
%   'stress' (2D: xx yy xy; 3D: xx yy zz xy yz zx), 'rotation', 'coefficient', 'error_estimate', as far as the force has it.
%   V = PERIGAL_GET (H, 'd'), 'v', 'a': all unknowns, point by point; 'alive': a flag for each bond; 'bonds': a structure with
%   their set (1 between points, 2 of points of evaluation, 3 of facets), owner (number in that set), place (m; of the
%   owner) and point (that is seen).
%
%   Errors: perigal:argument.
%
%   Example
%     h = perigal_session ('data/disk_crack/scene.yaml', 'set', {'spacing', '4 mm'});
%     perigal_step (h, 3);
%     x = perigal_get (h, 'place');
%     s = perigal_get (h, 'stress');
%     scatter (x(:, 1), x(:, 2), 9, s(:, 1), 'filled')
%     perigal_close (h)
%
%   See also PERIGAL_SESSION, PERIGAL_STEP, PERIGAL_SET.

    if nargin < 1
        error ('perigal:argument', 'perigal_get: needs a session');
    end
    unit = '';
    if nargin < 2
        value = call_mex ('about', h);
        return;
    end
    if ~is_text (name)
        error ('perigal:argument', 'perigal_get: what is asked for must be text');
    end
    switch char (name)
        case {'d', 'v', 'a', 'alive'}
            value = call_mex ('state', h, char (name));
        case 'bonds'
            value = call_mex ('bonds', h);
        case {'displacement', 'velocity', 'damage', 'strain', 'stress', 'rotation', 'coefficient', 'error_estimate'}
            [value, unit] = call_mex ('field', h, char (name));
        otherwise
            info = call_mex ('about', h);
            if ~isfield (info, char (name))
                error ('perigal:argument', ['perigal_get: there is no %s; there are the fields displacement, velocity, damage, ' ...
                       'strain, stress, the vectors d, v, a, alive, bonds, and %s'], char (name), strjoin (fieldnames (info)', ', '));
            end
            value = info.(char (name));
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
