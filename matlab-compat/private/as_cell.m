function list = as_cell (list)
% A list of texts as a column of cells, whatever a reader of JSON makes of none, of one and of many.
    if isempty (list)
        list = cell (0, 1);
    elseif ~iscell (list)
        list = cellstr (list);
    end
    list = list(:);
end

% SPDX-License-Identifier: GPL-3.0-or-later
