function text = yaml_word (text)
% Text as YAML: as it is where that is safe, else in double quotes.
    safe = ~isempty (regexp (text, '^[A-Za-z_][A-Za-z0-9_ ./^*()+-]*$', 'once')) || ...
           ~isempty (regexp (text, '^[-+]?[0-9.][0-9.eE+-]* [A-Za-z0-9/^*%]+$', 'once'));
    if safe && text(end) ~= ' ' && ~any (strcmpi (text, {'null', 'true', 'false', 'yes', 'no', 'on', 'off'}))
        return;
    end
    if any (strcmp (text, {'on', 'off'}))
        return;                 % switches of a scene
    end
    text = strrep (strrep (text, '\', '\\'), '"', '\"');
    text = strrep (strrep (text, sprintf ('\n'), '\n'), sprintf ('\t'), '\t');
    text = ['"' text '"'];
end

% SPDX-License-Identifier: GPL-3.0-or-later
