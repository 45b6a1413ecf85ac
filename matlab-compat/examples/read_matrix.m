function A = read_matrix (file)
% READ_MATRIX  A matrix or vector of a Matrix Market file (real; general or symmetric).
    id = fopen (file, 'r');
    if id < 0
        error ('perigal:file', 'read_matrix: cannot read %s', file);
    end
    back = onCleanup (@() fclose (id));
    head = fgetl (id);
    line = fgetl (id);
    while line(1) == '%'
        line = fgetl (id);
    end
    n = sscanf (line, '%d')';
    values = fscanf (id, '%f');
    if ~isempty (strfind (head, 'array'))
        A = reshape (values, n);
        return;
    end
    values = reshape (values, 3, [])';
    A = sparse (values(:, 1), values(:, 2), values(:, 3), n(1), n(2));
    if ~isempty (strfind (head, 'symmetric'))
        A = A + A' - diag (diag (A));
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
