function s = perigal_step (h, steps)
% PERIGAL_STEP  Advance a session by one step, by several, or to its end.
%
%   S = PERIGAL_STEP (H) makes one step of the solver: a row of history.csv. S has number, time (s; static: load factor),
%   load_factor, reaction (loads x 3, N; rows as perigal_get (H).loads), broken (a row a broken bond: its number, place x y
%   z in m, utilisation), utilisation, dissipated, energy_strain, energy_kinetic, energy_external (J), done.
%   S = PERIGAL_STEP (H, N) makes N steps, or fewer to the end of the run; PERIGAL_STEP (H, 'end') all that are left. S is
%   then an array with an entry for each. Ctrl-C stops between two steps.
%
%   Errors: perigal:failed (the step was refused; the session is where it was before), perigal:argument (wrong handle; the
%   run has come to its end).
%
%   Example
%     h = perigal_session ('data/disk_crack/scene.yaml', 'set', {'spacing', '4 mm'});
%     s = perigal_step (h, 'end');
%     plot ([s.load_factor], arrayfun (@(k) k.reaction(1, 2), s))
%     perigal_close (h)
%
%   See also PERIGAL_SESSION, PERIGAL_GET.

    if nargin < 1
        error ('perigal:argument', 'perigal_step: needs a session');
    end
    if nargin < 2
        s = call_mex ('step', h);
        return;
    end
    if is_text (steps) && strcmp (char (steps), 'end')
        steps = Inf;
    elseif ~(isnumeric (steps) && isscalar (steps) && steps >= 1 && (steps == fix (steps) || isinf (steps)))
        error ('perigal:argument', 'perigal_step: steps must be a whole number from 1 on, or ''end''');
    end
    s = call_mex ('step', h);
    while numel (s) < steps && ~s(end).done
        s(end + 1) = call_mex ('step', h); %#ok<AGROW>
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
