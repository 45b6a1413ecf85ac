function text = read_text (file)
% The whole file as one row of characters; empty if it cannot be read.
    text = '';
    id = fopen (file, 'r', 'n', 'UTF-8');
    if id < 0
        return;
    end
    text = fread (id, [1 Inf], '*char');
    fclose (id);
end

% SPDX-License-Identifier: GPL-3.0-or-later
