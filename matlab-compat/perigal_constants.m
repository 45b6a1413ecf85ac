function c = perigal_constants (dimension, horizon, E, nu, varargin)
% PERIGAL_CONSTANTS  Constants and limits of peridynamic bonds from Young's modulus, Poisson's ratio and horizon.
%
%   C = PERIGAL_CONSTANTS (DIMENSION, HORIZON, E, NU, OPTION, VALUE, ...) with DIMENSION 1, 2 or 3, HORIZON in m (or text,
%   '3 mm'; '3 spacing' with the option 'spacing'), E in Pa. Fields of C, SI units:
%     micromodulus, critical_stretch, bond_poisson   bonds alone (bond, fcbm): c (N/m^6), s0, their only Poisson's ratio
%     dilation, deviation, state_stretch             state-based (lps): A and B (Pa), s0
%     beam_axial, beam_shear, beam_bending, beam_limits, beam_poisson   micropolar (gmpd): C_N (N/m^6), C_t and bending
%                         stiffness (N/m^4); limits of stretch, shear and bending; largest Poisson's ratio. NaN beyond it
%     energy_density      at which a point dies (fcbm): G0 / (2 horizon), J/m3
%     calibration, toughness   of a lattice: c over that of theory; energy of a straight cut over that of theory
%     growth              of a lattice: energy of a crack that grows bond by bond over a straight cut. Scenes, with their
%                         default failure.calibration: measured, use critical_stretch / sqrt (growth). NaN: not measured
%   Options:
%     'plane'            'stress' (the default) or 'strain', in 2D
%     'thickness'        2D: m; 1D: cross section, m2; 1 unless given
%     'fracture_energy'  J/m2; without it limits are NaN
%     'kernel'           influence function of the bonds, 'constant' unless given
%     'spacing'          of a square or cubic lattice: constants as a scene uses them there; without it those of theory
%
%   Errors: perigal:argument, perigal:setup.
%
%   Example
%     c = perigal_constants (2, '3 spacing', 65e9, 1/3, 'spacing', 1e-3, 'thickness', 1e-3, 'fracture_energy', 135);
%     c.micromodulus, c.critical_stretch
%
%   See also PERIGAL_BONDS, PERIGAL_FCBM.

    who = 'perigal_constants';
    if nargin < 4 || ~isnumeric (dimension) || ~isscalar (dimension)
        error ('perigal:argument', '%s: needs dimension, horizon, Young''s modulus and Poisson''s ratio', who);
    end
    o = options_of (who, {'plane', 'thickness', 'fracture_energy', 'kernel', 'spacing'}, varargin);
    spacing = 0;
    if isfield (o, 'spacing'), spacing = length_of (who, 'spacing', o.spacing, NaN); end
    relative = spacing;
    if spacing == 0, relative = NaN; end
    thickness = option (o, 'thickness', 1);
    if is_text (thickness), thickness = length_of (who, 'thickness', thickness, NaN); end
    energy = option (o, 'fracture_energy', 0);
    if isfield (o, 'fracture_energy') && ~(isnumeric (energy) && isscalar (energy) && energy > 0)
        error ('perigal:argument', '%s: fracture_energy must be above 0 (J/m2)', who);
    end
    c = call_mex ('constants', mode_of (who, dimension, o), word_of (who, o, 'kernel'), ...
                  length_of (who, 'the horizon', horizon, relative), E, nu, thickness, energy, spacing);
end

% SPDX-License-Identifier: GPL-3.0-or-later
