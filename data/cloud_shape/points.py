# Points of a hooked plate, as a scan or a particle method leaves them: about a millimetre apart, in no order.
# Writes points.csv. The plate: 60 x 40 mm with round corners, a hole of radius 7 mm at (22, 20) mm, a bay of
# radius 9 mm in its right side.
import math, random

random.seed (4)
points = []
def inside (x, y):
    r = 6
    dx, dy = max (r - x, x - 60 + r, 0), max (r - y, y - 40 + r, 0)
    return (0 <= x <= 60 and 0 <= y <= 40 and math.hypot (dx, dy) <= r
            and math.hypot (x - 22, y - 20) >= 7 and math.hypot (x - 60, y - 27) >= 9)
for i in range (66):
    for j in range (48):
        x, y = 0.5 + i * 0.95 + 0.475 * (j % 2), 0.4 + j * 0.85
        x, y = x + random.uniform (-.2, .2), y + random.uniform (-.2, .2)
        if inside (x, y): points.append ((x, y))
random.shuffle (points)
with open ('points.csv', 'w') as f:
    f.write ('x [mm],y [mm]\n')
    for x, y in points: f.write ('%.3f,%.3f\n' % (x, y))
print (len (points))
