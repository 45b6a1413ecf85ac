function mex_checks (root, work)
% MEX_CHECKS  The compiled functions of matlab-compat, their answers and their errors, as TAP (run by test_mex.sh).
    warning ('off', 'all');
    rand ('twister', 7);
    verdict ();
    families ();
    shapes ();
    constants (work);
    forces ();
    arrays ();
    matrices (work);
    stepping (work);
    changes (work);
    states (work);
    lists_of_errors (work);
    handles (root, work);
    memory (work);
    verdict ('end');
end

% ---- points -----------------------------------------------------------------------------------------------------------
function families ()
    for dim = 1:3
        x = rand (150, dim);
        verdict (sprintf ('family: balls in %dD are those of brute force', dim), same_lists (x, x, 0.3, 'radial'));
        verdict (sprintf ('family: cubes in %dD, around other places', dim), same_lists (x, rand (40, dim), 0.2, 'tensor'));
    end
    [a, b] = meshgrid (0:6, 0:6);
    x = [a(:), b(:)];
    [s1, n1] = perigal_family (x, '2 spacing');
    [s2, n2] = perigal_family (1e-3 * x, '2 mm', 'spacing', '1 mm');
    verdict ('family: a horizon in spacings, in mm', isequal (s1, s2) && isequal (n1, n2) && s1(26) - s1(25) == 13);
    s3 = perigal_family (x, 2, 'closed', false);
    verdict ('family: an open ball lacks its four ends', s3(26) - s3(25) == 9);
    [~, n4] = perigal_family (x, '3 spacing', 'volume', 0.25, 'thickness', 1);
    [~, n5] = perigal_family (x, 1.5);
    verdict ('family: the spacing follows from volumes', isequal (n4, n5));
end

function same = same_lists (x, centre, horizon, support)
    [start, node] = perigal_family (x, horizon, 'centres', centre, 'support', support);
    same = numel (start) == size (centre, 1) + 1;
    for k = 1:size (centre, 1)
        away = abs (x - repmat (centre(k, :), size (x, 1), 1));
        if strcmp (support, 'radial'), d = sqrt (sum (away .^ 2, 2)); else, d = max (away, [], 2); end
        same = same && isequal (node(start(k):start(k + 1) - 1), find (d <= horizon));
    end
end

function shapes ()
    kinds = {'rkpm', 1; 'rkpm', 2; 'pddo', 1; 'pddo', 2; 'nosb', 1; 'nosb', 2};
    for dim = 2:3
        m = 9 - dim;
        c = cell (1, dim);
        [c{:}] = ndgrid (1:m);
        x = cell2mat (cellfun (@(v) v(:), c, 'UniformOutput', false));
        inner = all (x > 1 & x < m, 2);
        x(inner, :) = x(inner, :) + 0.3 * (rand (sum (inner), dim) - 0.5);
        place = 2 + (m - 3) * rand (30, dim);
        for k = 1:size (kinds, 1)
            reach = 2.2 + 0.8 * (kinds{k, 2} == 2);
            [off, slope] = misses (x, reach, place, kinds{k, :});
            verdict (sprintf ('shape: %s, order %d, %dD: polynomials and their derivatives to 1e-12', kinds{k, :}, dim), off < 1e-12 && slope < 1e-12);
        end
    end
    [a, b] = meshgrid (0:9, 0:9);
    x = [a(:), b(:)];
    [start, node] = perigal_family (x, '2.5 spacing', 'closed', false);
    owner = zeros (numel (node), 1);
    for k = 1:numel (start) - 1, owner(start(k):start(k + 1) - 1) = k; end
    alive = (x(owner, 1) < 4.5) == (x(node, 1) < 4.5);
    [N, dN, grade] = perigal_shape (x, '2.5 spacing', 'alive', alive);
    u = 3 + 2 * x(:, 1) + 5 * (x(:, 1) > 4.5) - x(:, 2);          % a jump over the cut
    verdict ('shape: a cut keeps the sides apart', max (abs (N * u - u)) < 1e-12 && max (abs (dN{1} * u - 2)) < 1e-12 && all (grade == 0));
    verdict ('shape: cut bonds have no part', nnz (N(x(:, 1) < 4.5, x(:, 1) > 4.5)) == 0);
    [~, ~, grade] = perigal_shape (x, 1.5, 'places', [50 50; 4 4]);
    verdict ('shape: a place without neighbours says so', isequal (grade, [4; 0]));
    N = perigal_shape (x, 2.5, 'approximation', 'nosb');
    verdict ('shape: nosb at its own nodes is the identity', isequal (N, speye (100)));
end

