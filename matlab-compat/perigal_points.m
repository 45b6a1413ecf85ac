function file = perigal_points (file, places, volumes, varargin)
% PERIGAL_POINTS  Write points as the CSV file that the key `points` of a scene reads.
%
%   F = PERIGAL_POINTS (FILE, X, V) writes places X (points x dimension, m) and volumes V (points, or one for all,
%   m3) and returns the absolute path of FILE.
%   ... (FILE, X, V, 'block', B) adds block numbers, for materials by block; 'spacing', H the distances to the
%   neighbours (m), for points of uneven density.
%
%   Errors: perigal:argument (shapes that do not fit, values that are not finite, volumes not above 0), perigal:file.
%
%   Example
%     [x, y] = meshgrid (0.5e-3:1e-3:19.5e-3);
%     perigal_points ('points.csv', [x(:), y(:)], 1e-9);
%
%   See also PERIGAL_SCENE.

    if nargin < 3 || ~is_text (file) || ~isnumeric (places) || ~isnumeric (volumes)
        error ('perigal:argument', 'perigal_points: needs a file, places and volumes');
    end
    o = options_of ('perigal_points', {'block', 'spacing'}, varargin);
    n = size (places, 1);
    if n == 0 || size (places, 2) > 3
        error ('perigal:argument', 'perigal_points: places are a matrix of points x 1, 2 or 3 coordinates');
    end
    axes_of = {'x [m]', 'y [m]', 'z [m]'};
    heads = [axes_of(1:size (places, 2)), {'volume [m3]'}];
    data = [places, column('volumes', volumes, n)];
    formats = repmat ({'%.17g'}, 1, size (data, 2));
    if isfield (o, 'block')
        heads{end + 1} = 'block';
        formats{end + 1} = '%d';
        data = [data, column('block', o.block, n)];
    end
    if isfield (o, 'spacing')
        heads{end + 1} = 'spacing [m]';
        formats{end + 1} = '%.17g';
        data = [data, column('spacing', o.spacing, n)];
    end
    if any (~isfinite (data(:))) || any (data(:, size (places, 2) + 1) <= 0)
        error ('perigal:argument', 'perigal_points: places must be finite and volumes above 0');
    end
    id = fopen (char (file), 'w');
    if id < 0
        error ('perigal:file', 'perigal_points: cannot write %s', char (file));
    end
    fprintf (id, '%s\n', strjoin (heads, ','));
    fprintf (id, [strjoin(formats, ',') '\n'], data');
    fclose (id);
    file = absolute (char (file));
end

function c = column (name, values, n)
    if isscalar (values)
        values = repmat (values, n, 1);
    end
    if numel (values) ~= n
        error ('perigal:argument', 'perigal_points: %s has %d values for %d points', name, numel (values), n);
    end
    c = double (values(:));
end

function file = absolute (file)
    if isempty (regexp (file, '^([/\\]|[A-Za-z]:)', 'once'))
        file = fullfile (pwd (), file);
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
