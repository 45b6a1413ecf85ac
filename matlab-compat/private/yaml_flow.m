function text = yaml_flow (value)
% A value on one line of YAML: 0.5, "2 mm", [1, 2], {x: 1}.
    if is_text (value)
        text = yaml_word (char (value));
    elseif islogical (value) && isscalar (value)
        words = {'off', 'on'};
        text = words{1 + value};
    elseif isnumeric (value) && isscalar (value)
        text = yaml_number (value);
    elseif isnumeric (value) || islogical (value)
        if isempty (value)
            text = '[]';
        elseif size (value, 1) > 1 && size (value, 2) > 1
            text = ['[' strjoin(arrayfun (@(k) yaml_flow (value(k, :)), 1:size (value, 1), 'UniformOutput', false), ', ') ']'];
        else
            text = ['[' strjoin(arrayfun (@yaml_flow, value(:)', 'UniformOutput', false), ', ') ']'];
        end
    elseif iscell (value)
        text = ['[' strjoin(cellfun (@yaml_flow, value(:)', 'UniformOutput', false), ', ') ']'];
    elseif isstruct (value) && ~isscalar (value)
        text = ['[' strjoin(arrayfun (@yaml_flow, value(:)', 'UniformOutput', false), ', ') ']'];
    elseif isstruct (value) || isa (value, 'containers.Map')
        [names, values] = entries_of (value);
        parts = cell (1, numel (names));
        for k = 1:numel (names)
            parts{k} = [yaml_word(names{k}) ': ' yaml_flow(values{k})];
        end
        text = ['{' strjoin(parts, ', ') '}'];
    else
        error ('perigal:argument', 'a value of class %s cannot be written into a scene', class (value));
    end
end

function text = yaml_number (value)
    if ~isreal (value) || ~isfinite (value)
        error ('perigal:argument', 'a scene cannot hold the number %g', value);
    end
    if isinteger (value)
        text = sprintf ('%d', value);
        return;
    end
    for digits = 6:17           % the shortest text that reads back as this number
        text = sprintf ('%.*g', digits, value);
        if str2double (text) == value
            break;
        end
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
