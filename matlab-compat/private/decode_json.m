function value = decode_json (text, way)
% JSON to structures. By jsondecode where there is one (MATLAB, Octave from 7 on), else by the reader below, which
% gives the same shapes: lists of numbers are columns, lists of structures of the same fields structure arrays,
% other lists cells; null is NaN among numbers and [] elsewhere.
%
% way 'own': always by the reader below. 'exact': by it, for what is to be written again as it was: lists are cells
% in one row, but for two or more numbers, which are a row; maps whose names are no names of variables are
% containers.Map.
    own = nargin > 1;
    exact = own && strcmp (way, 'exact');
    if ~own && exist ('jsondecode') %#ok<EXIST>
        value = jsondecode (text);
        return;
    end
    [value, at] = any_value (text, blanks (text, 1), exact);
    if blanks (text, at) <= numel (text)
        fail (at);
    end
end

function [value, at] = any_value (text, at, exact)
    switch text(at)
        case '{', [value, at] = map (text, at, exact);
        case '[', [value, at] = list (text, at, exact);
        case '"', [value, at] = word (text, at);
        case 't', value = true;  at = at + 4;
        case 'f', value = false; at = at + 5;
        case 'n', value = [];    at = at + 4;
        otherwise
            n = regexp (text(at:min (end, at + 40)), '^-?[0-9.eE+-]+', 'match', 'once');
            if isempty (n)
                fail (at);
            end
            value = str2double (n);
            at = at + numel (n);
    end
end

function [value, at] = map (text, at, exact)
    names = {};
    values = {};
    at = blanks (text, at + 1);
    while text(at) ~= '}'
        [names{end + 1}, at] = word (text, at); %#ok<AGROW>
        at = blanks (text, at);                 % :
        [values{end + 1}, at] = any_value (text, blanks (text, at + 1), exact); %#ok<AGROW>
        at = blanks (text, at);
        if text(at) == ','
            at = blanks (text, at + 1);
        end
    end
    at = at + 1;
    if exact && ~all (cellfun (@isvarname, names))
        value = containers.Map ('KeyType', 'char', 'ValueType', 'any');
        for k = 1:numel (names)
            value(names{k}) = values{k};
        end
        return;
    end
    value = struct ();
    for k = 1:numel (names)
        value.(matlab.lang.makeValidName (names{k})) = values{k};
    end
end

function [value, at] = list (text, at, exact)
    value = {};
    at = blanks (text, at + 1);
    while text(at) ~= ']'
        [value{end + 1}, at] = any_value (text, at, exact); %#ok<AGROW>
        at = blanks (text, at);
        if text(at) == ','
            at = blanks (text, at + 1);
        end
    end
    at = at + 1;
    value = shaped (value, exact);
end

function value = shaped (value, exact)
% A list of cells in the shape that decode_json promises.
    number = cellfun (@(v) isnumeric (v) && isscalar (v), value);
    if exact
        if numel (value) > 1 && all (number)
            value = cell2mat (value);
        end
        return;
    end
    none = cellfun (@(v) isnumeric (v) && isempty (v), value);
    if isempty (value)
        value = [];
    elseif any (number) && all (number | none)
        value(none) = {NaN};
        value = cell2mat (value');
    elseif all (cellfun (@islogical, value))
        value = cell2mat (value');
    elseif all (cellfun (@isstruct, value)) && same_fields (value)
        value = reshape ([value{:}], [], 1);
    else
        value = value';
    end
end

function yes = same_fields (value)
    yes = true;
    for k = 2:numel (value)
        yes = yes && isequal (fieldnames (value{1}), fieldnames (value{k}));
    end
end

function [value, at] = word (text, at)
% From one quote to the next that is not escaped.
    from = at + 1;
    at = from;
    while text(at) ~= '"'
        at = at + 1 + (text(at) == '\');
    end
    value = text(from:at - 1);
    at = at + 1;
    if any (value == '\')
        value = unescaped (value);
    end
end

function value = unescaped (text)
    value = '';
    k = 1;
    while k <= numel (text)
        if text(k) ~= '\'
            value(end + 1) = text(k); %#ok<AGROW>
            k = k + 1;
            continue;
        end
        switch text(k + 1)
            case 'n', c = char (10);
            case 't', c = char (9);
            case 'r', c = char (13);
            case 'b', c = char (8);
            case 'f', c = char (12);
            case 'u'
                c = of_code (hex2dec (text(k + 2:k + 5)));
                k = k + 4;
            otherwise, c = text(k + 1);
        end
        value = [value c]; %#ok<AGROW>
        k = k + 2;
    end
end

function c = of_code (code)
% Octave's characters are the bytes of UTF-8, MATLAB's are UTF-16.
    if is_octave () && code > 2047
        c = char ([224 + floor(code / 4096), 128 + mod(floor (code / 64), 64), 128 + mod(code, 64)]);
    elseif is_octave () && code > 127
        c = char ([192 + floor(code / 64), 128 + mod(code, 64)]);
    else
        c = char (code);
    end
end

function at = blanks (text, at)
    while at <= numel (text) && any (text(at) == sprintf (' \t\r\n'))
        at = at + 1;
    end
end

function fail (at)
    error ('perigal:failed', 'JSON that cannot be read, at character %d', at);
end

% SPDX-License-Identifier: GPL-3.0-or-later
