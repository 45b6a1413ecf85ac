function words = overrides (who, o)
% The option 'set' as words of the command line: --set KEY=VALUE ...
    words = {};
    if ~isfield (o, 'set') || isempty (o.set)
        return;
    end
    list = o.set;
    if is_text (list)
        list = {list};
    end
    if ~iscell (list)
        error ('perigal:argument', '%s: ''set'' takes {''key'', value; ...} or {''key=value'', ...}', who);
    end
    whole = cellfun (@(text) is_text (text) && any (char (text) == '='), list);
    if all (whole(:))
        pairs = list(:)';
    elseif size (list, 2) == 2
        pairs = cell (1, size (list, 1));
        for k = 1:size (list, 1)
            if ~is_text (list{k, 1})
                error ('perigal:argument', '%s: a key of ''set'' must be text', who);
            end
            pairs{k} = [char(list{k, 1}) '=' yaml_flow(list{k, 2})];
        end
    else
        error ('perigal:argument', '%s: ''set'' takes {''key'', value; ...} or {''key=value'', ...}', who);
    end
    for k = 1:numel (pairs)
        words = [words, {'--set', char(pairs{k})}]; %#ok<AGROW>
    end
end

% SPDX-License-Identifier: GPL-3.0-or-later
