function mode = mode_of (who, dim, o)
% The kind of elasticity from the number of dimensions and the option 'plane' ('stress', the default, or 'strain').
    switch dim
        case 1, mode = 'bar';
        case 2, mode = 'stress';
        case 3, mode = 'solid';
        otherwise
            error ('perigal:argument', '%s: 1, 2 or 3 dimensions, not %g', who, dim);
    end
    if isfield (o, 'plane')
        if dim ~= 2 || ~is_text (o.plane) || ~any (strcmp ({'stress', 'strain'}, char (o.plane)))
            error ('perigal:argument', '%s: plane is ''stress'' or ''strain'', in 2 dimensions', who);
        end
        mode = char (o.plane);
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
