function h = nominal_spacing (p)
% The spacing that the library gives points with volumes and without a spacing: that of the mean volume.
    h = p.spacing;
    if h == 0
        dim = size (p.x, 2);
        t = p.thickness;
        if dim == 3, t = 1; end
        h = (mean (p.volume) / t) ^ (1 / dim);
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
