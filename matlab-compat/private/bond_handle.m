function h = bond_handle (h)
% The handle itself, of what perigal_bonds or perigal_fcbm returned.
    if isstruct (h) && isfield (h, 'handle'), h = h.handle; end
end

% SPDX-License-Identifier: GPL-3.0-or-later
