function folder = folder_of (r, who)
% The result folder that r names: a structure of perigal_open or perigal_run, or a path.
    if isstruct (r) && isscalar (r) && isfield (r, 'folder')
        folder = r.folder;
    elseif is_text (r)
        folder = char (r);
    else
        error ('perigal:argument', '%s: the first argument must be a result folder or what perigal_open returned', who);
    end
    if ~exist (folder, 'dir')
        error ('perigal:file', '%s: there is no folder %s', who, folder);
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
