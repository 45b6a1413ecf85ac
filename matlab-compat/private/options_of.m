function o = options_of (who, known, arguments)
% Pairs of option and value as a structure. A name that is not known is an error that lists those that are.
    if mod (numel (arguments), 2) ~= 0
        error ('perigal:argument', '%s: options come in pairs of name and value', who);
    end
    o = struct ();
    for k = 1:2:numel (arguments)
        name = arguments{k};
        if ~is_text (name) || ~any (strcmp (known, char (name)))
            if ~is_text (name), name = '?'; end
            error ('perigal:argument', '%s: unknown option %s; there are: %s', who, char (name), strjoin (known, ', '));
        end
        o.(char (name)) = arguments{k + 1};
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
