// Disk of radius 1 with a hole of radius 0.4; the material changes at radius 0.7.
If (!Exists(h)) h = 0.4; EndIf
Point(1) = {0, 0, 0, h};
radius() = {1, 0.7, 0.4};
For k In {0 : 2}
  r = radius(k); p = 10 * (k + 1);
  Point(p) = {r, 0, 0, h};  Point(p + 1) = {0, r, 0, h};  Point(p + 2) = {-r, 0, 0, h};  Point(p + 3) = {0, -r, 0, h};
  Circle(p) = {p, 1, p + 1};  Circle(p + 1) = {p + 1, 1, p + 2};  Circle(p + 2) = {p + 2, 1, p + 3};  Circle(p + 3) = {p + 3, 1, p};
  Curve Loop(k + 1) = {p, p + 1, p + 2, p + 3};
EndFor
Plane Surface(1) = {1, 2};
Plane Surface(2) = {2, 3};
If (Exists(quads)) Recombine Surface{1, 2}; EndIf
Physical Surface("outside", 1) = {1};
Physical Surface("inside", 2) = {2};
Physical Curve("rim", 3) = {10, 11, 12, 13};
Physical Curve("hole", 4) = {30, 31, 32, 33};
Physical Curve("interface", 5) = {20, 21, 22, 23};
Physical Point("corner", 6) = {10};
