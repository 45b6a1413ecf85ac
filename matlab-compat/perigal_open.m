function r = perigal_open (folder)
% PERIGAL_OPEN  What a result folder contains, without reading any field.
%
%   R = PERIGAL_OPEN (FOLDER) reads the headers of FOLDER/result.e.  R has
%     folder      the folder, which the other functions find by R
%     title       of the scene
%     dimension   1, 2 or 3
%     points      number of points
%     times       time of each set of fields: s; load factor; step number (see doc/output.md, time_whole)
%     fields      structure array: name, components (cell of names: 'x', 'xx', ... or ''), units
%     spacing     of the points, m
%     thickness   of a plane body, m
%
%   The folder of a run that is still going on, or was interrupted, can be opened as well.
%   Errors: perigal:file (no such folder or file), perigal:argument.
%
%   Example
%     r = perigal_open ('out/demo');
%     {r.fields.name}
%     damage = perigal_field (r, 'damage', '', 'last');
%
%   See also PERIGAL_FIELD, PERIGAL_HISTORY, PERIGAL_EVENTS, PERIGAL_REPORT.

    r.folder = folder_of (folder, 'perigal_open');
    file = fullfile (r.folder, 'result.e');
    if ~exist (file, 'file')
        error ('perigal:file', 'perigal_open: %s has no result.e: it is no result folder, or the run has written no fields yet', r.folder);
    end
    need_netcdf ();
    info = ncinfo (file);
    r.title = attribute (info.Attributes, 'title', '');
    r.dimension = size_of (info, 'num_dim');
    r.points = double (attribute (info.Attributes, 'points', size_of (info, 'num_nodes')));
    r.times = [];
    if size_of (info, 'time_step') > 0
        r.times = ncread (file, 'time_whole')';
    end
    r.fields = fields_of (file, info);
    r.spacing = attribute (info.Attributes, 'spacing', NaN);
    r.thickness = attribute (info.Attributes, 'thickness', NaN);
end

function fields = fields_of (file, info)
% Variables that share the attribute `field` are the components of one; variable k holds values of name k.
    fields = struct ('name', {}, 'components', {}, 'units', {}, 'variables', {});
    if ~any (strcmp ({info.Variables.Name}, 'name_nod_var'))
        return;
    end
    names = ncread (file, 'name_nod_var')';
    for k = 1:size (names, 1)
        name = names(k, :);
        name = deblank (name(name ~= 0));
        variable = sprintf ('vals_nod_var%d', k);
        at = info.Variables(strcmp ({info.Variables.Name}, variable)).Attributes;
        field = attribute (at, 'field', name);
        component = '';
        if numel (name) > numel (field)
            component = name(numel (field) + 2:end);
        end
        n = find (strcmp ({fields.name}, field));
        if isempty (n)
            n = numel (fields) + 1;
            fields(n) = struct ('name', field, 'components', {{}}, 'units', attribute (at, 'units', ''), 'variables', []);
        end
        fields(n).components{end + 1} = component;
        fields(n).variables(end + 1) = k;
    end
end

function value = attribute (list, name, default)
    value = default;
    if isempty (list)
        return;
    end
    k = find (strcmp ({list.Name}, name), 1);
    if ~isempty (k)
        value = list(k).Value;
    end
end

function n = size_of (info, name)
    n = 0;
    k = find (strcmp ({info.Dimensions.Name}, name), 1);
    if ~isempty (k)
        n = double (info.Dimensions(k).Length);
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
