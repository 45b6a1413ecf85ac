// Ball of radius 1 around (3, 0, 0): tetrahedra.
SetFactory("OpenCASCADE");
Sphere(1) = {3, 0, 0, 1};
Physical Volume("body", 1) = {1};
Physical Surface("skin", 2) = {1};
