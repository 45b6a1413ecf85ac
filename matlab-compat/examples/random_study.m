% A parameter study with a histogram: how much does the load at which a plate with a notch breaks vary if the points are moved at random?
here = fileparts (mfilename ('fullpath'));
runs = 24;
t = perigal_sweep (fullfile (here, 'notch.yaml'), 'set', {'perturb.seed', 1:runs; 'perturb.amount', 0.2}, 'quantity', {'peak', 'broken'}, ...
                   'out', 'out/examples/random_study', 'resume', true, 'jobs', 2, 'progress', false);
peak = t.data(:, strcmp (t.names, 'peak')) / 1e3;       % kN
fprintf ('peak load of %d runs: mean %.3f kN, standard deviation %.1f %%\n', runs, mean (peak), 100 * std (peak) / mean (peak));
hist (peak, 8)                                          % MATLAB: histogram (peak, 8)
xlabel ('peak load [kN]'), ylabel ('number of runs'), title (sprintf ('points moved by 0.2 spacings: %d runs', runs))
% SPDX-License-Identifier: GPL-3.0-or-later
