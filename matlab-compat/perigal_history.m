function [values, units] = perigal_history (r, varargin)
% PERIGAL_HISTORY  Read history.csv: one row per step of the run.
%
%   H = PERIGAL_HISTORY (R) returns all: H.names (cell of column names), H.units (cell), H.data (rows x columns;
%   NaN where a value was not measured).
%   [V, U] = PERIGAL_HISTORY (R, NAME, ...) returns the columns of these names side by side, and their units.
%   R: what PERIGAL_OPEN or PERIGAL_RUN returned, or a result folder.
%
%   Errors: perigal:column (the message lists the columns there are), perigal:file, perigal:argument.
%
%   Example
%     d = perigal_history ('out/demo', 'top.displacement_y', 'top.force_y');
%     plot (-1e6 * d(:, 1), -1e-3 * d(:, 2)), xlabel ('um'), ylabel ('kN')
%
%   See also PERIGAL_CURVE, PERIGAL_EVENTS, PERIGAL_REPORT.

    table = read_csv (fullfile (folder_of (r, 'perigal_history'), 'history.csv'), 'perigal_history');
    if nargin == 1
        values = table;
        units = table.units;
        return;
    end
    k = zeros (1, numel (varargin));
    for n = 1:numel (varargin)
        if ~is_text (varargin{n})
            error ('perigal:argument', 'perigal_history: names of columns must be text');
        end
        at = find (strcmp (table.names, char (varargin{n})), 1);
        if isempty (at)
            error ('perigal:column', 'perigal_history: there is no column %s; there are: %s', char (varargin{n}), ...
                   strjoin (table.names, ', '));
        end
        k(n) = at;
    end
    values = table.data(:, k);
    units = table.units(k);
end

% SPDX-License-Identifier: GPL-3.0-or-later
