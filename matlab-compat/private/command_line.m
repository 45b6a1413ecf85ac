function line = command_line (program, words)
% The command for a shell: program and words, each in quotes, so that blanks, umlauts and quotes pass.
% MATLAB puts its own libraries before those of the system, which other programs must not see.
    line = quoted (program);
    for k = 1:numel (words)
        line = [line ' ' quoted(words{k})]; %#ok<AGROW>
    end
    if ~is_octave ()
        line = ['LD_LIBRARY_PATH= ' line];
    end
end

function text = quoted (text)
    text = ['''' strrep(char (text), '''', '''\''''') ''''];
end

% SPDX-License-Identifier: GPL-3.0-or-later
