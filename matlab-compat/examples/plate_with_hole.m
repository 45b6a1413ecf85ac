% A plate with a hole in tension, from nothing to a picture in 15 lines.
s = struct ('title', 'Plate with a hole', 'dimension', 2, 'plane', 'stress', 'thickness', '1 mm', 'spacing', '2.5 mm', 'lattice', 'cells');
s.body = { struct('add', struct ('box', struct ('low', {{'-50 mm', '-50 mm'}}, 'high', {{'50 mm', '50 mm'}}))), ...
           struct('subtract', struct ('disk', struct ('center', [0 0], 'radius', '10 mm'))) };
s.materials.steel = struct ('youngs_modulus', '210 GPa', 'poissons_ratio', 0.3);
s.method = struct ('approximation', 'rkpm', 'basis', 'quadratic', 'integration', 'gauss', 'horizon', '3.5 spacing');
s.boundary = { struct('name', 'left', 'set', 'left', 'displacement', struct ('x', 0)), ...
               struct('name', 'right', 'set', 'right', 'traction', struct ('x', '100 MPa')), ...
               struct('name', 'held', 'set', 'bottom', 'displacement', struct ('y', 0)) };
s.solver.kind = 'static';
s.output.pictures = {};
r = perigal_run (s, 'out', 'out/examples/plate_with_hole', 'progress', false);
largest = max (perigal_field (r, 'stress', 'xx')) / 100e6;
fprintf ('largest stress over that of the load: %.2f (an infinite plate: 3)\n', largest);
perigal_plot (r, 'stress', 'xx')
% SPDX-License-Identifier: GPL-3.0-or-later
