% Convergence: the error of Kirsch's plate at falling spacings, and its order.
here = fileparts (mfilename ('fullpath'));
scene = fullfile (here, '..', '..', 'data', 'kirsch', 'scene.yaml');
if ~exist (scene, 'file')                               % installed: share/perigal/scenes
    scene = fullfile (here, '..', '..', 'scenes', 'kirsch', 'scene.yaml');
end
spacing = [0.5 0.25 0.125];                             % m
t = perigal_sweep (scene, 'set', {'spacing', spacing; 'output.pictures', {{}}}, 'out', 'out/examples/convergence', 'resume', true, ...
                   'progress', false);
relative = zeros (size (spacing));
for k = 1:numel (spacing)
    r = perigal_report (t.folder{k});
    relative(k) = r.error.displacement_l2.relative;
end
order = diff (log (relative)) ./ diff (log (spacing));
fprintf ('spacing %.3f m: error %.2e\n', [spacing; relative]);
fprintf ('order %.2f\n', order);
loglog (spacing, relative, 'o-'), grid on
xlabel ('spacing [m]'), ylabel ('error of the displacement'), title (sprintf ('order %.2f', order(end)))
% SPDX-License-Identifier: GPL-3.0-or-later
