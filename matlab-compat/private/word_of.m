function text = word_of (who, o, name)
% An option that is a word; '' where it was not given.
    text = option (o, name, '');
    if ~is_text (text)
        error ('perigal:argument', '%s: %s must be text', who, name);
    end
    text = char (text);
end

% SPDX-License-Identifier: GPL-3.0-or-later
