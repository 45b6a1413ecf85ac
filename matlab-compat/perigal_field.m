function [values, info] = perigal_field (r, name, component, steps)
% PERIGAL_FIELD  Read one field of a result, and nothing else.
%
%   V = PERIGAL_FIELD (R, NAME, COMPONENT, STEPS) returns points x components x steps; a field with one component
%   is points x steps.
%     R          what PERIGAL_OPEN or PERIGAL_RUN returned, or a result folder
%     NAME       a field: 'displacement', 'damage', 'stress', ... (R.fields), or one that does not change:
%                'place' (coordinates before deformation, m), 'point_volume' (m3)
%     COMPONENT  'x', 'xy', ..., or '' for all of them (the default)
%     STEPS      numbers of sets of fields (1 to numel (R.times)), 'last' (the default) or 'all'
%   [V, INFO] = ... also returns name, components, units, steps and times.
%
%   Errors: perigal:field (unknown field or component: the message lists what there is), perigal:step,
%   perigal:argument, perigal:file.
%
%   Example
%     r = perigal_open ('out/demo');
%     x = perigal_field (r, 'place');
%     s = perigal_field (r, 'stress', 'yy', 'last');
%     scatter (x(:, 1), x(:, 2), 9, s, 'filled'), axis equal, colorbar
%
%   See also PERIGAL_OPEN, PERIGAL_PLOT.

    if nargin < 2 || ~is_text (name)
        error ('perigal:argument', 'perigal_field: needs a result and the name of a field');
    end
    if ~isstruct (r)
        r = perigal_open (r);
    end
    if nargin < 3, component = ''; end
    if nargin < 4, steps = 'last'; end
    name = char (name);
    file = fullfile (folder_of (r, 'perigal_field'), 'result.e');
    need_netcdf ();
    constant = constant_field (r, name);
    if ~isempty (constant)
        k = chosen (constant, component);
        values = zeros (r.points, numel (k));
        for c = 1:numel (k)
            values(:, c) = ncread (file, constant.files{k(c)}, 1, r.points);
        end
        info = told (constant, k, [], []);
        return;
    end
    f = find (strcmp ({r.fields.name}, name));
    if isempty (f)
        error ('perigal:field', 'perigal_field: %s has no field %s; it has: %s', r.folder, name, ...
               strjoin ([{r.fields.name}, {'place', 'point_volume'}], ', '));
    end
    field = r.fields(f);
    k = chosen (field, component);
    steps = step_numbers (r, steps);
    values = zeros (r.points, numel (k), numel (steps));
    for c = 1:numel (k)
        variable = sprintf ('vals_nod_var%d', field.variables(k(c)));
        values(:, c, :) = read_steps (file, variable, r.points, steps);
    end
    if numel (k) == 1
        values = reshape (values, r.points, numel (steps));
    end
    info = told (field, k, steps, r.times(steps));
end

function field = constant_field (r, name)
% Fields that have no time.
    field = [];
    axes_of = {'x', 'y', 'z'};
    switch name
        case 'place'
            names = axes_of(1:r.dimension);
            field = struct ('name', name, 'components', {names}, 'units', 'm', 'files', {strcat('coord', names)});
        case 'point_volume'
            field = struct ('name', name, 'components', {{''}}, 'units', 'm3', 'files', {{'point_volume'}});
    end
end

function k = chosen (field, component)
    if isempty (component)
        k = 1:numel (field.components);
        return;
    end
    if ~is_text (component)
        error ('perigal:argument', 'perigal_field: the component must be text, such as ''x'' or ''xy''');
    end
    k = find (strcmp (field.components, char (component)));
    if isempty (k)
        error ('perigal:field', 'perigal_field: %s has no component %s; it has: %s', field.name, char (component), ...
               strjoin (strcat ('''', field.components, ''''), ', '));
    end
end

function steps = step_numbers (r, steps)
    n = numel (r.times);
    if is_text (steps)
        switch char (steps)
            case 'last', steps = n(n > 0);
            case 'all',  steps = 1:n;
            otherwise
                error ('perigal:step', 'perigal_field: steps must be numbers, ''last'' or ''all'', not ''%s''', char (steps));
        end
    end
    if ~isnumeric (steps) || any (steps(:) ~= fix (steps(:))) || any (steps(:) < 1) || any (steps(:) > n)
        error ('perigal:step', 'perigal_field: %s has fields at %d times; steps are whole numbers from 1 to %d', r.folder, n, n);
    end
    steps = steps(:)';
end

function values = read_steps (file, variable, points, steps)
% Steps at equal distances are read at once, others one by one.
    d = diff (steps);
    if numel (steps) > 1 && all (d == d(1)) && d(1) > 0
        values = ncread (file, variable, [1 steps(1)], [points numel(steps)], [1 d(1)]);
        return;
    end
    values = zeros (points, numel (steps));
    for s = 1:numel (steps)
        values(:, s) = ncread (file, variable, [1 steps(s)], [points 1]);
    end
end

function info = told (field, k, steps, times)
    info = struct ('name', field.name, 'components', {field.components(k)}, 'units', field.units, ...
                   'steps', steps, 'times', times);
end

% SPDX-License-Identifier: GPL-3.0-or-later
