function value = one_number (who, o, name, usual)
% An option that is one real number (or a flag), or its usual value.
    value = option (o, name, usual);
    if ~((isnumeric (value) || islogical (value)) && isreal (value) && isscalar (value))
        error ('perigal:argument', '%s: %s must be one number', who, name);
    end
    value = double (value);
end

% SPDX-License-Identifier: GPL-3.0-or-later
