function program = perigal_setup (program)
% PERIGAL_SETUP  Find the program perigal; every other function calls it by itself.
%
%   PERIGAL_SETUP () looks, in this order, at the environment variable PERIGAL, at the source tree that this
%   folder is part of (../perigal), and along PATH, and adds this folder to the search path.
%   PERIGAL_SETUP (PROGRAM) takes the program at the path PROGRAM from now on.
%   P = PERIGAL_SETUP (...) returns the path that is used.
%
%   Error perigal:setup: there is no such program, or it does not run.
%
%   Example
%     addpath ('/opt/perigal/matlab-compat');
%     perigal_setup ('/opt/perigal/perigal');
%
%   See also PERIGAL_RUN, PERIGAL_OPEN.

    persistent found
    here = fileparts (mfilename ('fullpath'));
    if nargin > 0
        if ~is_text (program)
            error ('perigal:setup', 'perigal_setup: PROGRAM must be the path of the program perigal');
        end
        found = verified (program);
    elseif isempty (found)
        found = first_that_runs (here);
    end
    if isempty (strfind ([pathsep path pathsep], [pathsep here pathsep]))
        addpath (here);
    end
    program = found;
end

function program = first_that_runs (here)
% The first place where there is a program that runs.
    places = { getenv('PERIGAL'), fullfile(here, '..', 'perigal'), fullfile(here, '..', '..', '..', 'bin', 'perigal'), 'perigal' };
    if ~isempty (places{1})
        program = verified (places{1});
        return;
    end
    for k = 2:numel (places)
        if runs (places{k})
            program = places{k};
            return;
        end
    end
    error ('perigal:setup', ['perigal_setup: there is no program perigal, neither in the source tree (make) nor ' ...
           'along PATH; name it by perigal_setup (''/path/of/perigal'') or by the environment variable PERIGAL']);
end

function program = verified (program)
    if ~runs (program)
        error ('perigal:setup', 'perigal_setup: %s is not the program perigal, or it does not run', program);
    end
end

function yes = runs (program)
    [status, text] = system ([command_line(program, {'help'}) ' 2>&1']);
    yes = status == 0 && ~isempty (strfind (text, 'keys of the scene file'));
end

% SPDX-License-Identifier: GPL-3.0-or-later
