// An L-bracket, 8 mm thick, arms 60 and 50 mm by 20 mm, fillet of 6 mm, bolt hole of 10 mm in the foot. Lengths in mm.
SetFactory("OpenCASCADE");
h = 5;
Point(1) = {0, 0, 0};   Point(2) = {60, 0, 0};  Point(3) = {60, 20, 0};  Point(4) = {26, 20, 0};
Point(5) = {20, 26, 0}; Point(6) = {20, 70, 0}; Point(7) = {0, 70, 0};   Point(8) = {26, 26, 0};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Circle(4) = {4, 8, 5}; Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 1};
Circle(8) = {10, 56, 0, 5};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7}; Curve Loop(2) = {8};
Plane Surface(1) = {1, 2};
out[] = Extrude {0, 0, 8} { Surface{1}; };
Physical Volume("steel") = {out[1]};
Physical Surface("tip") = {out[3]};
Physical Surface("bolt") = {out[9]};
Mesh.MeshSizeMax = h; Mesh.MeshSizeMin = 2; Mesh.MeshSizeFromCurvature = 10;
Mesh.ElementOrder = 2; Mesh.HighOrderOptimize = 2; Mesh.SecondOrderLinear = 0;
