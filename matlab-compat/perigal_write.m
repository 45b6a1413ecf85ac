function perigal_write (file, scene)
% PERIGAL_WRITE  Write a structure as a scene file.
%
%   PERIGAL_WRITE (FILE, S) writes S, such as PERIGAL_SCENE returns, as YAML. Structures and containers.Map become
%   maps; cells, structure arrays and vectors become lists; true and false become on and off; numbers are written
%   so that they read back as they are.
%
%   Errors: perigal:file, perigal:argument (a value that a scene cannot hold).
%
%   Example
%     s = perigal_scene ('data/disk_crack/scene.yaml');
%     s.title = 'finer';
%     s.spacing = '1 mm';
%     perigal_write ('finer.yaml', s);
%
%   See also PERIGAL_SCENE, PERIGAL_RUN.

    if nargin < 2 || ~is_text (file) || ~((isstruct (scene) && isscalar (scene)) || isa (scene, 'containers.Map'))
        error ('perigal:argument', 'perigal_write: needs the path of a file and a structure');
    end
    text = strjoin (block (scene, ''), sprintf ('\n'));
    id = fopen (char (file), 'w', 'n', 'UTF-8');
    if id < 0
        error ('perigal:file', 'perigal_write: cannot write %s', char (file));
    end
    fprintf (id, '%s\n', text);
    fclose (id);
end

function lines = block (map, indent)
% One line per entry; what fits on a line is written on one.
    [names, values] = entries_of (map);
    lines = {};
    for k = 1:numel (names)
        value = values{k};
        head = [indent yaml_word(names{k}) ':'];
        flow = yaml_flow (value);
        if numel (head) + numel (flow) < 100 || ~nested (value)
            lines{end + 1} = [head ' ' flow]; %#ok<AGROW>
        elseif isstruct (value) && isscalar (value) || isa (value, 'containers.Map')
            lines = [lines, {head}, block(value, [indent '  '])]; %#ok<AGROW>
        else
            lines = [lines, {head}, list(value, [indent '  '])]; %#ok<AGROW>
        end
    end
end

function lines = list (values, indent)
    lines = {};
    for k = 1:numel (values)
        if iscell (values)
            value = values{k};
        else
            value = values(k);
        end
        flow = yaml_flow (value);
        if numel (indent) + numel (flow) < 100 || ~(isstruct (value) && isscalar (value))
            lines{end + 1} = [indent '- ' flow]; %#ok<AGROW>
        else
            inner = block (value, [indent '  ']);
            inner{1} = [indent '- ' inner{1}(numel (indent) + 3:end)];
            lines = [lines, inner]; %#ok<AGROW>
        end
    end
end

function yes = nested (value)
    yes = isstruct (value) || isa (value, 'containers.Map') || (iscell (value) && any (cellfun (@isstruct, value(:))));
end

% SPDX-License-Identifier: GPL-3.0-or-later
