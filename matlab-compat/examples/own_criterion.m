% A criterion of one's own, tried on the exported matrix: at which load, and where, does a glass plate with a hole begin to break if
% bonds along a weak direction bear only 60 % of the others? First the criterion of the program itself, as a check.
here = fileparts (mfilename ('fullpath'));
scene = fullfile (here, 'plate.yaml');
folder = 'out/examples/own_criterion';
plan = perigal_check (scene, 'matrix', folder, 'solve', true);
K = read_matrix (fullfile (folder, 'K.mtx'));
T = read_matrix (fullfile (folder, 'T.mtx'));
N = read_matrix (fullfile (folder, 'N.mtx'));
f = read_matrix (fullfile (folder, 'f.mtx'));
g = read_matrix (fullfile (folder, 'g.mtx'));
q = (T' * K * T) \ (T' * (f - K * g));                  % the equilibrium at the full load
u = reshape (N * (T * q + g), 2, [])';
x = dlmread (fullfile (folder, 'points.csv'), ',', 1, 0);
x = x(:, 1:2);

% All bonds whose ends may break: shorter than the horizon, no end in the grips.
free = find (abs (x(:, 2)) < max (x(:, 2)) - 1e-9);
[a, b] = meshgrid (free, free);
pairs = [a(:), b(:)];
pairs = pairs(pairs(:, 1) < pairs(:, 2), :);
xi = x(pairs(:, 2), :) - x(pairs(:, 1), :);
near = sum (xi .^ 2, 2) <= (plan.horizon * (1 + 1e-9)) ^ 2;
pairs = pairs(near, :);
xi = xi(near, :);
stretch = sum (xi .* (u(pairs(:, 2), :) - u(pairs(:, 1), :)), 2) ./ sum (xi .^ 2, 2);

% The program's own: a bond breaks at a stretch of 1e-3; everything is proportional to the load.
[worst, k] = max (stretch / 1e-3);
factor = 1 / worst;
fprintf ('stretch:        first break at load factor %.10f, by the program %.10f\n', factor, plan.first_break.load_factor);

% My own: bonds within 20 degrees of 45 degrees are weak.
angle = mod (atan2 (xi(:, 2), xi(:, 1)) * 180 / pi, 180);
limit = 1e-3 * ones (size (stretch));
limit(abs (angle - 45) < 20) = 0.6e-3;
[worst, k] = max (stretch ./ limit);
own_factor = 1 / worst;
place = (x(pairs(k, 1), :) + x(pairs(k, 2), :)) / 2;
fprintf ('weak direction: first break at load factor %.4f, at (%.1f, %.1f) mm\n', own_factor, 1e3 * place);

% How close each point is to breaking, by the worst of its bonds.
close_to = accumarray (pairs(:), repmat (stretch ./ limit, 2, 1) * own_factor, [size(x, 1) 1], @max);
scatter (x(free, 1) * 1e3, x(free, 2) * 1e3, 40, close_to(free), 'filled'), axis equal, colorbar
xlabel ('x [mm]'), ylabel ('y [mm]'), title ('utilisation at the first break, weak direction 45 degrees')
% SPDX-License-Identifier: GPL-3.0-or-later
