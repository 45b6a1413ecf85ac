function t = perigal_sweep (scene, varargin)
% PERIGAL_SWEEP  Run a scene with all combinations of some of its values.
%
%   T = PERIGAL_SWEEP (SCENE, 'set', {KEY, VALUES; ...}, OPTION, VALUE, ...) runs SCENE, the path of a scene file or a
%   structure of PERIGAL_SCENE, once for each combination and returns the table sweep.csv: T.names (cell of column
%   names), T.units, T.data (runs x columns; NaN: not known), T.status ('done', 'failed', 'interrupted' or 'waiting'),
%   T.trouble (why), T.folder (result folder) and T.words (cells of values that are no numbers) of each run, and
%   T.file. All combinations are checked before the first run. Options:
%     'set'       {'spacing', {'1 mm', '2 mm'}; 'failure.fracture_energy', [10 20 30]; 'method.force', 'bond'}: cells
%                 and vectors are lists of values, others one value for every run; a value that is itself a list is a
%                 cell in a cell; or {'spacing=1 mm,2 mm', 'perturb.seed=1:20'} as in `perigal help sweep`
%     'out'       folder of all runs; default: out/sweep
%     'zip'       true: the first values of all keys together, the second ones ...
%     'jobs'      so many runs at a time; default: 1
%     'resume'    true: go on in a folder with a sweep; finished runs are kept
%     'quantity'  columns, such as {'peak', 'top.force_y:max'} (`perigal help sweep`)
%     'threads', 'memory'  of each run
%     'progress'  false: nothing is printed while it runs; default: true
%
%   Failed runs give a warning (perigal:warning) and their rows say why. Errors: perigal:scene (a combination is wrong),
%   perigal:interrupted ('resume' goes on), perigal:usage, perigal:failed, perigal:argument.
%
%   Example
%     t = perigal_sweep ('data/disk_crack/scene.yaml', 'set', {'spacing', {'3 mm', '4 mm'}; 'output.pictures', {{}}});
%     plot (t.data(:, 2), -t.data(:, 3), 'o-'), xlabel ('spacing [mm]'), ylabel ('peak force [N]')
%
%   See also PERIGAL_RUN, PERIGAL_SCENE, PERIGAL_CURVE.

    if nargin < 1
        error ('perigal:argument', 'perigal_sweep: needs a scene');
    end
    known = {'set', 'out', 'zip', 'jobs', 'resume', 'quantity', 'threads', 'memory', 'progress'};
    o = options_of ('perigal_sweep', known, varargin);
    if ~isfield (o, 'set')
        error ('perigal:argument', 'perigal_sweep: needs ''set'', {''key'', values; ...}');
    end
    [file, clean] = scene_file (scene); %#ok<ASGLU>
    out = fullfile ('out', 'sweep');
    if isfield (o, 'out'), out = char (o.out); end
    words = [{'sweep', file, '-o', out}, lists(o.set), switches(o)];
    shown = ~isfield (o, 'progress') || o.progress;
    if ~shown
        words{end + 1} = '--quiet';
    end
    failure = [];
    try
        call_perigal (words, shown);
    catch failure
        if ~strcmp (failure.identifier, 'perigal:failed') || ~finished (out)
            rethrow (failure);
        end
    end
    t = table_of (out);
    if ~isempty (failure)
        warning ('perigal:warning', '%s', failure.message);
    end
end

function yes = finished (out)
% Has every run of the table been begun? Then only runs have failed.
    yes = exist (fullfile (out, 'sweep.csv'), 'file') == 2;
    if yes
        t = table_of (out);
        yes = ~any (strcmp (t.status, 'waiting')) && any (strcmp (t.status, 'failed'));
    end
end

function words = lists (set)
% --set KEY=A,B,C ...
    words = {};
    if is_text (set), set = {set}; end
    if ~iscell (set)
        error ('perigal:argument', 'perigal_sweep: ''set'' takes {''key'', values; ...} or {''key=a,b'', ...}');
    end
    if all (cellfun (@(v) is_text (v) && any (char (v) == '='), set(:)))
        for k = 1:numel (set)
            words = [words, {'--set', char(set{k})}]; %#ok<AGROW>
        end
        return;
    end
    if size (set, 2) ~= 2 || ~all (cellfun (@is_text, set(:, 1)))
        error ('perigal:argument', 'perigal_sweep: ''set'' takes {''key'', values; ...} or {''key=a,b'', ...}');
    end
    for k = 1:size (set, 1)
        values = set{k, 2};
        if isnumeric (values) || islogical (values), values = num2cell (values(:)'); end
        if ~iscell (values), values = {values}; end
        if isempty (values)
            error ('perigal:argument', 'perigal_sweep: %s has no value; an empty list as value is {{}}', char (set{k, 1}));
        end
        texts = cell (1, numel (values));
        for v = 1:numel (values)
            texts{v} = value_text (values{v});
        end
        words = [words, {'--set', [char(set{k, 1}) '=' strjoin(texts, ',')]}]; %#ok<AGROW>
    end
end

function text = value_text (value)
% Texts as they are, unless a list would be cut in them.
    if is_text (value) && ~isempty (char (value)) && isempty (regexp (char (value), '[\[\]{}(),"'':#]', 'once'))
        text = char (value);
    else
        text = yaml_flow (value);
    end
end

function words = switches (o)
    words = {};
    names = {'zip', 'resume'};
    for k = 1:numel (names)
        if isfield (o, names{k}) && o.(names{k})
            words{end + 1} = ['--' names{k}]; %#ok<AGROW>
        end
    end
    names = {'jobs', 'threads'};
    for k = 1:numel (names)
        if isfield (o, names{k})
            words = [words, {['--' names{k}], sprintf('%d', o.(names{k}))}]; %#ok<AGROW>
        end
    end
    if isfield (o, 'memory')
        words = [words, {'--memory', char(o.memory)}];
    end
    if isfield (o, 'quantity') && ~isempty (o.quantity)
        words = [words, {'--quantity', strjoin(as_cell (o.quantity), ',')}];
    end
end

function t = table_of (out)
% sweep.csv: numbers first, then columns of words.
    file = fullfile (out, 'sweep.csv');
    t = read_csv (file, 'perigal_sweep');
    lines = strsplit (strtrim (read_text (file)), sprintf ('\n'));
    heads = cells_of (lines{1});
    n = numel (lines) - 1;
    words = cell (n, numel (heads));
    for k = 1:n
        row = cells_of (lines{k + 1});
        words(k, 1:numel (row)) = row;
    end
    names = strrep (heads, ' [name]', '');
    t.status = words(:, end - 2);
    t.folder = cellfun (@(name) fullfile (out, name), words(:, end - 1), 'UniformOutput', false);
    t.trouble = words(:, end);
    t.words = struct ('names', {names(numel (t.names) + 1:end - 3)}, 'values', {words(:, numel (t.names) + 1:end - 3)});
    t.file = file;
end

function row = cells_of (line)
% A line of CSV at its commas, those in quotes aside.
    parts = strsplit (line, '"', 'CollapseDelimiters', false);
    row = {''};
    for k = 1:numel (parts)
        if mod (k, 2) == 0
            row{end} = [row{end} parts{k}];
            continue;
        end
        if isempty (parts{k}) && k > 1 && k < numel (parts)
            row{end} = [row{end} '"'];                  % two quotes inside quotes are one
            continue;
        end
        between = strsplit (parts{k}, ',', 'CollapseDelimiters', false);
        row{end} = [row{end} between{1}];
        row = [row, between(2:end)]; %#ok<AGROW>
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
