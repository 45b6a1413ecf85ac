function perigal_close (h)
% PERIGAL_CLOSE  Close a handle of PERIGAL_SESSION, PERIGAL_BONDS or PERIGAL_FCBM and give its memory back.
%
%   PERIGAL_CLOSE (H). The handle is not valid any more. `clear perigal_mex` and the end of the program close all.
%
%   Errors: perigal:argument (no open handle).
%
%   Example
%     h = perigal_bonds (rand (50, 2), 0.3, 1);
%     perigal_close (h)
%
%   See also PERIGAL_SESSION, PERIGAL_BONDS, PERIGAL_FCBM.

    if nargin < 1
        error ('perigal:argument', 'perigal_close: needs a handle');
    end
    call_mex ('close', bond_handle (h));
end

% SPDX-License-Identifier: GPL-3.0-or-later
