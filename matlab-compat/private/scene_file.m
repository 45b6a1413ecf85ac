function [file, clean] = scene_file (scene)
% The scene as a file: the path itself, or a structure written to a folder of its own, which goes with `clean`.
    clean = [];
    if is_text (scene)
        file = char (scene);
        return;
    end
    if ~(isstruct (scene) && isscalar (scene)) && ~isa (scene, 'containers.Map')
        error ('perigal:argument', 'a scene is the path of a file, or a structure such as perigal_scene returns');
    end
    folder = tempname ();
    mkdir (folder);
    file = fullfile (folder, 'scene.yaml');
    perigal_write (file, scene);
    clean = onCleanup (@() remove (folder, file));
end

function remove (folder, file)
    delete (file);
    rmdir (folder);
end

% SPDX-License-Identifier: GPL-3.0-or-later
