// Box 2 x 1 x 1 (x from 0), n layers of hexahedra across.
If (!Exists(n)) n = 2; EndIf
Point(1) = {0, 0, 0};  Point(2) = {2, 0, 0};  Point(3) = {2, 1, 0};  Point(4) = {0, 1, 0};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Curve{1, 3} = 2 * n + 1;  Transfinite Curve{2, 4} = n + 1;
Transfinite Surface{1};
Recombine Surface{1};
out() = Extrude {0, 0, 1} { Surface{1}; Layers{n}; Recombine; };
Physical Volume("body", 1) = {out(1)};
Physical Surface("bottom", 1) = {1};
Physical Surface("top", 2) = {out(0)};
Physical Surface("right", 3) = {out(3)};
Physical Surface("left", 4) = {out(5)};
Physical Curve("edge", 1) = {4};
