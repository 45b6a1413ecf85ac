function [p, o] = points_options (who, x, known, arguments)
% Options of functions on points: those of PERIGAL_FAMILY with the names in KNOWN. P: points, volumes, spacing (m; 0:
% by the volumes) and thickness, as the gateway takes them.
    o = options_of (who, [known, {'volume', 'spacing', 'thickness'}], arguments);
    p = struct ('x', full_double (who, 'points', x), 'volume', [], 'spacing', 0, 'thickness', 1);
    if isfield (o, 'volume')
        p.volume = full_double (who, 'volume', o.volume);
        if isscalar (p.volume)
            p.volume = repmat (p.volume, size (p.x, 1), 1);
        end
    end
    if isfield (o, 'thickness'), p.thickness = length_of (who, 'thickness', o.thickness, NaN); end
    if isfield (o, 'spacing'), p.spacing = length_of (who, 'spacing', o.spacing, NaN); end
    if p.spacing == 0 && isempty (p.volume)
        p.spacing = nearest (who, p.x);
    end
end

function h = nearest (who, x)
% The spacing of points that come without one and without volumes: the median distance to the nearest other point,
% looked at from at most 200 of them.
    n = size (x, 1);
    if n < 2
        error ('perigal:argument', '%s: one point has no spacing: give ''spacing''', who);
    end
    look = unique (round (linspace (1, n, min (n, 200))));
    d = zeros (1, numel (look));
    for k = 1:numel (look)
        r2 = sum ((x - repmat (x(look(k), :), n, 1)) .^ 2, 2);
        r2(look(k)) = Inf;
        d(k) = sqrt (min (r2));
    end
    h = median (d);
end

function v = full_double (who, what, v)
    if ~isnumeric (v) || ~isreal (v) || isempty (v)
        error ('perigal:argument', '%s: %s must be a real array of numbers', who, what);
    end
    v = double (full (v));
end

% SPDX-License-Identifier: GPL-3.0-or-later
