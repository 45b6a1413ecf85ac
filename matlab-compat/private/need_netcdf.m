function need_netcdf ()
% Octave reads netCDF by its package netcdf, MATLAB by itself.
    persistent ready
    if isempty (ready) && is_octave ()
        try
            pkg load netcdf
        catch
            error ('perigal:setup', 'Octave needs its package netcdf to read results: apt-get install octave-netcdf, or pkg install -forge netcdf');
        end
    end
    ready = true;
end

% SPDX-License-Identifier: GPL-3.0-or-later
