function value = option (o, name, usual)
% The value of an option, or the usual one.
    value = usual;
    if isfield (o, name), value = o.(name); end
end

% SPDX-License-Identifier: GPL-3.0-or-later
