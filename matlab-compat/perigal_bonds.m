function h = perigal_bonds (x, horizon, c, varargin)
% PERIGAL_BONDS  Peridynamic bonds between points: forces for displacements, by lists, stencils or FFT.
%
%   H = PERIGAL_BONDS (X, HORIZON, C, OPTION, VALUE, ...) returns a handle, for PERIGAL_BOND_FORCE, PERIGAL_BOND_LIST and
%   PERIGAL_BOND_MASK; PERIGAL_CLOSE gives its memory back, as does `clear perigal_mex`.
%     X, HORIZON  as in PERIGAL_FAMILY
%     C           micromodulus, N/m^6: that of theory (perigal_constants (...).micromodulus without 'spacing')
%   The force on point i is V_i sum_j c w_ij s_ij e_ij V_j, w = kernel(r / horizon) times share of the neighbour's volume,
%   s the stretch, e the unit vector of the bond (doc/method.md A1).
%   Options:
%     'volume', 'spacing', 'thickness'  as in PERIGAL_FAMILY
%     'plane'               'stress' or 'strain', in 2D
%     'kernel'              'constant' unless given
%     'partial_volume'      'none', 'linear', 'overlap' (lattices only); default: overlap on a lattice, else linear
%     'surface_correction'  'none' (the default), 'product', 'volume'
%     'calibrate'           true: C is scaled so that hydrostatic strain has its energy on these points; default: false
%     'stretch'             'linear' (the default) or 'finite'
%     'evaluation'          'auto' (the default), 'stencil', 'list', 'fft': the same forces, to rounding
%     'threads'             1 unless given
%
%   Errors: perigal:argument, perigal:failed, perigal:setup.
%
%   Example
%     [a, b] = meshgrid ((0:19) * 1e-3);
%     k = perigal_constants (2, 3e-3, 65e9, 1/3, 'thickness', 1e-3);
%     h = perigal_bonds ([a(:), b(:)], '3 spacing', k.micromodulus, 'spacing', 1e-3, 'thickness', 1e-3);
%     f = perigal_bond_force (h, 1e-6 * [a(:), 0 * b(:)]);
%     perigal_close (h)
%
%   See also PERIGAL_FCBM, PERIGAL_BOND_FORCE, PERIGAL_BOND_LIST, PERIGAL_BOND_MASK, PERIGAL_CONSTANTS.

    who = 'perigal_bonds';
    if nargin < 3
        error ('perigal:argument', '%s: needs points, a horizon and a micromodulus', who);
    end
    known = {'plane', 'kernel', 'partial_volume', 'surface_correction', 'calibrate', 'stretch', 'evaluation', 'threads'};
    [p, o] = points_options (who, x, known, varargin);
    reach = length_of (who, 'the horizon', horizon, nominal_spacing (p));
    partial = word_of (who, o, 'partial_volume');
    first = {partial};
    if isempty (partial), first = {'overlap', 'linear'}; end
    kernel = word_of (who, o, 'kernel');
    if isempty (kernel), kernel = 'constant'; end
    for k = 1:numel (first)
        try
            h = call_mex ('bonds_open', p.x, p.volume, p.spacing, p.thickness, mode_of (who, size (p.x, 2), o), kernel, ...
                          reach, first{k}, word_of (who, o, 'surface_correction'), one_number (who, o, 'calibrate', false), ...
                          word_of (who, o, 'stretch'), word_of (who, o, 'evaluation'), c, one_number (who, o, 'threads', 1));
            return;
        catch fault
            if k == numel (first) || isempty (strfind (fault.message, 'lattice'))
                rethrow (fault);
            end
        end
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
