function m = length_of (who, what, value, spacing)
% A length in m: a number is in m; a text carries its unit, '5 mm', or is a multiple of the spacing, '3 spacing'.
    if isnumeric (value) && isreal (value) && isscalar (value)
        m = double (value);
    elseif is_text (value)
        text = strtrim (char (value));
        word = regexp (text, '^([-+.\deE]+)\s*spacings?$', 'tokens', 'once');
        if isempty (word)
            m = call_mex ('length', text);
        elseif isnan (spacing)
            error ('perigal:argument', '%s: %s cannot be in spacings', who, what);
        else
            m = str2double (word{1}) * spacing;
        end
    else
        error ('perigal:argument', '%s: %s must be a length: a number (m), or text such as ''5 mm'' or ''3 spacing''', who, what);
    end
    if ~(m > 0) || isinf (m)
        error ('perigal:argument', '%s: %s must be above 0', who, what);
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
