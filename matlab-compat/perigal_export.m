function perigal_export (file, r, varargin)
% PERIGAL_EXPORT  Save a result as a .mat file.
%
%   PERIGAL_EXPORT (FILE, R) saves places, volumes, all fields at all steps, history and report.
%   Options:
%     'fields'   cell of field names (default: all)
%     'steps'    numbers, 'last' or 'all' (default)
%     'version'  'v5' (default; up to 2 GB a variable) or 'v7.3' (HDF5; written by MATLAB only)
%     'names'    'perigal' (default): x, volume, times, history, and one array per field, points x components x
%                steps; 'fcbm': names and shapes of PeriFast/Dynamics, the code of the fast convolution method in
%                MATLAB: X, Y, Z (of meshgrid: rows along y), chiB (1 inside the body), dv, and Output(step).u1, u2, u3,
%                v1, v2, v3 (where the run has velocities), d (damage), 0 outside the body
%
%   Errors: perigal:argument, perigal:field, perigal:step, perigal:file.
%
%   Example
%     perigal_export ('demo.mat', 'out/demo', 'fields', {'displacement', 'damage'}, 'steps', 'last');
%
%   See also PERIGAL_FIELD.

    if nargin < 2 || ~is_text (file)
        error ('perigal:argument', 'perigal_export: needs a file and a result');
    end
    if ~isstruct (r), r = perigal_open (r); end
    o = options_of ('perigal_export', {'fields', 'steps', 'version', 'names'}, varargin);
    version = choice (o, 'version', {'v5', 'v7.3'});
    names = choice (o, 'names', {'perigal', 'fcbm'});
    steps = 'all';
    if isfield (o, 'steps'), steps = o.steps; end
    if strcmp (version, 'v7.3') && is_octave ()
        error ('perigal:argument', 'perigal_export: Octave cannot write v7.3; choose v5, or export in MATLAB');
    end
    if strcmp (names, 'fcbm')
        data = on_grid (r, steps);
    else
        data = as_named (r, o, steps);
    end
    way = '-v6';                % the name that both programs have for version 5 without compression
    if strcmp (version, 'v7.3'), way = '-v7.3'; end
    save (char (file), '-struct', 'data', way);
end

function value = choice (o, name, allowed)
    value = allowed{1};
    if isfield (o, name)
        value = char (o.(name));
    end
    if ~any (strcmp (allowed, value))
        error ('perigal:argument', 'perigal_export: %s must be one of %s', name, strjoin (allowed, ', '));
    end
end

function data = as_named (r, o, steps)
    data.x = perigal_field (r, 'place');
    data.volume = perigal_field (r, 'point_volume');
    chosen = {r.fields.name};
    if isfield (o, 'fields'), chosen = o.fields; end
    if is_text (chosen), chosen = {chosen}; end
    for k = 1:numel (chosen)
        [data.(chosen{k}), info] = perigal_field (r, chosen{k}, '', steps);
        data.times = info.times;
    end
    data.title = r.title;
    data.history = perigal_history (r);
    if exist (fullfile (r.folder, 'report.json'), 'file')
        data.report = perigal_report (r);
    end
end

function data = on_grid (r, steps)
% Points of a regular lattice to arrays over the box around them, in the order of meshgrid.
    [at, axes_of] = lattice_of (r);
    n = [1 1 1];
    n(1:r.dimension) = max (at, [], 1);
    columns = ones (r.points, 3);
    columns(:, 1:r.dimension) = at;
    shape = n([2 1 3]);
    where = sub2ind (shape, columns(:, 2), columns(:, 1), columns(:, 3));
    [data.X, data.Y, data.Z] = meshgrid (axes_of{1}, axes_of{2}, axes_of{3});
    data.chiB = zeros (shape);
    data.chiB(where) = 1;
    data.dv = max (perigal_field (r, 'point_volume'));
    data.Output = struct ([]);
    directions = 'xyz';
    for k = 1:r.dimension
        data.Output = spread (data.Output, sprintf ('u%d', k), r, {'displacement', directions(k)}, steps, where, shape);
        if any (strcmp ({r.fields.name}, 'velocity'))
            data.Output = spread (data.Output, sprintf ('v%d', k), r, {'velocity', directions(k)}, steps, where, shape);
        end
    end
    if any (strcmp ({r.fields.name}, 'damage'))
        data.Output = spread (data.Output, 'd', r, {'damage', ''}, steps, where, shape);
    end
end

function [at, axes_of] = lattice_of (r)
% Row, column and layer of each point, and the places of these along each axis.
    x = perigal_field (r, 'place');
    at = zeros (size (x));
    axes_of = {0, 0, 0};
    for k = 1:r.dimension
        at(:, k) = round ((x(:, k) - min (x(:, k))) / r.spacing) + 1;
        axes_of{k} = min (x(:, k)) + (0:max (at(:, k)) - 1) * r.spacing;
        if any (abs (x(:, k) - axes_of{k}(at(:, k))') > 1e-6 * r.spacing)
            error ('perigal:argument', 'perigal_export: names fcbm need points on one regular lattice');
        end
    end
end

function output = spread (output, name, r, field, steps, where, shape)
% One component at each step as an array over the box.
    v = perigal_field (r, field{:}, steps);
    for k = 1:size (v, 2)
        grid = zeros (shape);
        grid(where) = v(:, k);
        output(k).(name) = grid;
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
