function r = perigal_run (scene, varargin)
% PERIGAL_RUN  Run a scene and open its result.
%
%   R = PERIGAL_RUN (SCENE, OPTION, VALUE, ...) runs SCENE, the path of a scene file or a structure of
%   PERIGAL_SCENE, and returns what PERIGAL_OPEN returns. Warnings of the run become warnings here. Options:
%     'out'       result folder; default: out/NAME, NAME being that of the scene's folder or file
%     'set'       values that replace those of the scene: {'spacing', '2 mm'; 'failure.fracture_energy', 20} or
%                 {'spacing=2 mm', ...}; numbers without unit are in the unit that the scene expects (SI)
%     'resume'    true: continue an interrupted run
%     'force'     true: start anew in the folder of an interrupted run, whose checkpoint and rows are lost
%     'threads'   number of threads; 0 (the default): one per processor
%     'memory'    limit, such as '8GB'
%     'plain'     true: without shortcuts
%     'progress'  false: nothing is printed while it runs; default: true
%
%   Errors, with the message of the program (file, line, key, allowed range): perigal:scene (the scene is wrong),
%   perigal:failed (numerics, memory, files), perigal:interrupted (R can be had by 'resume'), perigal:usage,
%   perigal:argument (wrong options here).
%
%   Example
%     r = perigal_run ('data/disk_crack/scene.yaml', 'out', 'out/coarse', 'set', {'spacing', '2 mm'});
%     perigal_plot (r, 'damage')
%
%   See also PERIGAL_CHECK, PERIGAL_SCENE, PERIGAL_OPEN, PERIGAL_SETUP.

    if nargin < 1
        error ('perigal:argument', 'perigal_run: needs a scene');
    end
    known = {'out', 'set', 'resume', 'force', 'threads', 'memory', 'plain', 'progress'};
    o = options_of ('perigal_run', known, varargin);
    [file, clean] = scene_file (scene); %#ok<ASGLU>
    out = default_folder (scene, o);
    words = [{'run', file, '-o', out}, overrides('perigal_run', o), switches(o)];
    shown = ~isfield (o, 'progress') || o.progress;
    if ~shown
        words{end + 1} = '--quiet';
    end
    call_perigal (words, shown);
    r = perigal_open (out);
    report = perigal_report (r);
    for k = 1:numel (report.warnings)
        warning ('perigal:warning', '%s', report.warnings{k});
    end
end

function out = default_folder (scene, o)
% out/NAME, as the program itself names it.
    if isfield (o, 'out')
        out = char (o.out);
    elseif isstruct (scene)
        out = fullfile ('out', 'scene');
    else
        [folder, name] = fileparts (char (scene));
        if strcmp (name, 'scene') && ~isempty (folder)
            [~, name] = fileparts (folder);
        end
        out = fullfile ('out', name);
    end
end

function words = switches (o)
    words = {};
    names = {'resume', 'force', 'plain'};
    for k = 1:numel (names)
        if isfield (o, names{k}) && o.(names{k})
            words{end + 1} = ['--' names{k}]; %#ok<AGROW>
        end
    end
    if isfield (o, 'threads')
        words = [words, {'--threads', sprintf('%d', o.threads)}];
    end
    if isfield (o, 'memory')
        words = [words, {'--memory', char(o.memory)}];
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