function [off, slope] = misses (x, reach, place, approximation, order)
% How far off monomials up to the order are, and their derivatives, relative to their size.
    [N, dN] = perigal_shape (x, reach, 'spacing', 1, 'places', place, 'approximation', approximation, 'order', order);
    dim = size (x, 2);
    off = 0; slope = 0;
    for p = 0:order * dim
        e = [floor(p / order) == (0:dim - 1)] * (mod (p, order) + 1);   % x^1 .. x^order, then y ...
        f = @(z) prod (z .^ repmat (e, size (z, 1), 1), 2);
        off = max (off, max (abs (N * f(x) - f(place))) / max (abs (f(x))));
        for k = 1:dim
            d = e; d(k) = max (e(k) - 1, 0);
            g = e(k) * prod (place .^ repmat (d, size (place, 1), 1), 2);
            slope = max (slope, max (abs (dN{k} * f(x) - g)) / max (abs (f(x))));
        end
    end
end

% ---- bonds ------------------------------------------------------------------------------------------------------------
function constants (work)
    E = 65e9; G = 135; d = 3e-3; t = 1e-3;
    c = perigal_constants (2, d, E, 1/3, 'thickness', t, 'fracture_energy', G);
    verdict ('constants: plane stress, closed forms', close_to (c.micromodulus, 9 * E / (pi * t * d ^ 3), 1e-13) ...
             && close_to (c.critical_stretch, sqrt (4 * pi * G / (9 * E * d)), 1e-12) && close_to (c.bond_poisson, 1/3, 1e-15));
    c = perigal_constants (2, '3 mm', E, 0.25, 'plane', 'strain', 'thickness', '1 mm', 'fracture_energy', G);
    verdict ('constants: plane strain, closed forms', close_to (c.micromodulus, 48 * E / (5 * pi * t * d ^ 3), 1e-13) ...
             && close_to (c.critical_stretch, sqrt (5 * pi * G / (12 * E * d)), 1e-12));
    c = perigal_constants (3, d, E, 0.25, 'fracture_energy', G);
    K = E / 1.5; mu = E / 2.5;
    verdict ('constants: solid, closed forms', close_to (c.micromodulus, 18 * K / (pi * d ^ 4), 1e-13) ...
             && close_to (c.critical_stretch, sqrt (5 * G / (9 * K * d)), 1e-12) && close_to (c.energy_density, G / (2 * d), 1e-15) ...
             && close_to (c.deviation, 15 * mu, 1e-12));
    c = perigal_constants (3, d, E, 0.1, 'fracture_energy', G);
    k = E / (3 * (1 - 0.2)); mu = E / 2.2;
    verdict ('constants: state-based', close_to (c.dilation, 3 * k - 5 * mu, 1e-12) && close_to (c.deviation, 15 * mu, 1e-12));
    c = perigal_constants (2, d, E, 0.4);
    verdict ('constants: what there is not is NaN', isnan (c.critical_stretch) && isnan (c.beam_shear) && isnan (c.energy_density) && isnan (c.growth));
    forces = {'bond', 1/3, 'critical_stretch', 'stretch'; 'lps', 0.2, 'state_stretch', 'stretch'; 'gmpd', 0.2, 'beam_limits', 'beam_limits'; ...
              'fcbm', 1/3, 'energy_density', 'node_energy'};
    for k = 1:4
        s = strip ();
        s.materials.glass.poissons_ratio = forces{k, 2};
        s.method.force = forces{k, 1};
        s.failure = struct ('criterion', forces{k, 4}, 'fracture_energy', 4, 'calibration', 'theory');
        if k == 4, s.failure = rmfield (s.failure, 'calibration'); end
        p = perigal_check (s);
        words = p.materials(1);
        if iscell (words), words = words{1}; end
        numbers = cellfun (@str2double, regexp (words.criterion, '\d[\d.]*(e[-+]?\d+)?', 'match'));
        c = perigal_constants (2, 3e-3, 70e9, forces{k, 2}, 'thickness', 1e-3, 'spacing', 1e-3, 'fracture_energy', 4);
        mine = c.(forces{k, 3});
        verdict (['constants: the limits of a scene with ' forces{k, 1}], all (abs (numbers(1:numel (mine)) ./ mine - 1) < 6e-6));
    end
end

function yes = close_to (a, b, tolerance)
    yes = abs (a / b - 1) <= tolerance;
end

