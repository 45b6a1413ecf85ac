function perigal_set (h, name, value)
% PERIGAL_SET  Give a session its first displacement or velocity.
%
%   PERIGAL_SET (H, 'displacement', U), PERIGAL_SET (H, 'velocity', V) before the first step of a scene in motion. U (m), V
%   (m/s): points x coordinates, or a vector of all unknowns point by point (with rotations, and for shape functions that
%   are not 1 at their own node: coefficients). Supports keep their own motion. What bodies under static loads do follows
%   from the loads: nothing can be set there. Bonds: PERIGAL_CUT.
%
%   Errors: perigal:argument.
%
%   Example
%     h = perigal_session ('data/kalthoff/scene.yaml', 'set', {'spacing', '4 mm'});
%     x = perigal_get (h, 'place');
%     perigal_set (h, 'velocity', [10 * (x(:, 1) < 5e-3), 0 * x(:, 1)])
%     perigal_close (h)
%
%   See also PERIGAL_SESSION, PERIGAL_CUT.

    if nargin < 3 || ~is_text (name)
        error ('perigal:argument', 'perigal_set: needs a session, ''displacement'' or ''velocity'', and values');
    end
    if ~isnumeric (value) || ~isreal (value)
        error ('perigal:argument', 'perigal_set: values must be real numbers');
    end
    value = double (full (value))';
    if size (value, 2) == 1
        value = value';
    end
    call_mex ('set', h, char (name), reshape (value, [], 1));
end

% SPDX-License-Identifier: GPL-3.0-or-later
