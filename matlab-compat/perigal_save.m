function state = perigal_save (h)
% PERIGAL_SAVE  Everything that later steps of a session depend on.
%
%   STATE = PERIGAL_SAVE (H) returns bytes (uint8) for PERIGAL_RESTORE, in this session or in another one of the same scene
%   and values; it may be kept in a .mat file. The steps that follow a restored state have the same bits.
%
%   Errors: perigal:argument, perigal:failed.
%
%   Example
%     h = perigal_session ('data/disk_crack/scene.yaml', 'set', {'spacing', '4 mm'});
%     perigal_step (h, 3);
%     state = perigal_save (h);
%     a = perigal_step (h);
%     perigal_restore (h, state)
%     b = perigal_step (h);
%     isequal (a.reaction, b.reaction)
%     perigal_close (h)
%
%   See also PERIGAL_RESTORE, PERIGAL_SESSION.

    if nargin < 1
        error ('perigal:argument', 'perigal_save: needs a session');
    end
    state = call_mex ('save', h);
end

% SPDX-License-Identifier: GPL-3.0-or-later
