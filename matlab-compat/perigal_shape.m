function [N, dN, grade] = perigal_shape (x, horizon, varargin)
% PERIGAL_SHAPE  Shape functions of points and their derivatives, as sparse matrices.
%
%   [N, DN, GRADE] = PERIGAL_SHAPE (X, HORIZON, OPTION, VALUE, ...): with nodal values u (points x 1), N * u is the field
%   and DN{k} * u its derivative along axis k at the places.
%     X, HORIZON  as in PERIGAL_FAMILY
%     GRADE       per place 0: the full basis, 1: quadratic lowered to linear, 2: projected, 3: Shepard, 4: no neighbour
%   Options:
%     'places'         places x coordinates, m; default: the points themselves
%     'approximation'  'rkpm' (the default), 'pddo' or 'nosb'
%     'kernel'         'cubic_spline' (the default), 'constant', 'quadratic', 'conical', ...
%     'order'          of the basis, 1 (the default) or 2
%     'support'        'radial' or 'tensor';  'weights'  'auto', 'unit' or 'volume';
%     'degenerate'     'shepard' or 'projected': as the keys of the same names of a scene
%     'alive'          logical, for each entry of the lists that PERIGAL_FAMILY gives for the same places, horizon and
%                      support, 'closed' being true for kernels that are not zero at the horizon: false cuts the bond
%     'volume', 'spacing', 'thickness'  as in PERIGAL_FAMILY
%
%   Errors: perigal:argument, perigal:setup.
%
%   Example
%     [a, b] = meshgrid (0:9, 0:9);
%     x = [a(:), b(:)];
%     [N, dN] = perigal_shape (x, '2.5 spacing', 'places', [4.3 5.1], 'order', 2);
%     full ([N * (x(:, 1) .* x(:, 2)), dN{1} * (x(:, 1) .* x(:, 2))])       % 4.3 * 5.1 and 5.1
%
%   See also PERIGAL_FAMILY, PERIGAL_STIFFNESS.

    who = 'perigal_shape';
    if nargin < 2
        error ('perigal:argument', '%s: needs points and a horizon', who);
    end
    words = {'approximation', 'kernel', 'support', 'weights', 'degenerate'};
    [p, o] = points_options (who, x, [words, {'places', 'order', 'alive'}], varargin);
    reach = length_of (who, 'the horizon', horizon, nominal_spacing (p));
    for k = 1:numel (words)
        words{k} = word_of (who, o, words{k});
    end
    [N, dN, grade] = call_mex ('shape', p.x, p.volume, p.spacing, p.thickness, option (o, 'places', []), ...
                               option (o, 'alive', []), words{:}, one_number (who, o, 'order', 1), reach);
end

% SPDX-License-Identifier: GPL-3.0-or-later
