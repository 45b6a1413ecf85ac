function perigal_bond_mask (h, alive)
% PERIGAL_BOND_MASK  Which bonds of a handle live.
%
%   PERIGAL_BOND_MASK (H, ALIVE): ALIVE is logical, an entry for each bond and direction of PERIGAL_BOND_LIST; a bond with
%   a dead direction is dead. Of PERIGAL_FCBM it may also have the size of the mask: all bonds of points that are false
%   are dead then (points that have failed), all others live. Bonds may also come to life again.
%
%   Errors: perigal:argument.
%
%   Example
%     op = perigal_fcbm (true (20, 30), 1e-3, '3 spacing', 5e20);
%     b = perigal_bond_list (op);
%     side = b.site > 300;                                    % a cut between columns 15 and 16
%     perigal_bond_mask (op, side(b.i) == side(b.j))
%     perigal_close (op)
%
%   See also PERIGAL_BOND_LIST, PERIGAL_BOND_FORCE.

    if nargin < 2
        error ('perigal:argument', 'perigal_bond_mask: needs a handle and a mask');
    end
    if isstruct (h) && isequal (size (alive), h.size) && ~isvector (alive)
        if ~islogical (alive)
            error ('perigal:argument', 'perigal_bond_mask: a mask of points must be logical');
        end
        b = call_mex ('bonds_list', h.handle);
        lives = alive(h.site);
        alive = lives(b.i) & lives(b.j);
    end
    call_mex ('bonds_mask', bond_handle (h), alive);
end

% SPDX-License-Identifier: GPL-3.0-or-later
