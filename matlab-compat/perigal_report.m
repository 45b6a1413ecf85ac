function report = perigal_report (r)
% PERIGAL_REPORT  Read report.json: what the run did, how long it took, and its warnings.
%
%   S = PERIGAL_REPORT (R) returns a structure with the entries of doc/output.md: S.outcome, S.warnings (cell),
%   S.energy.strain (J), S.curve.peak.force (N), S.seconds.total, ...
%   R: what PERIGAL_OPEN or PERIGAL_RUN returned, or a result folder.
%
%   Errors: perigal:file (also of a run that has not ended: it has no report yet), perigal:argument.
%
%   Example
%     s = perigal_report ('out/demo');
%     s.curve.peak
%
%   See also PERIGAL_HISTORY, PERIGAL_RUN.

    file = fullfile (folder_of (r, 'perigal_report'), 'report.json');
    if ~exist (file, 'file')
        error ('perigal:file', 'perigal_report: there is no %s: the run has not ended, or was interrupted', file);
    end
    report = decode_json (read_text (file));
    if isfield (report, 'warnings')
        report.warnings = as_cell (report.warnings);
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
