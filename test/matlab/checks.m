function checks (root, work)
% CHECKS  Every function of matlab-compat, its answers and its errors, as TAP (run by test_octave.sh).
    warning ('off', 'all');
    verdict ();
    demo = fullfile (root, 'data', 'disk_crack', 'scene.yaml');
    there = fullfile (work, 'grün und weiß');       % blanks and umlauts
    mkdir (there);
    r = runs (demo, there);
    results (r);
    points_pass_bit_by_bit (there);
    scenes (demo, there);
    tables (there);
    exports (r, there);
    events_of_many_rows (work);
    sweeps (root, there);
    json ();
    errors (r, demo, there);
    pictures (r, there);
    verdict ('end');
end

function r = runs (demo, there)
    setting = {'spacing', '4 mm'; 'output.pictures', {}; 'failure.fracture_energy', 20};
    r = perigal_run (demo, 'out', fullfile (there, 'öut'), 'set', setting, 'progress', false, 'threads', 1);
    verdict ('run: the result is opened', strcmp (r.folder, fullfile (there, 'öut')) && r.dimension == 2 && r.spacing == 4e-3);
    p = perigal_check (demo, 'set', setting);
    verdict ('check: as many points as the run had', p.points == r.points);
    perigal_run (demo, 'out', fullfile (there, 'shown'), 'set', {'spacing=6 mm', 'output.pictures=[]'}, 'threads', 1);
    verdict ('run with progress ends well', exist (fullfile (there, 'shown', 'report.json'), 'file') == 2);
end

function results (r)
    report = perigal_report (r);
    verdict ('report', strcmp (report.outcome, 'done') && report.points == r.points && iscell (report.warnings));
    h = perigal_history (r);
    verdict ('history: a row for each step', size (h.data, 1) == report.steps && size (h.data, 2) == numel (h.names));
    [v, units] = perigal_history (r, 'energy_strain', 'top.force_y');
    verdict ('history: columns by name', isequal (units, {'J', 'N'}) && isequal (v(:, 1), h.data(:, strcmp (h.names, 'energy_strain'))));
    verdict ('history: the last row is the state of the report', abs (v(end, 1) - report.energy.strain) <= 1e-15 * v(end, 1));
    e = perigal_events (r);
    verdict ('events: a row for each broken bond', size (e.data, 1) == report.broken && strcmp (e.names{end}, 'kind_code'));
    s = perigal_field (r, 'stress', '', 'all');
    verdict ('field: all components at all steps', isequal (size (s), [r.points, 3, numel(r.times)]));
    verdict ('field: one component at some steps', isequal (perigal_field (r, 'stress', 'yy', [3 1]), squeeze (s(:, 2, [3 1]))));
    verdict ('field: steps at equal distances', isequal (perigal_field (r, 'stress', 'xy', 1:2:5), squeeze (s(:, 3, 1:2:5))));
    verdict ('field: the last step by default', isequal (perigal_field (r, 'damage'), perigal_field (r.folder, 'damage', '', numel (r.times))));
    [~, info] = perigal_field (r, 'stress', 'yy', 2);
    verdict ('field: units and times', strcmp (info.units, 'Pa') && info.times == r.times(2));
    x = perigal_field (r, 'place');
    verdict ('volumes fill the disk', abs (sum (perigal_field (r, 'point_volume')) / (pi * 0.05 ^ 2 * 0.01) - 1) < 0.02 && all (hypot (x(:, 1), x(:, 2)) < 0.05));
end