function forces ()
% Sums over bonds from nothing but places: all or nothing within the horizon.
    for dim = 1:3
        n = 12 - 2 * dim;
        c = cell (1, dim);
        [c{:}] = ndgrid ((1:n) * 1e-3);
        x = cell2mat (cellfun (@(v) v(:), c(1:dim), 'UniformOutput', false));
        u = 1e-6 * rand (size (x));
        for where = {'list', 'stencil', 'fft'}
            h = perigal_bonds (x, '2.2 spacing', 3e18, 'spacing', 1e-3, 'partial_volume', 'none', 'evaluation', where{1});
            [f, W] = perigal_bond_force (h, u);
            [g, V] = direct (x, u, 2.2e-3, 3e18, 1e-3 ^ dim, @(i, j) true (size (j)));
            verdict (sprintf ('forces: %s in %dD: the direct sum to 1e-12', where{1}, dim), ...
                     norm (f - g, 'fro') <= 1e-12 * norm (g, 'fro') && norm (W - V) <= 1e-12 * norm (V));
            b = perigal_bond_list (h);
            keep = mod (b.i .* b.j, 3) ~= 0;
            perigal_bond_mask (h, keep)
            f = perigal_bond_force (h, u);
            g = direct (x, u, 2.2e-3, 3e18, 1e-3 ^ dim, @(i, j) mod (i * j, 3) ~= 0);
            verdict (sprintf ('forces: %s in %dD, every third bond cut', where{1}, dim), norm (f - g, 'fro') <= 1e-12 * norm (g, 'fro'));
            perigal_bond_mask (h, true (size (keep)))
            verdict (sprintf ('forces: %s in %dD, whole again', where{1}, dim), norm (perigal_bond_force (h, u) - direct (x, u, 2.2e-3, 3e18, 1e-3 ^ dim, @(i, j) true (size (j))), 'fro') <= 1e-12 * norm (g, 'fro'));
            perigal_close (h)
        end
    end
    x = rand (120, 2);
    v = 1e-4 * (1 + rand (120, 1));
    u = 1e-3 * rand (120, 2);
    h = perigal_bonds (x, 0.3, 7e9, 'volume', v, 'kernel', 'conical', 'surface_correction', 'volume', 'calibrate', true);
    b = perigal_bond_list (h);
    f = perigal_bond_force (h, u);
    r = sqrt (sum (b.xi .^ 2, 2));
    s = sum (b.xi .* (u(b.j, :) - u(b.i, :)), 2) ./ r .^ 2;
    g = zeros (size (u));
    for k = 1:2
        g(:, k) = accumarray (b.i, v(b.i) .* v(b.j) .* b.micromodulus .* b.weight .* s .* b.xi(:, k) ./ r, [120 1]);
    end
    verdict ('forces: irregular points, by the weights of the list', norm (f - g, 'fro') <= 1e-12 * norm (g, 'fro') && strncmp (b.evaluation, 'list', 4));
    verdict ('forces: bonds point from i to j', max (max (abs (b.xi - (x(b.j, :) - x(b.i, :))))) < 1e-15 && max (abs (sum (f))) <= 1e-12 * max (max (abs (f))));
    perigal_close (h)
end

function [f, W] = direct (x, u, horizon, c, volume, alive)
    f = zeros (size (x)); W = zeros (size (x, 1), 1);
    for i = 1:size (x, 1)
        xi = x - repmat (x(i, :), size (x, 1), 1);
        r = sqrt (sum (xi .^ 2, 2));
        j = find (r > 0 & r <= horizon * (1 + 1e-9));
        j = j(alive (i, j));
        s = sum (xi(j, :) .* (u(j, :) - repmat (u(i, :), numel (j), 1)), 2) ./ r(j) .^ 2;
        for k = 1:size (x, 2)
            f(i, k) = c * volume ^ 2 * sum (s .* xi(j, k) ./ r(j));
        end
        W(i) = c * volume / 4 * sum (s .^ 2 .* r(j));
    end
end

