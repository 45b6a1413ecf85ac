function table = perigal_table (f, times, varargin)
% PERIGAL_TABLE  Sample a function into a load table of a scene.
%
%   T = PERIGAL_TABLE (F, TIMES) returns the pairs [t, F(t)] (numel (TIMES) x 2) for `boundary[].table`: factor of
%   the load over time (s; load factor 0 to 1 in equilibria), linear between the pairs, constant beyond them.
%   T = PERIGAL_TABLE (F, [T0 T1], 'tolerance', E) chooses the times itself: halves intervals until the straight
%   line between the pairs differs from F by at most E times the largest value of F, in the middle and at the
%   quarters of each interval (default 1e-3); at most 10000 pairs.
%
%   Errors: perigal:argument (times not ascending, values not finite).
%
%   Example
%     s = perigal_scene ('data/zhou_2/scene.yaml');
%     s.boundary(1).table = perigal_table (@(t) sin (pi * t / 1e-5), [0 1e-5]);
%
%   See also PERIGAL_SCENE, PERIGAL_POINTS.

    o = options_of ('perigal_table', {'tolerance'}, varargin);
    if nargin < 2 || ~isa (f, 'function_handle') || ~isnumeric (times) || numel (times) < 2 || any (~(diff (times(:)) > 0))
        error ('perigal:argument', 'perigal_table: needs a function and two or more ascending times');
    end
    t = times(:)';
    if numel (t) == 2
        tolerance = 1e-3;
        if isfield (o, 'tolerance'), tolerance = o.tolerance; end
        t = refined (f, t, tolerance);
    end
    table = [t(:), values(f, t)'];
end

function t = refined (f, t, tolerance)
    t = linspace (t(1), t(2), 9);
    while numel (t) < 10000
        v = values (f, t);
        scale = max (abs (v));
        d = diff (t);
        off = zeros (1, numel (d));
        for share = [.25 .5 .75]
            between = values (f, t(1:end - 1) + share * d);
            off = max (off, abs (between - (v(1:end - 1) + share * diff (v))));
        end
        bad = find (off > tolerance * scale);
        if isempty (bad)
            return;
        end
        t = sort ([t, t(bad) + d(bad) / 2]);
    end
    warning ('perigal:warning', 'perigal_table: 10000 pairs were not enough for a tolerance of %g', tolerance);
end

function v = values (f, t)
    v = arrayfun (@(s) double (f (s)), t);
    if any (~isfinite (v))
        error ('perigal:argument', 'perigal_table: the function is not finite at t = %g', t(find (~isfinite (v), 1)));
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
