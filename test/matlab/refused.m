function refused (name, id, pattern, f)
% Checks that f () is an error with that identifier and with PATTERN in its message.
    good = false;
    try
        f ();
        got = 'no error';
    catch fault
        got = [fault.identifier ': ' fault.message];
        good = strcmp (fault.identifier, id) && ~isempty (strfind (fault.message, pattern));
    end
    verdict (name, good);
    if ~good
        printf ('# %s\n', strrep (got, sprintf ('\n'), sprintf ('\n# ')));
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
