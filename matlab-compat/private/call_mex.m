function varargout = call_mex (varargin)
% Calls a command of the compiled gateway, which `make mex` builds.
    persistent there
    if isempty (there)
        there = exist ('perigal_mex', 'file') == 3;
        if ~there
            there = [];
            error ('perigal:setup', ['there is no compiled perigal_mex beside these functions: run `make mex` in the ' ...
                   'source tree (Octave: package octave-dev; MATLAB: make mex MEX=mex), or see README.md']);
        end
    end
    try
        [varargout{1:nargout}] = perigal_mex (varargin{:});
    catch fault
        message = fault.message;
        if strncmp (message, 'perigal_mex: ', 13)       % Octave puts the name of the gateway in front
            message = message(14:end);
        end
        error (fault.identifier, '%s', message);
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
