function [K, f, info] = perigal_stiffness (h, t)
% PERIGAL_STIFFNESS  The linear system of a scene: K \ f gives the displacement of the free unknowns.
%
%   [K, F, INFO] = PERIGAL_STIFFNESS (H, T) with a session H of PERIGAL_SESSION, at load factor (or time) T, 1 unless given,
%   and with the bonds that live now. K (N/m, sparse, symmetric) and F (N) are of the unknowns that supports leave free:
%     q = K \ F;
%     u = info.displacement (q);                              % points x coordinates, m
%   It is the equilibrium that `perigal run` finds for kind: static, without inertia and contact. INFO has
%     K, f           of all unknowns, point by point: the matrix of the force itself, and the loads
%     T, g           d = T q + g: what supports make of free unknowns; here K is T' * info.K * T
%     free, held     numbers of the unknowns that are free, and of those held at g(held); [] where essential:
%                    transformation ties several together (selects is false then)
%     N              displacement = N d: the identity where unknowns are displacements
%     idle           how many unknowns are held at 0 because nothing resists them (points without bonds)
%   H may also be a scene: the path of a file or a structure, which is opened and closed.
%
%   Errors: perigal:argument (contact, forces that reach neighbours of neighbours, wrong handle), perigal:scene.
%
%   Example
%     h = perigal_session ('data/kirsch/scene.yaml', 'set', {'spacing', '4 mm'});
%     [K, f, info] = perigal_stiffness (h);
%     u = info.displacement (K \ f);
%     perigal_step (h, 'end');
%     max (max (abs (u - perigal_get (h, 'displacement'))))
%     perigal_close (h)
%
%   See also PERIGAL_SESSION, PERIGAL_GET.

    who = 'perigal_stiffness';
    if nargin < 1
        error ('perigal:argument', '%s: needs a session or a scene', who);
    end
    if nargin < 2, t = 1; end
    if is_text (h) || isstruct (h) || isa (h, 'containers.Map')
        h = perigal_session (h);
        back = onCleanup (@() perigal_close (h)); %#ok<NASGU>
    end
    info = call_mex ('equations', h, t);
    about = call_mex ('about', h);
    dim = about.dimension;
    K = info.T' * info.K * info.T;
    K = (K + K') / 2;
    f = info.T' * (info.f - info.K * info.g);
    info.held = [];
    if info.selects
        info.held = setdiff ((1:numel (info.g))', info.free);
    end
    T = info.T; g = info.g; N = info.N;
    info.displacement = @(q) reshape (full (N * (T * q + g)), dim, [])';
end

% SPDX-License-Identifier: GPL-3.0-or-later
