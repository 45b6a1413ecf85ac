function [start, node] = perigal_family (x, horizon, varargin)
% PERIGAL_FAMILY  Which points each point, or each of other places, sees within a horizon.
%
%   [START, NODE] = PERIGAL_FAMILY (X, HORIZON, OPTION, VALUE, ...) returns compressed lists: place k sees the points
%   NODE(START(k):START(k+1)-1), ascending; a point at the place belongs to it.
%     X        points x coordinates (1, 2 or 3), m
%     HORIZON  a number in m, or text: '5 mm', '3 spacing'
%   Options:
%     'centres'  places x coordinates, m; default: the points themselves
%     'support'  'radial' (a ball, the default) or 'tensor' (a square or cube)
%     'closed'   true (the default): a distance of exactly the horizon counts
%     'spacing'  of the points, for a horizon in spacings; default: by 'volume', else the median distance of
%                nearest points
%     'volume'   of the points, m3 (one number, or one for each); 'thickness' in 2D, m (1 unless given)
%
%   Errors: perigal:argument, perigal:setup (no compiled perigal_mex: `make mex`).
%
%   Example
%     [a, b] = meshgrid (0:9, 0:9);
%     [start, node] = perigal_family ([a(:), b(:)], '3 spacing');
%     members = node(start(45):start(46) - 1)'
%
%   See also PERIGAL_BONDS, PERIGAL_SHAPE.

    who = 'perigal_family';
    if nargin < 2
        error ('perigal:argument', '%s: needs points and a horizon', who);
    end
    [p, o] = points_options (who, x, {'centres', 'support', 'closed'}, varargin);
    reach = length_of (who, 'the horizon', horizon, nominal_spacing (p));
    [start, node] = call_mex ('family', p.x, p.volume, p.spacing, p.thickness, option (o, 'centres', []), reach, ...
                              word_of (who, o, 'support'), one_number (who, o, 'closed', true));
end

% SPDX-License-Identifier: GPL-3.0-or-later
