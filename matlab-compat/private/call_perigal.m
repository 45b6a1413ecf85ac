function text = call_perigal (words, shown)
% Runs perigal with the words of its command line and returns all that it printed.
%
% shown: true: what it prints appears while it runs.
% Errors: perigal:usage (exit code 64), perigal:scene (65), perigal:interrupted (130), perigal:failed (others);
% the message is that of the program, which has file, line and key.
    line = command_line (perigal_setup (), words);
    if shown
        [status, text] = call_shown (line);
    else
        [status, text] = system ([line ' 2>&1']);
    end
    if status == 0
        return;
    end
    switch status
        case 64,          id = 'perigal:usage';
        case 65,          id = 'perigal:scene';
        case {2, 130},    id = 'perigal:interrupted';
        otherwise,        id = 'perigal:failed';
    end
    message = strtrim (text);
    if isempty (message)
        message = sprintf ('perigal ended with exit code %d and said nothing', status);
    end
    error (id, '%s', last_lines (message, 60));
end

function [status, text] = call_shown (line)
% Both streams appear as they come and are kept; the exit code takes its way by a file, since that of a pipe is
% the one of tee.
    folder = tempname ();
    mkdir (folder);
    log = fullfile (folder, 'log');
    code = fullfile (folder, 'code');
    system (['{ ' line ' 2>&1; echo $? > ' code '; } | tee ' log]);
    text = read_text (log);
    status = str2double (read_text (code));
    if isnan (status)
        status = 130;           % the shell itself was interrupted
    end
    delete (log);
    if exist (code, 'file')
        delete (code);
    end
    rmdir (folder);
end

function text = last_lines (text, n)
    lines = strsplit (text, sprintf ('\n'));
    if numel (lines) > n
        text = strjoin (lines(end - n + 1:end), sprintf ('\n'));
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
