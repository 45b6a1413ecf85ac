function e = perigal_events (r)
% PERIGAL_EVENTS  Read events.csv: one row per broken bond, in the order in which they broke.
%
%   E = PERIGAL_EVENTS (R) returns E.names (cell of column names), E.units (cell) and E.data (rows x columns):
%   step, load_factor, time (s), x, y, z (middle of the bond, m), utilisation, energy_of_step (J), bond_code
%   (0 node-node, 1 point-node, 2 facet-node), kind_code (0 tension, 1 shear, 2 bending, 3 energy, 4 facet); NaN
%   where a value was not measured.
%   R: what PERIGAL_OPEN or PERIGAL_RUN returned, or a result folder.
%
%   Errors: perigal:file, perigal:argument.
%
%   Example
%     e = perigal_events ('out/demo');
%     scatter (e.data(:, 4), e.data(:, 5), 4, e.data(:, 2)), axis equal
%
%   See also PERIGAL_HISTORY.

    e = read_csv (fullfile (folder_of (r, 'perigal_events'), 'events.csv'), 'perigal_events');
end

% SPDX-License-Identifier: GPL-3.0-or-later
