function table = read_csv (file, who)
% The columns of numbers of a CSV file that perigal wrote: names, units, data (NaN where a place is empty).
% Columns of words stand behind those of numbers and are left out; a last row that a running program has not yet
% finished is left out too.
    id = fopen (file, 'r', 'n', 'UTF-8');
    if id < 0
        error ('perigal:file', '%s: cannot read %s', who, file);
    end
    head = fgetl (id);
    fclose (id);
    if ~ischar (head)
        error ('perigal:file', '%s: %s is empty', who, file);
    end
    heads = strsplit (head, ',');
    table.names = cell (1, numel (heads));
    table.units = cell (1, numel (heads));
    for k = 1:numel (heads)
        at = find (heads{k} == '[', 1, 'last');
        if isempty (at)
            at = numel (heads{k}) + 1;
        end
        table.names{k} = strtrim (heads{k}(1:at - 1));
        table.units{k} = strrep (heads{k}(at + 1:end), ']', '');
    end
    words = find (strcmp (table.units, 'name'), 1);
    if isempty (words)
        words = numel (heads) + 1;
    end
    table.names = table.names(1:words - 1);
    table.units = table.units(1:words - 1);
    table.data = numbers (file, words - 1, numel (heads));
end

function data = numbers (file, n, columns)
% Octave's dlmread and MATLAB's textscan are the ways that do not take minutes.
    if is_octave ()
        data = dlmread (file, ',', [1 0 Inf n-1], 'emptyvalue', NaN);
        if isempty (data)
            data = zeros (0, n);
        end
        if size (data, 2) < n
            data(:, end + 1:n) = NaN;
        end
    else
        id = fopen (file, 'r', 'n', 'UTF-8');
        close_it = onCleanup (@() fclose (id));
        format = [repmat('%f', 1, n) repmat('%*s', 1, columns - n)];
        parts = textscan (id, format, 'Delimiter', ',', 'HeaderLines', 1, 'EmptyValue', NaN, 'CollectOutput', true);
        data = parts{1};
    end
    data = without_unfinished_row (file, data);
end

function data = without_unfinished_row (file, data)
% A row is whole once its line has an end.
    id = fopen (file, 'r');
    fseek (id, -1, 'eof');
    last = fread (id, 1);
    fclose (id);
    if ~isempty (data) && last ~= 10
        data = data(1:end - 1, :);
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