function arrays ()
% The operator on arrays as meshgrid lays them out, against the direct sum over its points.
    [x, y] = meshgrid ((0:13) * 1e-3, (0:9) * 1e-3);
    chi = hypot (x - 6e-3, y - 4e-3) > 2e-3;
    op = perigal_fcbm (chi, '1 mm', '3 spacing', 2e20, 'partial_volume', 'none', 'thickness', 2e-3);
    u = 1e-6 * rand ([size(chi), 2]);
    holes = repmat (~chi, [1 1 2]);
    u(holes) = NaN;                                               % outside nothing is read
    [f, W] = perigal_bond_force (op, u);
    points = [x(chi), y(chi)];
    ux = u(:, :, 1); uy = u(:, :, 2); fx = f(:, :, 1); fy = f(:, :, 2);
    [g, V] = direct (points, [ux(chi), uy(chi)], 3e-3, 2e20, 2e-9, @(i, j) true (size (j)));
    verdict ('arrays: forces where the mask is true, to 1e-12', norm ([fx(chi), fy(chi)] - g, 'fro') <= 1e-12 * norm (g, 'fro') && norm (W(chi) - V) <= 1e-12 * norm (V));
    verdict ('arrays: nothing elsewhere', all (f(holes) == 0) && all (W(~chi) == 0));
    b = perigal_bond_list (op);
    verdict ('arrays: by transforms, sites in the array', strncmp (b.evaluation, 'fft', 3) && isequal (b.site, find (chi)));
    dead = x > 10.5e-3;
    perigal_bond_mask (op, ~dead)
    f = perigal_bond_force (op, u);
    fx = f(:, :, 1); fy = f(:, :, 2);
    lives = ~dead(chi);
    g = direct (points, [ux(chi), uy(chi)], 3e-3, 2e20, 2e-9, @(i, j) lives(i) & lives(j));
    verdict ('arrays: points that have failed', norm ([fx(chi), fy(chi)] - g, 'fro') <= 1e-12 * norm (g, 'fro') && all (fx(dead & chi) == 0));
    perigal_close (op)
    op = perigal_fcbm (true (5, 6, 7), 1e-3, 2e-3, 1e22, 'partial_volume', 'none');
    [x, y, z] = meshgrid ((0:5) * 1e-3, (0:4) * 1e-3, (0:6) * 1e-3);
    u = 1e-6 * rand (5, 6, 7, 3);
    f = reshape (perigal_bond_force (op, u), [], 3);
    g = direct ([x(:), y(:), z(:)], reshape (u, [], 3), 2e-3, 1e22, 1e-9, @(i, j) true (size (j)));
    verdict ('arrays: in space', norm (f - g, 'fro') <= 1e-12 * norm (g, 'fro'));
    perigal_close (op)
end

% ---- scenes -----------------------------------------------------------------------------------------------------------
function s = strip ()
% A strip with a notch that is pulled apart.
    s = struct ('dimension', 2, 'plane', 'stress', 'thickness', '1 mm', 'spacing', '1 mm', 'lattice', 'cells');
    s.body = { struct('add', struct ('box', struct ('low', [0 0], 'high', [30e-3 12e-3]))) };
    s.cracks = { struct('from', [0 6e-3], 'to', [9.7e-3 6e-3]) };
    s.materials.glass = struct ('youngs_modulus', 70e9, 'poissons_ratio', 1/3, 'density', 2440);
    s.method = struct ('force', 'bond', 'horizon', '3 spacing');
    s.failure = struct ('criterion', 'stretch', 'fracture_energy', 4);
    s.boundary = { struct('name', 'low', 'set', 'bottom', 'displacement', struct ('x', 0, 'y', 0)), ...
                   struct('name', 'high', 'set', 'top', 'displacement', struct ('y', 8e-6)) };
    s.solver.kind = 'static';
    s.output = struct ('at', struct ('levels', 4));
    s.output.pictures = {};
end

function s = moving ()
    s = strip ();
    s.solver = struct ('kind', 'verlet', 'end', 8e-6);
    s.output.at.rows = 20;
end

