function h = perigal_curve (r, x, y, varargin)
% PERIGAL_CURVE  Draw one column of history.csv over another.
%
%   PERIGAL_CURVE (R, X, Y, ...) draws column Y over column X of one result or of several (a cell of results) in the
%   current axes; what stands behind Y goes to PLOT ('r--', 'LineWidth', 2, ...). Without X and Y: force over
%   displacement of the load that report.json has chosen (`curve`).
%   H = ... returns the handles of the lines.
%
%   Errors: as PERIGAL_HISTORY.
%
%   Example
%     perigal_curve ({'out/coarse', 'out/fine'}, 'top.displacement_y', 'top.force_y')
%     legend ('coarse', 'fine')
%
%   See also PERIGAL_HISTORY, PERIGAL_PLOT.

    if nargin < 1
        error ('perigal:argument', 'perigal_curve: needs a result');
    end
    if ~iscell (r)
        r = {r};
    end
    if nargin < 3
        if nargin == 2
            error ('perigal:argument', 'perigal_curve: needs the columns of both axes, or none');
        end
        [x, y] = chosen_curve (r{1});
    end
    p = [];
    for k = 1:numel (r)
        [v, units] = perigal_history (r{k}, x, y);
        p = [p; plot(v(:, 1), v(:, 2), varargin{:})]; %#ok<AGROW>
        hold on
    end
    hold off
    xlabel (sprintf ('%s [%s]', x, units{1}), 'interpreter', 'none');
    ylabel (sprintf ('%s [%s]', y, units{2}), 'interpreter', 'none');
    grid on
    if nargout > 0, h = p; end
end

function [x, y] = chosen_curve (r)
    report = perigal_report (r);
    if ~isfield (report, 'curve') || ~isstruct (report.curve)
        error ('perigal:column', 'perigal_curve: the report has no curve of a load: name two columns of history.csv');
    end
    x = [report.curve.load '.displacement_' report.curve.component];
    y = [report.curve.load '.force_' report.curve.component];
end

% SPDX-License-Identifier: GPL-3.0-or-later