function points_pass_bit_by_bit (there)
% What goes into the program and comes out again is the same to the last bit.
    n = 12;
    [x, y] = meshgrid ((1:n) / 7e3, (1:n) / 7e3);
    x = x(:) * (1 + eps);
    y = y(:) + 1 / 3;
    file = perigal_points (fullfile (there, 'pöints.csv'), [x, y], (1 / 7e3) ^ 2 * 1e-3, 'spacing', 1 / 7e3);
    s = struct ('dimension', 2, 'plane', 'stress', 'thickness', '1 mm', 'points', file);
    s.materials.glass = struct ('youngs_modulus', 7.3e10 + 1 / 3, 'poissons_ratio', 0.2);
    s.method = struct ('approximation', 'rkpm', 'integration', 'nodal', 'horizon', '2.5 spacing');
    s.boundary = { struct('name', 'low', 'set', 'bottom', 'displacement', struct ('x', 0, 'y', 0)), ...
                   struct('name', 'high', 'set', 'top', 'displacement', struct ('y', 1e-6 / 3)) };
    s.solver.kind = 'static';
    s.output.pictures = {};
    r = perigal_run (s, 'out', fullfile (there, 'points'), 'progress', false, 'threads', 1);
    places = perigal_field (r, 'place');
    verdict ('places come back bit by bit', isequal (places, [x, y]));
    u = perigal_history (r, 'high.displacement_y');
    verdict ('a load of a structure comes back', abs (u(end) - 1e-6 / 3) <= 1e-15 * u(end));
end

function scenes (demo, there)
    s = perigal_scene (demo);
    copy = fullfile (there, 'copy.yaml');
    perigal_write (copy, s);
    verdict ('scene: written and read again it is the same', isequal (perigal_scene (copy), s));
    verdict ('scene: the copy means the same', isequaln (meaning (copy), meaning (demo)));
    changed = perigal_scene (demo, 'set', {'spacing', '2 mm'; 'title', 'a "b": c # d\e'});
    verdict ('scene: values replaced', strcmp (changed.spacing, '2 mm') && strcmp (changed.title, 'a "b": c # d\e'));
    perigal_write (copy, changed);
    verdict ('scene: words that YAML would misread', strcmp (perigal_scene (copy).title, changed.title));
    s.materials = containers.Map ({'hard rock'}, {s.materials.rock});
    s.body{1}.add.disk.diameter = 0.1 + 1e-17;
    perigal_write (copy, s);
    again = perigal_scene (copy);
    verdict ('scene: names that are no names of variables', isa (again.materials, 'containers.Map') && again.materials.isKey ('hard rock'));
    s.switches = struct ('a', true, 'b', [1 2.5; 3 4], 'c', {{'x', 1}}, 'd', int8 (3), 'e', single (0.5), 'f', []);
    perigal_write (copy, s);
    verdict ('write: switches, matrices, lists', ~isempty (strfind (fileread (copy), 'a: on')) && ~isempty (strfind (fileread (copy), 'b: [[1, 2.5], [3, 4]]')));
    numbers = [1/3, 1e-300, -0, 2^53 + 2, 6.02214076e23, 0.1];
    text = strjoin (arrayfun (@(v) sprintf ('%d', v), numbers, 'UniformOutput', false), ' ');
    s = struct ('values', numbers);
    perigal_write (copy, s);
    back = sscanf (strrep (strrep (strrep (fileread (copy), 'values: [', ''), ']', ''), ',', ' '), '%f')';
    verdict ('write: numbers read back bit by bit', isequal (back, numbers) && ~isempty (text));
end

function m = meaning (scene)
% What the plan says of the problem; it also has memory at hand and seconds, which change.
    p = perigal_check (scene);
    m = {p.points, p.bonds, p.dofs, p.spacing, p.horizon, p.materials, p.facets};
end

