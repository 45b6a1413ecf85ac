function scene = perigal_scene (file, varargin)
% PERIGAL_SCENE  Read a scene file into a structure, which can be changed, run and written.
%
%   S = PERIGAL_SCENE (FILE) checks the scene and returns it as it is written: maps are structures, lists are
%   cells, structure arrays or columns of numbers, values with units are texts ('2 mm'). A map with names that are
%   no names of variables is a containers.Map.
%   S = PERIGAL_SCENE (FILE, 'set', {...}) replaces values as PERIGAL_RUN does.
%   Names of files in a scene count from its folder: give them absolute paths before it is run as a structure.
%
%   Errors: perigal:scene, perigal:argument.
%
%   Example
%     s = perigal_scene ('data/disk_crack/scene.yaml');
%     s.spacing = '2 mm';
%     s.materials.rock.youngs_modulus = 12e9;
%     r = perigal_run (s, 'out', 'out/stiffer');
%
%   See also PERIGAL_WRITE, PERIGAL_RUN, PERIGAL_CHECK.

    if nargin < 1 || ~is_text (file)
        error ('perigal:argument', 'perigal_scene: needs the path of a scene file');
    end
    o = options_of ('perigal_scene', {'set'}, varargin);
    words = [{'check', char(file), '--echo'}, overrides('perigal_scene', o)];
    scene = decode_json (call_perigal (words, false), 'exact');
end

% SPDX-License-Identifier: GPL-3.0-or-later
