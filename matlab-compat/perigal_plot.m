function h = perigal_plot (r, name, component, step, varargin)
% PERIGAL_PLOT  Draw a field on the points of a result, with its cracks.
%
%   PERIGAL_PLOT (R, NAME, COMPONENT, STEP) draws component COMPONENT ('' for a field that has one) of the field
%   NAME at STEP (number, or 'last', the default) as coloured points in the current axes. Options behind STEP:
%     'magnify'  the body is drawn displaced, this many times its displacement (default 0)
%     'size'     area of a marker in points^2 (default: fits the spacing in a figure of usual size)
%   H = ... returns the handle of the points.
%
%   Errors: as PERIGAL_FIELD.
%
%   Example
%     perigal_plot ('out/demo', 'stress', 'yy', 'last', 'magnify', 100)
%
%   See also PERIGAL_FIELD, PERIGAL_CURVE, PERIGAL_MOVIE.

    if nargin < 2
        error ('perigal:argument', 'perigal_plot: needs a result and the name of a field');
    end
    if ~isstruct (r), r = perigal_open (r); end
    if nargin < 3, component = ''; end
    if nargin < 4 || isempty (step), step = 'last'; end
    o = options_of ('perigal_plot', {'magnify', 'size'}, varargin);
    [v, info] = perigal_field (r, name, component, step);
    if size (v, 2) ~= 1
        error ('perigal:field', 'perigal_plot: choose one component of %s and one step', name);
    end
    x = perigal_field (r, 'place');
    magnify = 0;
    if isfield (o, 'magnify'), magnify = o.magnify; end
    if magnify ~= 0
        x = x + magnify * perigal_field (r, 'displacement', '', step);
    end
    area = marker_area (r, x);
    if isfield (o, 'size'), area = o.size; end
    if r.dimension == 3
        p = scatter3 (x(:, 1), x(:, 2), x(:, 3), area, v, 'filled');
    elseif r.dimension == 2
        p = scatter (x(:, 1), x(:, 2), area, v, 'filled');
    else
        p = plot (x, v, '.-');
    end
    if r.dimension > 1
        axis equal
        colorbar
    end
    title (headline (info), 'interpreter', 'none');
    xlabel ('x [m]');
    if r.dimension > 1, ylabel ('y [m]'); else, ylabel (info.units); end
    if nargout > 0, h = p; end
end

function text = headline (info)
    text = info.name;
    if ~isempty (info.components{1})
        text = [text '.' info.components{1}];
    end
    if ~isempty (info.units)
        text = [text ' [' info.units ']'];
    end
    if ~isempty (info.times)
        text = sprintf ('%s at %g', text, info.times);
    end
end

function area = marker_area (r, x)
% Markers that just touch where the body fills some 350 points of the paper.
    extent = max (max (x, [], 1) - min (x, [], 1));
    area = 9;
    if isfinite (r.spacing) && r.spacing > 0 && extent > 0
        area = max (1, (350 * r.spacing / extent) ^ 2);
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