function tables (there)
    f = @(t) sin (pi * t / 1e-5);
    t = perigal_table (f, [0 1e-5]);
    fine = linspace (0, 1e-5, 997);
    off = max (abs (interp1 (t(:, 1), t(:, 2), fine) - f (fine)));
    verdict ('table: within its tolerance', off <= 1.2e-3 && size (t, 1) < 200 && isequal (t(:, 2), f (t(:, 1))));
    t = perigal_table (f, [0 1e-5], 'tolerance', 1e-5);
    verdict ('table: a finer one', max (abs (interp1 (t(:, 1), t(:, 2), fine) - f (fine))) <= 1.2e-5);
    verdict ('table: at given times', isequal (perigal_table (@(t) 2 * t, [0 1 3]), [0 0; 1 2; 3 6]));
    file = perigal_points (fullfile (there, 'p.csv'), [0.1 0.2 0.3; 1/3 2 3], [1e-9 2e-9], 'block', [1 7]);
    lines = strsplit (strtrim (fileread (file)), sprintf ('\n'));
    verdict ('points: columns', strcmp (lines{1}, 'x [m],y [m],z [m],volume [m3],block') && isequal (sscanf (lines{3}, '%f,')', [1/3 2 3 2e-9 7]));
end

function exports (r, there)
    file = fullfile (there, 'x.mat');
    perigal_export (file, r, 'fields', {'damage'}, 'steps', 'last');
    x = load (file);
    verdict ('export: what was asked for', isequal (x.damage, perigal_field (r, 'damage')) && ~isfield (x, 'stress') && isequal (x.x, perigal_field (r, 'place')));
    perigal_export (file, r, 'names', 'fcbm');
    x = load (file);
    d = perigal_field (r, 'damage', '', 2);
    p = perigal_field (r, 'place');
    k = find (x.chiB);
    [~, order] = sortrows ([x.X(k), x.Y(k)]);
    [~, same] = sortrows (p);
    on_points = x.Output(2).d(k);
    verdict ('export: arrays of the fast convolution code', sum (x.chiB(:)) == r.points && isequal (on_points(order), d(same)) && all (diff (x.Y(:, 1)) > 0));
end

function events_of_many_rows (work)
% As many rows as a long run has: all of them, and empty places as NaN.
    folder = fullfile (work, 'many');
    mkdir (folder);
    n = 100000;
    id = fopen (fullfile (folder, 'events.csv'), 'w');
    fprintf (id, 'step [1],load_factor [1],time [s],x [m],y [m],z [m],utilisation [1],energy_of_step [J],bond_code [1],kind_code [1],bond [name],kind [name]\n');
    fprintf (id, '%d,%.10g,0.5,%.10g,0,0,,0,1,0,point-node,tension\n', [1:n; (1:n) / n; sqrt(1:n)]);
    fprintf (id, '%d,1,0', n + 1);                  % a program that is still writing
    fclose (id);
    e = perigal_events (folder);
    verdict ('events: 100000 rows, empty places, an unfinished row', isequal (size (e.data), [n 10]) && all (isnan (e.data(:, 7))) ...
             && isequal (e.data(:, 1), (1:n)') && e.data(4, 4) == 2);
end

function sweeps (root, there)
    s = perigal_scene (fullfile (root, 'test', 'matlab', 'bar.yaml'));
    out = fullfile (there, 'swéep');
    t = perigal_sweep (s, 'set', {'spacing', {'1 mm', '2 mm'}; 'failure.critical_stretch', [0.002 0.003]; 'cracks', {{}}}, ...
                       'out', out, 'progress', false, 'threads', 1, 'jobs', 2);
    verdict ('sweep: all combinations', isequal (t.names(1:4), {'number', 'spacing', 'critical_stretch', 'peak'}) && strcmp (t.units{2}, 'mm') ...
             && isequal (t.data(:, 2:3), [1 0.002; 1 0.003; 2 0.002; 2 0.003]) && all (strcmp (t.status, 'done')));
    r = perigal_report (t.folder{3});
    verdict ('sweep: the peak is that of the report', t.data(3, 4) == r.curve.peak.force);
    t = perigal_sweep (s, 'set', {'spacing', {'1 mm', '2 mm'}; 'cracks[0].to', {{'3 mm', 0}, {'4 mm', 0}}}, 'zip', true, ...
                       'out', [out '2'], 'progress', false, 'threads', 1, 'quantity', {'broken', 'top.force_y:max'});
    verdict ('sweep: zip, quantities, words', isequal (t.names(1:4), {'number', 'spacing', 'broken', 'top.force_y:max'}) ...
             && isequal (t.words.names, {'to'}) && numel (t.words.values) == 2 && ~isempty (strfind (t.words.values{2}, '4 mm')));
    mkdir ([out '3']);
    fclose (fopen (fullfile ([out '3'], 'spacing=2mm'), 'w'));
    t = perigal_sweep (s, 'set', {'spacing=1 mm,2 mm'}, 'out', [out '3'], 'progress', false, 'threads', 1);
    verdict ('sweep: a run that fails', isequal (t.status, {'done'; 'failed'}) && ~isempty (strfind (t.trouble{2}, 'is a file')) && isnan (t.data(2, 3)));
    delete (fullfile ([out '3'], 'spacing=2mm'));
    t = perigal_sweep (s, 'set', {'spacing=1 mm,2 mm'}, 'out', [out '3'], 'progress', false, 'threads', 1, 'resume', true);
    verdict ('sweep: and is run again', all (strcmp (t.status, 'done')) && all (isfinite (t.data(:, 3))));
    refused ('sweep: wrong key', 'perigal:scene', 'did you mean spacing', @() perigal_sweep (s, 'set', {'spacng', [1 2]}, 'progress', false));
    refused ('sweep: it is there', 'perigal:usage', '--resume', @() perigal_sweep (s, 'set', {'spacing=1 mm,2 mm'}, 'out', out, 'progress', false));
    refused ('sweep: no values', 'perigal:argument', 'no value', @() perigal_sweep (s, 'set', {'spacing', {}}));
    refused ('sweep: nothing to change', 'perigal:argument', '''set''', @() perigal_sweep (s));
    refused ('sweep: unknown option', 'perigal:argument', 'quantity', @() perigal_sweep (s, 'job', 2));
end

function json ()
% The reader for programs that have none of their own gives what Octave's gives.
    here = pwd ();
    back = onCleanup (@() cd (here));
    cd (fullfile (fileparts (which ('perigal_open')), 'private'));
    texts = {'{"a": [1, 2.5e-3, null], "b": {"c": "x\n\"y\" \u00fc"}, "d": [], "e": [true, false]}', ...
             '[{"a": 1}, {"a": 2}]', '[{"a": 1}, {"b": 2}]', '["x", 1]', '{"a": null, "b": -1e10}'};
    same = true;
    for k = 1:numel (texts)
        same = same && isequaln (decode_json (texts{k}), decode_json (texts{k}, 'own'));
    end
    verdict ('JSON: both readers agree', same);
    exact = decode_json ('{"a": [1], "b": [1, 2], "c": [{"d": 1}]}', 'exact');
    verdict ('JSON: lists stay lists', iscell (exact.a) && isequal (exact.b, [1 2]) && iscell (exact.c));
end

function errors (r, demo, there)
    refused ('open: no such folder', 'perigal:file', 'nowhere', @() perigal_open (fullfile (there, 'nowhere')));
    refused ('open: a folder without a result', 'perigal:file', 'result.e', @() perigal_open (there));
    refused ('open: no text', 'perigal:argument', 'result folder', @() perigal_open (7));
    refused ('field: unknown', 'perigal:field', 'displacement, damage', @() perigal_field (r, 'stres'));
    refused ('field: unknown component', 'perigal:field', '''xx'', ''yy''', @() perigal_field (r, 'stress', 'q'));
    refused ('field: step out of range', 'perigal:step', 'from 1 to', @() perigal_field (r, 'stress', 'xx', 99));
    refused ('field: half a step', 'perigal:step', 'whole numbers', @() perigal_field (r, 'stress', 'xx', 1.5));
    refused ('field: a word for a step', 'perigal:step', '''first''', @() perigal_field (r, 'stress', 'xx', 'first'));
    refused ('history: unknown column', 'perigal:column', 'energy_strain', @() perigal_history (r, 'enrgy'));
    refused ('history: none', 'perigal:file', 'history.csv', @() perigal_history (there));
    refused ('report: none', 'perigal:file', 'has not ended', @() perigal_report (there));
    refused ('run: unknown option', 'perigal:argument', 'out, set', @() perigal_run (demo, 'ot', 1));
    refused ('run: odd options', 'perigal:argument', 'pairs', @() perigal_run (demo, 'out'));
    refused ('run: wrong key', 'perigal:scene', 'did you mean spacing', @() perigal_run (demo, 'out', there, 'progress', false, 'set', {'spacng', 3}));
    refused ('run: wrong key, shown', 'perigal:scene', 'did you mean spacing', @() quietly (demo, there));
    refused ('run: wrong value', 'perigal:scene', 'must lie in', @() perigal_run (demo, 'out', there, 'progress', false, 'set', {'materials.rock.poissons_ratio', 0.7}));
    refused ('run: too little memory', 'perigal:failed', 'memory', @() perigal_run (demo, 'out', fullfile (there, 'm'), 'memory', '1 kB', 'progress', false));
    refused ('run: wrong set', 'perigal:argument', 'key', @() perigal_run (demo, 'set', {1, 2, 3}));
    refused ('check: wrong scene', 'perigal:scene', 'missing.yaml', @() perigal_check (fullfile (there, 'missing.yaml')));
    refused ('check: no scene', 'perigal:argument', 'scene', @() perigal_check (7));
    refused ('scene: no text', 'perigal:argument', 'path', @() perigal_scene (7));
    refused ('write: not a number', 'perigal:argument', 'NaN', @() perigal_write (fullfile (there, 'n.yaml'), struct ('a', NaN)));
    refused ('write: a handle', 'perigal:argument', 'function_handle', @() perigal_write (fullfile (there, 'n.yaml'), struct ('a', @sin)));
    refused ('write: no such folder', 'perigal:file', 'cannot write', @() perigal_write (fullfile (there, 'a', 'b.yaml'), struct ('a', 1)));
    refused ('table: times that fall', 'perigal:argument', 'ascending', @() perigal_table (@sin, [1 0]));
    refused ('table: a pole', 'perigal:argument', 'not finite', @() perigal_table (@(t) 1 / t, [0 1]));
    refused ('points: volumes', 'perigal:argument', 'above 0', @() perigal_points (fullfile (there, 'q.csv'), [0 0], 0));
    refused ('points: shapes', 'perigal:argument', 'block', @() perigal_points (fullfile (there, 'q.csv'), zeros (3, 2), 1, 'block', [1 2]));
    refused ('export: names', 'perigal:argument', 'fcbm', @() perigal_export (fullfile (there, 'q.mat'), r, 'names', 'x'));
    refused ('export: version 7.3 in Octave', 'perigal:argument', 'v5', @() perigal_export (fullfile (there, 'q.mat'), r, 'version', 'v7.3'));
    refused ('setup: not the program', 'perigal:setup', 'not the program', @() perigal_setup ('/bin/true'));
    refused ('plot: a component is needed', 'perigal:field', 'choose one component', @() perigal_plot (r, 'stress'));
    refused ('curve: one column', 'perigal:argument', 'both axes', @() perigal_curve (r, 'step'));
end

function quietly (scene, out) %#ok<INUSD>
% A run that shows what the program says, without showing it here.
    evalc ('perigal_run (scene, ''out'', out, ''set'', {''spacng'', 3});');
end

function pictures (r, there)
% Drawn where Octave has a way to draw without a display.
    if ~any (strcmp (available_graphics_toolkits (), 'gnuplot'))
        verdict ('pictures: skipped, Octave has no gnuplot here', true);
        return;
    end
    graphics_toolkit ('gnuplot');
    window = figure ('visible', 'off');
    h = perigal_plot (r, 'displacement', 'x', 'last', 'magnify', 100);
    verdict ('plot: one marker a point', numel (get (h, 'xdata')) == r.points && strcmp (get (get (gca (), 'title'), 'string'), sprintf ('displacement.x [m] at %g', r.times(end))));
    clf (window);
    h = perigal_curve ({r, r}, 'top.displacement_y', 'top.force_y', 'r');
    verdict ('curve: one line a result', numel (h) == 2 && isequal (get (h(1), 'ydata')(:), perigal_history (r, 'top.force_y')));
    clf (window);
    h = perigal_curve (r);
    verdict ('curve: the one of the report', numel (h) == 1);
    close (window);
    try
        perigal_movie (fullfile (there, 'm.gif'), r, 'damage', '', 'steps', [1 3]);
        verdict ('movie: a frame a step', numel (imfinfo (fullfile (there, 'm.gif'))) == 2);
    catch fault
        verdict (['movie: skipped: ' strtok(fault.message, sprintf ('\n'))], ~isempty (regexp (fault.message, 'ghostscript|gs', 'once')));
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
