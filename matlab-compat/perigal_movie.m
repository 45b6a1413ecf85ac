function perigal_movie (file, r, name, component, varargin)
% PERIGAL_MOVIE  Write the steps of a field as an animated GIF.
%
%   PERIGAL_MOVIE (FILE, R, NAME, COMPONENT) draws every step of the field with one scale of colours, and writes
%   FILE. Options:
%     'steps'    numbers of the steps (default: all)
%     'magnify'  as in PERIGAL_PLOT
%     'seconds'  that each step is shown (default 0.2)
%     'size'     width and height in pixels (default [640 560])
%
%   Errors: as PERIGAL_FIELD; perigal:file.
%
%   Example
%     perigal_movie ('damage.gif', 'out/demo', 'damage', '')
%
%   See also PERIGAL_PLOT.

    if nargin < 3 || ~is_text (file)
        error ('perigal:argument', 'perigal_movie: needs a file, a result and the name of a field');
    end
    if nargin < 4, component = ''; end
    if ~isstruct (r), r = perigal_open (r); end
    o = options_of ('perigal_movie', {'steps', 'magnify', 'seconds', 'size'}, varargin);
    steps = 1:numel (r.times);
    if isfield (o, 'steps'), steps = o.steps; end
    magnify = 0;
    if isfield (o, 'magnify'), magnify = o.magnify; end
    seconds = 0.2;
    if isfield (o, 'seconds'), seconds = o.seconds; end
    pixels = [640 560];
    if isfield (o, 'size'), pixels = o.size; end
    all_values = perigal_field (r, name, component, steps);
    range = [min(all_values(:)), max(all_values(:))];
    if ~(range(2) > range(1)), range = range(1) + [-1 1] * max (abs (range(1)), 1) / 2; end
    window = figure ('visible', 'off', 'paperunits', 'points', 'paperposition', [0 0 pixels * 0.72]);
    close_it = onCleanup (@() close (window));
    picture = [tempname() '.png'];
    for k = 1:numel (steps)
        clf (window);
        axes ('parent', window);
        perigal_plot (r, name, component, steps(k), 'magnify', magnify);
        caxis (range);
        print (window, picture, '-dpng', '-r100');
        frame = imread (picture);
        [index, colours] = rgb2ind (frame(:, :, 1:3));
        if k == 1
            imwrite (index, colours, file, 'gif', 'LoopCount', Inf, 'DelayTime', seconds);
        else
            imwrite (index, colours, file, 'gif', 'WriteMode', 'append', 'DelayTime', seconds);
        end
    end
    delete (picture);
end

% SPDX-License-Identifier: GPL-3.0-or-later
