function yes = is_octave ()
% True in GNU Octave, false in MATLAB.
    persistent known
    if isempty (known)
        known = exist ('OCTAVE_VERSION', 'builtin') ~= 0;
    end
    yes = known;
end

% SPDX-License-Identifier: GPL-3.0-or-later
