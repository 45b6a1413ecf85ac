function yes = is_text (value)
% True for a row of characters, or a string scalar of MATLAB.
    yes = (ischar (value) && size (value, 1) <= 1) || isa (value, 'string');
end

% SPDX-License-Identifier: GPL-3.0-or-later
