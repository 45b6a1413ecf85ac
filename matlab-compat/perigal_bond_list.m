function b = perigal_bond_list (h)
% PERIGAL_BOND_LIST  The bonds of a handle: who sees whom, alive or not, vectors and weights.
%
%   B = PERIGAL_BOND_LIST (H) returns columns with an entry for each bond and direction (i to j and j to i):
%     i, j            points; ascending by i, then j. Of PERIGAL_FCBM: SITE has their places in the array
%     alive           logical
%     xi              x_j - x_i, m
%     weight          kernel times share of the volume times surface factor; partial_volume: that share
%   and micromodulus (one number, with calibration), evaluation ('fft avx2', 'list scalar', ...).
%
%   Errors: perigal:argument.
%
%   Example
%     h = perigal_bonds (rand (50, 2), 0.3, 1);
%     b = perigal_bond_list (h);
%     lengths = sqrt (sum (b.xi .^ 2, 2));
%     perigal_close (h)
%
%   See also PERIGAL_BONDS, PERIGAL_BOND_MASK.

    if nargin < 1
        error ('perigal:argument', 'perigal_bond_list: needs a handle');
    end
    b = call_mex ('bonds_list', bond_handle (h));
    if isstruct (h), b.site = h.site; end
end

% SPDX-License-Identifier: GPL-3.0-or-later
