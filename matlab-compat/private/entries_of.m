function [names, values] = entries_of (map)
% Names and values of a structure or a containers.Map, in order.
    if isstruct (map)
        names = fieldnames (map)';
        values = struct2cell (map)';
    else
        names = keys (map);
        values = map.values (names);
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
