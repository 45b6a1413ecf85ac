function [h, info] = perigal_session (scene, varargin)
% PERIGAL_SESSION  Open a scene in memory, to be advanced step by step.
%
%   [H, INFO] = PERIGAL_SESSION (SCENE, OPTION, VALUE, ...) reads and builds a scene as `perigal run` does and stops before
%   the first step; nothing is written. H is a handle (uint64) for PERIGAL_STEP, PERIGAL_GET, PERIGAL_SET, PERIGAL_CUT,
%   PERIGAL_SAVE, PERIGAL_RESTORE, PERIGAL_STIFFNESS; PERIGAL_CLOSE (H) gives its memory back, as does `clear
%   perigal_mex`. INFO is what PERIGAL_GET (H) returns. SCENE is the path of a file or a structure of PERIGAL_SCENE. Options:
%     'set'      values that replace those of the scene, as in PERIGAL_RUN
%     'threads'  number of threads; 0: one per processor (default: 1)
%
%   Steps have the same bits as those of `perigal run` with as many threads (where BLAS has one thread too: start with
%   OPENBLAS_NUM_THREADS=1). Warnings of the scene are warnings here (perigal:warning).
%
%   Errors: perigal:scene (with file, line, key), perigal:failed, perigal:argument, perigal:setup.
%
%   Example
%     h = perigal_session ('data/disk_crack/scene.yaml', 'set', {'spacing', '4 mm'});
%     while ~perigal_get (h, 'done')
%         s = perigal_step (h);
%         printf ('%d: %g N\n', s.number, s.reaction(1, 2));
%     end
%     d = perigal_get (h, 'damage');
%     perigal_close (h)
%
%   See also PERIGAL_STEP, PERIGAL_GET, PERIGAL_SET, PERIGAL_CUT, PERIGAL_SAVE, PERIGAL_STIFFNESS, PERIGAL_CLOSE.

    who = 'perigal_session';
    if nargin < 1
        error ('perigal:argument', '%s: needs a scene', who);
    end
    o = options_of (who, {'set', 'threads'}, varargin);
    [file, clean] = scene_file (scene); %#ok<ASGLU>
    words = overrides (who, o);
    h = call_mex ('open', file, words(2:2:end), one_number (who, o, 'threads', 1));
    info = call_mex ('about', h);
    for k = 1:numel (info.warnings)
        warning ('perigal:warning', '%s', info.warnings{k});
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
