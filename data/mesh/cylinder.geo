// Cylinder of radius 1 and height 1.5 along z: wedges.
If (!Exists(h)) h = 0.8; EndIf
Point(1) = {0, 0, 0, h};
Point(10) = {1, 0, 0, h};  Point(11) = {0, 1, 0, h};  Point(12) = {-1, 0, 0, h};  Point(13) = {0, -1, 0, h};
Circle(10) = {10, 1, 11};  Circle(11) = {11, 1, 12};  Circle(12) = {12, 1, 13};  Circle(13) = {13, 1, 10};
Curve Loop(1) = {10, 11, 12, 13};
Plane Surface(1) = {1};
out() = Extrude {0, 0, 1.5} { Surface{1}; Layers{3}; Recombine; };
Physical Volume("body", 1) = {out(1)};
Physical Surface("bottom", 2) = {1};
Physical Surface("top", 3) = {out(0)};
Physical Surface("side", 4) = {out(2), out(3), out(4), out(5)};
