function verdict (name, good)
% Prints a check as TAP; without arguments it begins to count, with one it prints the plan.
    persistent n
    if nargin == 0
        n = 0;
    elseif nargin == 1
        printf ('1..%d\n', n);
    else
        n = n + 1;
        words = {'not ok', 'ok'};
        printf ('%s %d - %s\n', words{1 + logical(good)}, n, name);
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
