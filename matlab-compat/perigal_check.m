function plan = perigal_check (scene, varargin)
% PERIGAL_CHECK  Check a scene, and say what a run would do, without running it.
%
%   P = PERIGAL_CHECK (SCENE, OPTION, VALUE, ...) returns a structure with points, bonds, unknowns (dofs), memory,
%   constants of the materials, warnings and more: what `perigal check --json` prints. SCENE is the path of a scene
%   file or a structure of PERIGAL_SCENE. Options:
%     'set'     values that replace those of the scene, as in PERIGAL_RUN
%     'solve'   true: solve once at load factor 1: at which load the first bond breaks; stable time step
%     'matrix'  a folder that gets the linear system at load factor 1 as Matrix Market files (`perigal help check`)
%     'memory'  limit, such as '8GB'
%
%   Errors: perigal:scene (all faults, each with file, line, key, value and what is allowed), perigal:failed,
%   perigal:usage, perigal:argument.
%
%   Example
%     p = perigal_check ('data/disk_crack/scene.yaml', 'set', {'spacing', '2 mm'});
%     p.points
%
%   See also PERIGAL_RUN, PERIGAL_SCENE.

    if nargin < 1
        error ('perigal:argument', 'perigal_check: needs a scene');
    end
    o = options_of ('perigal_check', {'set', 'solve', 'matrix', 'memory'}, varargin);
    [file, clean] = scene_file (scene); %#ok<ASGLU>
    words = [{'check', file, '--json', '--quiet'}, overrides('perigal_check', o)];
    if isfield (o, 'solve') && o.solve
        words{end + 1} = '--solve';
    end
    if isfield (o, 'matrix')
        words = [words, {'--matrix', char(o.matrix)}];
    end
    if isfield (o, 'memory')
        words = [words, {'--memory', char(o.memory)}];
    end
    plan = decode_json (call_perigal (words, false));
end

% SPDX-License-Identifier: GPL-3.0-or-later
