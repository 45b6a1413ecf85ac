function perigal_restore (h, state)
% PERIGAL_RESTORE  Bring a session to a state that PERIGAL_SAVE returned.
%
%   PERIGAL_RESTORE (H, STATE). The session must be of the same scene, with the same values set, and of this version of
%   the program. If it fails the session stays as it is.
%
%   Errors: perigal:argument (of another scene, no state), perigal:failed (damaged).
%
%   Example
%     h = perigal_session ('data/disk_crack/scene.yaml', 'set', {'spacing', '4 mm'});
%     state = perigal_save (h);
%     perigal_step (h, 'end');
%     perigal_restore (h, state)                              % back at the start
%     perigal_close (h)
%
%   See also PERIGAL_SAVE.

    if nargin < 2
        error ('perigal:argument', 'perigal_restore: needs a session and a state');
    end
    call_mex ('restore', h, state);
end

% SPDX-License-Identifier: GPL-3.0-or-later
