function op = perigal_fcbm (chi, spacing, horizon, c, varargin)
% PERIGAL_FCBM  The operator of the fast convolution-based method on an array: forces for displacements.
%
%   OP = PERIGAL_FCBM (CHI, SPACING, HORIZON, C, OPTION, VALUE, ...) for use in PERIGAL_BOND_FORCE, PERIGAL_BOND_MASK,
%   PERIGAL_BOND_LIST; PERIGAL_CLOSE (OP) gives its memory back.
%     CHI      logical, true where the body is; as MESHGRID has it: rows along y, columns along x, pages along z
%     SPACING  of the nodes, m (or text, '1 mm'), the same along all axes; HORIZON as in PERIGAL_FAMILY
%     C        micromodulus, N/m^6 (see PERIGAL_BONDS)
%   Options: those of PERIGAL_BONDS; 'evaluation' is 'fft' unless given.
%   OP has handle, size, dimension, and site: the places of the points in the array.
%
%   Errors: perigal:argument, perigal:failed, perigal:setup.
%
%   Example
%     [x, y] = meshgrid ((0:99) * 1e-3, (0:59) * 1e-3);
%     chi = hypot (x - 50e-3, y - 30e-3) > 10e-3;             % a plate with a hole
%     k = perigal_constants (2, 3e-3, 65e9, 1/3);
%     op = perigal_fcbm (chi, 1e-3, '3 spacing', k.micromodulus);
%     f = perigal_bond_force (op, cat (3, 1e-4 * x, 0 * y));
%     imagesc (f(:, :, 1)), axis equal, colorbar
%     perigal_close (op)
%
%   See also PERIGAL_BOND_FORCE, PERIGAL_BOND_MASK, PERIGAL_BONDS.

    who = 'perigal_fcbm';
    if nargin < 4
        error ('perigal:argument', '%s: needs a mask, a spacing, a horizon and a micromodulus', who);
    end
    if ~islogical (chi) || ~any (chi(:)) || ndims (chi) > 3
        error ('perigal:argument', '%s: the mask must be a logical matrix or 3D array with at least one true entry', who);
    end
    h = length_of (who, 'the spacing', spacing, NaN);
    dim = ndims (chi);
    site = find (chi);
    [row, column, page] = ind2sub (size (chi), site);
    x = h * ([column, row, page] - 1);
    x = x(:, 1:dim);
    rest = varargin;
    if ~any (cellfun (@(w) is_text (w) && strcmp (char (w), 'evaluation'), rest))
        rest = [rest, {'evaluation', 'fft'}];
    end
    op = struct ('handle', perigal_bonds (x, horizon, c, rest{:}, 'spacing', h), 'size', size (chi), ...
                 'dimension', dim, 'site', site);
end

% SPDX-License-Identifier: GPL-3.0-or-later