function matrices (work)
    methods = {'rkpm', struct('approximation', 'rkpm', 'integration', 'gauss', 'horizon', '2 spacing'); ...
               'pddo', struct('approximation', 'pddo', 'integration', 'nodal', 'horizon', '2.5 spacing'); ...
               'bond', struct('force', 'bond', 'horizon', '3 spacing'); ...
               'gmpd', struct('force', 'gmpd', 'horizon', '3 spacing')};
    for k = 1:size (methods, 1)
        s = strip ();
        s = rmfield (s, 'failure');
        s.method = methods{k, 2};
        s.boundary{end + 1} = struct ('name', 'side', 'set', 'right', 'traction', struct ('x', 1e6));
        file = fullfile (work, [methods{k, 1} '.yaml']);
        perigal_write (file, s);
        h = perigal_session (file);
        [K, f, info] = perigal_stiffness (h);
        [status, text] = system (sprintf ('%s %s %s', fullfile (work, 'export_matrix'), file, fullfile (work, 'K.mtx')));
        own = read_matrix (fullfile (work, 'K.mtx'), text);
        verdict (['stiffness: ' methods{k, 1} ': K is the library''s own, bit by bit'], status == 0 && nnz (own) > 5000 && isequal (own, info.K) && isequal (info.K, info.K'));
        r = perigal_run (file, 'out', fullfile (work, methods{k, 1}), 'progress', false, 'threads', 1);
        u = info.displacement (K \ f);
        run = perigal_field (r, 'displacement');
        verdict (['stiffness: ' methods{k, 1} ': K \ f is the displacement of result.e to 1e-10'], max (max (abs (u - run))) <= 1e-10 * max (max (abs (run))));
        verdict (['stiffness: ' methods{k, 1} ': free and held'], isequal (sort ([info.free; info.held]), (1:size (info.K, 1))') && size (K, 1) == numel (info.free));
        [~, f2] = perigal_stiffness (h, 0.5);
        verdict (['stiffness: ' methods{k, 1} ': half the load'], norm (f2 - f / 2) <= 1e-12 * norm (f));
        perigal_close (h)
    end
    K2 = perigal_stiffness (s);
    verdict ('stiffness: of a scene itself', isequal (K2, K));
end

function A = read_matrix (file, text)
% A symmetric Matrix Market file; numbers of 17 digits give the same bits.
    A = [];
    if exist (file, 'file') ~= 2, disp (text); return; end
    id = fopen (file, 'r');
    line = fgetl (id);
    while line(1) == '%', line = fgetl (id); end
    n = sscanf (line, '%d')';
    t = fscanf (id, '%f', [3 Inf])';
    fclose (id);
    L = sparse (t(:, 1), t(:, 2), t(:, 3), n(1), n(2));
    A = L + tril (L, -1)';
    stored = sparse (t(:, 1), t(:, 2), 1, n(1), n(2));
    if nnz (stored) ~= n(3), A = []; end
end

function stepping (work)
    kinds = {'static', strip(); 'fixed', strip(); 'verlet', moving(); 'newmark', moving()};
    kinds{2, 2}.solver = struct ('kind', 'static', 'stepping', 'fixed', 'steps', 4);
    kinds{4, 2}.solver = struct ('kind', 'newmark', 'dt', 4e-7, 'end', 8e-6);
    if ~full_size (), kinds(2, :) = []; end
    for k = 1:size (kinds, 1)
        r = perigal_run (kinds{k, 2}, 'out', fullfile (work, ['run_' kinds{k, 1}]), 'progress', false, 'threads', 1);
        history = perigal_history (r, 'high.force_y', 'low.force_y', 'energy_strain', 'energy_external');
        h = perigal_session (kinds{k, 2});
        s = perigal_step (h, 'end');
        mine = [arrayfun(@(a) a.reaction(2, 2), s)', arrayfun(@(a) a.reaction(1, 2), s)', [s.energy_strain]', [s.energy_external]'];
        history = history(end - numel (s) + 1:end, :);
        verdict (['step: ' kinds{k, 1} ': forces and energies of every row are those of the run, bit by bit'], isequal (mine, history));
        same = isequal (perigal_get (h, 'displacement'), perigal_field (r, 'displacement')) && isequal (perigal_get (h, 'damage'), perigal_field (r, 'damage')) ...
               && isequal (perigal_get (h, 'stress'), perigal_field (r, 'stress')) && isequal (perigal_get (h, 'place'), perigal_field (r, 'place'));
        verdict (['step: ' kinds{k, 1} ': fields are those of the run, bit by bit'], same);
        report = perigal_report (r);
        broken = sum (arrayfun (@(a) size (a.broken, 1), s));
        verdict (['step: ' kinds{k, 1} ': as many bonds broke'], broken == report.broken && broken > 0 && perigal_get (h, 'done') && s(end).done);
        refused (['step: ' kinds{k, 1} ': none after the end'], 'perigal:argument', 'come to its end', @() perigal_step (h));
        perigal_close (h)
    end
end

function changes (work) %#ok<INUSD>
    h = perigal_session (moving ());
    x = perigal_get (h, 'place');
    v = [100 * x(:, 1), -50 * x(:, 2)];
    perigal_set (h, 'velocity', v)
    verdict ('set: the velocity is there', isequal (perigal_get (h, 'velocity'), v) && isequal (perigal_get (h, 'v'), reshape (v', [], 1)));
    s = perigal_step (h);
    verdict ('set: and the body moves', s.energy_kinetic > 0.1 * 0.5 * 2440 * 1e-9 * sum (sum (v .^ 2)));
    refused ('set: not after the first step', 'perigal:argument', 'before the first step', @() perigal_set (h, 'velocity', v));
    perigal_close (h)
    h = perigal_session (strip ());
    refused ('set: not under static loads', 'perigal:argument', 'in dynamics', @() perigal_set (h, 'displacement', v));
    b = perigal_get (h, 'bonds');
    verdict ('get: bonds see what they say', numel (b.point) == numel (perigal_get (h, 'alive')) && max (sqrt (sum ((b.place - x(b.point, :)) .^ 2, 2))) <= 3.8e-3);
    cut = (b.place(:, 1) < 15e-3) ~= (x(b.point, 1) < 15e-3);
    half = cut & b.owner < b.point;
    perigal_cut (h, find (half))
    alive = perigal_get (h, 'alive');
    verdict ('cut: both directions', ~any (alive(cut)) && any (alive));
    [~, ~, info] = perigal_stiffness (h);
    left = x(:, 1) < 15e-3;
    sides = kron (left, [1; 1]) > 0;
    verdict ('cut: nothing of K is left across', nnz (info.K(sides, ~sides)) == 0 && nnz (info.K) > 1000);
    perigal_close (h)
    h = perigal_session (moving ());
    perigal_step (h, 3);
    perigal_cut (h, cut)
    s = perigal_step (h);
    verdict ('cut: in the middle of a run, by a mask', ~any (perigal_get (h, 'alive')(cut)) && isfinite (s.energy_strain));
    perigal_close (h)
end

function states (work)
    for kind = {'verlet', 'static'}
        scene = moving ();
        if strcmp (kind{1}, 'static'), scene = strip (); end
        file = fullfile (work, 'state.yaml');
        perigal_write (file, scene);
        h = perigal_session (file);
        perigal_step (h, 3);
        state = perigal_save (h);
        a = perigal_step (h, 2);
        other = perigal_session (file);
        perigal_restore (other, state)
        b = perigal_step (other, 2);
        perigal_restore (h, state)
        c = perigal_step (h, 2);
        verdict (['save: ' kind{1} ': the steps that follow have the same bits, here and in another session'], ...
                 isequaln (a, b) && isequaln (a, c) && isequal (perigal_get (h, 'd'), perigal_get (other, 'd')) && isa (state, 'uint8'));
        perigal_close (other)
        perigal_close (h)
    end
    h = perigal_session (file, 'set', {'spacing', '1.5 mm'});
    refused ('restore: of another scene', 'perigal:argument', 'another scene', @() perigal_restore (h, state));
    perigal_close (h)
    h = perigal_session (file);
    half = floor (numel (state) / 2);
    state(half) = bitxor (state(half), uint8 (1));
    refused ('restore: damaged', 'perigal:failed', 'damaged', @() perigal_restore (h, state));
    refused ('restore: no state', 'perigal:argument', 'uint8', @() perigal_restore (h, 1:5));
    refused ('restore: too short', 'perigal:failed', 'too early', @() perigal_restore (h, uint8 (1:5)));
    perigal_close (h)
end

% ---- errors -----------------------------------------------------------------------------------------------------------
function lists_of_errors (work)
    x = rand (20, 2);
    argument = 'perigal:argument';
    refused ('family: nothing', argument, 'needs points', @() perigal_family ());
    refused ('family: complex points', argument, 'real', @() perigal_family (1i * x, 1));
    refused ('family: text for points', argument, 'real', @() perigal_family ('x', 1));
    refused ('family: four coordinates', argument, 'columns', @() perigal_family (rand (5, 4), 1));
    refused ('family: twice the same point', argument, 'same place', @() perigal_family ([0 0; 1 1; 0 0], 1, 'spacing', 1));
    refused ('family: NaN', argument, 'coordinate 2 of point 1', @() perigal_family ([0 NaN; 1 1], 1, 'spacing', 1));
    refused ('family: a horizon of 0', argument, 'above 0', @() perigal_family (x, 0));
    refused ('family: a horizon that is no length', argument, 'Pa', @() perigal_family (x, '3 Pa'));
    refused ('family: a horizon that is a matrix', argument, 'length', @() perigal_family (x, [1 2]));
    refused ('family: unknown option', argument, 'centres', @() perigal_family (x, 1, 'center', x));
    refused ('family: centres of another dimension', argument, 'columns', @() perigal_family (x, 1, 'centres', rand (2, 3)));
    refused ('family: unknown support', argument, 'radial|tensor', @() perigal_family (x, 1, 'support', 'cube'));
    refused ('family: volumes below 0', argument, 'volume', @() perigal_family (x, 1, 'volume', -1));
    refused ('family: as many volumes as points', argument, 'volumes', @() perigal_family (x, 1, 'volume', [1 2 3]));
    refused ('shape: unknown approximation', argument, 'rkpm', @() perigal_shape (x, 1, 'approximation', 'fem'));
    refused ('shape: unknown kernel', argument, 'cubic_spline', @() perigal_shape (x, 1, 'kernel', 'box'));
    refused ('shape: order 3', argument, 'order', @() perigal_shape (x, 1, 'order', 3));
    refused ('shape: order as text', argument, 'order', @() perigal_shape (x, 1, 'order', {}));
    refused ('shape: a horizon below a spacing', argument, 'no neighbour', @() perigal_shape (x, '0.5 spacing'));
    refused ('shape: a mask of another size', argument, 'alive', @() perigal_shape (x, 1, 'alive', true (3, 1)));
    refused ('shape: a mask that is none', argument, 'alive', @() perigal_shape (x, 1, 'alive', 'yes'));
    refused ('constants: nothing', argument, 'needs', @() perigal_constants (2, 1));
    refused ('constants: four dimensions', argument, 'dimensions', @() perigal_constants (4, 1, 1, 0.2));
    refused ('constants: Poisson''s ratio', argument, 'between', @() perigal_constants (2, 1, 1, 0.5));
    refused ('constants: E', argument, 'above 0', @() perigal_constants (2, 1, -1, 0.2));
    refused ('constants: plane in space', argument, 'plane', @() perigal_constants (3, 1, 1, 0.2, 'plane', 'stress'));
    refused ('constants: horizon in spacings without one', argument, 'spacing', @() perigal_constants (2, '3 spacing', 1, 0.2));
    refused ('constants: energy', argument, 'fracture_energy', @() perigal_constants (2, 1, 1, 0.2, 'fracture_energy', 0));
    refused ('bonds: no micromodulus', argument, 'needs', @() perigal_bonds (x, 1));
    refused ('bonds: micromodulus', argument, 'micromodulus', @() perigal_bonds (x, 1, -1));
    refused ('bonds: overlap without a lattice', argument, 'lattice', @() perigal_bonds (x, 1, 1, 'partial_volume', 'overlap'));
    refused ('bonds: transforms without a lattice', argument, 'lattice', @() perigal_bonds (x, 1, 1, 'evaluation', 'fft'));
    refused ('fcbm: no mask', argument, 'logical', @() perigal_fcbm (ones (3), 1, 2, 1));
    refused ('fcbm: an empty mask', argument, 'true', @() perigal_fcbm (false (3), 1, 2, 1));
    h = perigal_bonds (x, 0.5, 1);
    refused ('bond_force: another shape', argument, 'not 20 x 2', @() perigal_bond_force (h, rand (2, 20)));
    refused ('bond_force: NaN', argument, 'displacement of point 3', @() perigal_bond_force (h, [zeros(2); NaN 0; zeros(17, 2)]));
    refused ('bond_force: text', argument, 'real', @() perigal_bond_force (h, 'u'));
    refused ('bond_mask: another size', argument, 'entries', @() perigal_bond_mask (h, true));
    refused ('bond_mask: numbers', argument, 'true and false', @() perigal_bond_mask (h, 7 * ones (size (perigal_bond_list (h).i))));
    refused ('step: a handle of bonds', argument, 'another kind', @() perigal_step (h));
    perigal_close (h)
    refused ('bond_force: a closed handle', argument, 'closed', @() perigal_bond_force (h, x));
    refused ('close: twice', argument, 'no open handle', @() perigal_close (h));
    for wrong = {0, -1, 1.5, NaN, Inf, 'h', {}, [], uint64(2) ^ 60, int32(1), 1i, [1 2], struct(), @sin, true, 1e300}
        refused (['handle: ' class(wrong{1}) ' that is none'], argument, 'handle', @() perigal_get (wrong{1}));
    end
    op = perigal_fcbm (true (4), 1, 2, 1);
    refused ('bond_force: an array of another shape', argument, 'not [4 4 2]', @() perigal_bond_force (op, rand (4, 4)));
    perigal_close (op)
    refused ('session: no scene', argument, 'scene', @() perigal_session ());
    refused ('session: no such file', 'perigal:scene', 'nowhere.yaml', @() perigal_session ('nowhere.yaml'));
    refused ('session: unknown option', argument, 'set, threads', @() perigal_session ('nowhere.yaml', 'out', 'x'));
    refused ('session: threads', argument, 'threads', @() perigal_session (strip (), 'threads', 1000));
    bad = fullfile (work, 'bad.yaml');
    perigal_write (bad, strip ());
    refused ('session: a wrong value', 'perigal:scene', 'must lie in', @() perigal_session (bad, 'set', {'materials.glass.poissons_ratio', 0.7}));
    refused ('session: a wrong key', 'perigal:scene', 'did you mean spacing', @() perigal_session (bad, 'set', {'spacng=1'}));
    h = perigal_session (bad, 'set', repmat ({'title=a hundred times'}, 1, 100));
    verdict ('session: many values replaced', strcmp (perigal_get (h, 'title'), 'a hundred times'));
    perigal_close (h)
    s = strip ();
    s.method.force = 'lps';
    h = perigal_session (s);
    refused ('stiffness: no matrix', argument, 'neighbours of neighbours', @() perigal_stiffness (h));
    refused ('stiffness: load factor', argument, 'load factor', @() perigal_stiffness (h, 'x'));
    refused ('get: unknown', argument, 'load_factor', @() perigal_get (h, 'strss'));
    refused ('get: a field that the force has not', argument, 'displacement', @() perigal_get (h, 'rotation'));
    refused ('set: unknown', argument, 'displacement|velocity', @() perigal_set (h, 'speed', 1));
    refused ('cut: no such bond', argument, 'no bond', @() perigal_cut (h, 1e9));
    refused ('cut: half a bond', argument, 'no bond', @() perigal_cut (h, 1.5));
    refused ('cut: a mask of another size', argument, 'entry for each', @() perigal_cut (h, true));
    refused ('step: half a step', argument, 'whole number', @() perigal_step (h, 1.5));
    perigal_close (h)
    s = moving ();
    s.boundary{2}.displacement.y = 1;
    s.solver.end = 8e-5;
    s.failure = struct ('criterion', 'stretch', 'critical_stretch', 1e9);
    refused ('gateway: no command', argument, 'name of a command', @() perigal_mex (7));
    refused ('gateway: unknown command', argument, 'no command', @() perigal_mex ('fly'));
    refused ('gateway: too few arguments', argument, 'arguments', @() perigal_mex ('family', 1));
end

% ---- handles and memory -----------------------------------------------------------------------------------------------
function handles (root, work) %#ok<INUSD>
    [n, held] = perigal_mex ('handles');
    h = [perigal_session(strip ()), perigal_session(strip ())];
    perigal_fcbm (true (9), 1, 2, 1);
    verdict ('handles: numbers of their own', isa (h, 'uint64') && h(1) ~= h(2) && perigal_mex ('handles') == n + 3);
    clear perigal_mex
    verdict ('handles: `clear` closes all of them', perigal_mex ('handles') == 0);
    [~, now] = perigal_mex ('handles');
    verdict ('handles: and gives their memory back', now <= held);
    refused ('handles: those from before are not valid', 'perigal:argument', 'closed', @() perigal_get (h(1)));
    h2 = perigal_session (strip ());
    verdict ('handles: new ones work', perigal_get (h2, 'points') == 360);
    perigal_close (double (h2))                                   % a double will do
end

function memory (work)
% Open, step, matrices, errors, close, 200 times (60 in short size): the process does not grow.
    rounds = 60;
    if full_size (), rounds = 200; end
    file = fullfile (work, 'small.yaml');
    s = moving ();
    s.spacing = '2 mm';
    s.method.accept_inexact = true;
    perigal_write (file, s);
    x = rand (60, 2);
    [~, before] = perigal_mex ('handles');
    for k = 1:30 + rounds
        h = perigal_session (file);
        perigal_step (h, 2);
        perigal_restore (h, perigal_save (h));
        [K, f] = perigal_stiffness (h); %#ok<ASGLU>
        try, perigal_get (h, 'nothing'); catch, end
        perigal_close (h)
        [N, dN] = perigal_shape (x, 0.5); %#ok<ASGLU>
        op = perigal_fcbm (true (8, 9), 1, 3, 1);
        perigal_bond_force (op, zeros (8, 9, 2));
        try, perigal_family (x, 1, 'centres', rand (2, 3)); catch, end
        perigal_close (op)
        if k == 30, first = resident (); end
    end
    last = resident ();
    [n, after] = perigal_mex ('handles');
    printf ('# resident after 30 rounds %.1f MB, after %d more %.1f MB\n', first / 2 ^ 20, rounds, last / 2 ^ 20);
    verdict ('memory: rounds leave nothing in the library', n == 0 && after <= before);
    verdict ('memory: rounds leave the process as large as it was', last - first < rounds / 200 * 8 * 2 ^ 20);
end

function yes = full_size ()
    yes = strcmp (getenv ('PERIGAL_TEST_SIZE'), 'long');
end

function bytes = resident ()
    [~, text] = system (sprintf ('cat /proc/%d/statm', getpid ()));
    bytes = 4096 * sscanf (text, '%*d %d', 1);
end

% SPDX-License-Identifier: GPL-3.0-or-later
