#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a 3D result by ParaView, named as `perigal plot` names its own: sections, the sides, iso and crack.

    pvbatch views.py DIR                              # damage and displacement: mid-section, front, back, iso; crack
    pvbatch views.py DIR --field stress_yy --view left,iso --section "x=0.005" --step all
    xvfb-run -a pvbatch views.py DIR                  # where there is no display
"""
import argparse
import os
import sys

# Direction from the body to the eye, and what is up; as in `perigal plot --view`.
SIDES = {
    'front': ((0, 0, 1), (0, 1, 0)), 'back': ((0, 0, -1), (0, 1, 0)), 'left': ((-1, 0, 0), (0, 1, 0)), 'right': ((1, 0, 0), (0, 1, 0)),
    'top': ((0, 1, 0), (0, 0, -1)), 'bottom': ((0, -1, 0), (0, 0, 1)), 'iso': ((0.62, 0.46, 0.80), (0, 1, 0)), 'crack': ((0.62, 0.46, 0.80), (0, 1, 0)),
}


def read_arguments(words):
    parser = argparse.ArgumentParser(prog='views.py', description='Pictures of DIR/result.e by ParaView; lengths in m.')
    parser.add_argument('directory', metavar='DIR')
    parser.add_argument('--field', default='damage,displacement', help='names or parts: damage, displacement, displacement_y, stress_xx; separated by commas')
    parser.add_argument('--view', default=None, help='of ' + ', '.join(SIDES) + '; separated by commas')
    parser.add_argument('--section', default=None, help='planes such as z=0.005, separated by commas')
    parser.add_argument('--step', default='-1', help='number of a step of result.e, or all (the last)')
    parser.add_argument('--above', type=float, default=0.35, help='damage of the points that view crack shows (0.35)')
    parser.add_argument('--magnify', type=float, default=0, help='the body is drawn deformed by this multiple of the displacement')
    parser.add_argument('--range', default=None, help='LOW,HIGH of the colour bar')
    parser.add_argument('--size', default='1200,1000', help='pixels')
    parser.add_argument('--out', default=None, help='folder of the pictures (DIR)')
    wishes = parser.parse_args(words)
    for name in (wishes.view or '').split(','):
        if name and name not in SIDES:
            parser.error('no view is called %s: one of %s' % (name, ', '.join(SIDES)))
    for text in (wishes.section or '').split(','):
        axis, sign, place = text.partition('=')
        try:
            float(place if text else 0)
        except ValueError:
            sign = ''
        if text and (axis.strip() not in ('x', 'y', 'z') or not sign):
            parser.error('section %s: expected AXIS=PLACE in m, such as z=0.005' % text)
    if not os.path.exists(os.path.join(wishes.directory, 'result.e')):
        parser.error('%s holds no result.e' % wishes.directory)
    return wishes


class Result:
    """result.e as cubes around its points, at one time."""

    def __init__(self, pv, wishes):
        self.pv, self.wishes = pv, wishes
        self.reader = pv.ExodusIIReader(FileName=[os.path.join(wishes.directory, 'result.e')])
        self.reader.PointVariables = self.reader.PointVariables.Available
        self.reader.ApplyDisplacements = 0
        self.reader.UpdatePipeline()
        self.times = list(self.reader.TimestepValues)
        self.bounds = self.reader.GetDataInformation().GetBounds()
        self.arrays = {}
        info = self.reader.GetPointDataInformation()
        for k in range(info.GetNumberOfArrays()):
            array = info.GetArray(k)
            self.arrays[array.GetName()] = array
        # lattice nodes on the surface hold less than a cell, so the largest volume is that of a whole one
        self.spacing = self.arrays['volume'].GetRange(0)[1] ** (1 / 3) if 'volume' in self.arrays else self.guess()
        self.flat = self.bounds[5] - self.bounds[4] < 1e-9 * (self.bounds[1] - self.bounds[0])

    def guess(self):
        lengths = [self.bounds[2 * k + 1] - self.bounds[2 * k] for k in range(3)]
        points = self.reader.GetDataInformation().GetNumberOfPoints()
        return (max(lengths[0] * lengths[1] * max(lengths[2], 1e-300), 1e-300) / max(points, 1)) ** (1 / 3)

    def steps(self):
        last = len(self.times) - 1
        if self.wishes.step == 'all':
            return list(range(last + 1))
        step = int(self.wishes.step)
        if not -1 <= step <= last:
            sys.exit('views.py: there is no step %d; steps are 0 to %d' % (step, last))
        return [last if step < 0 else step]

    def array(self, base):
        """ParaView groups displacement_x, _y, _z as "displacement_"; None when there is no such field."""
        return next((name for name in (base, base + '_') if name in self.arrays), None)

    def part(self, name):
        """Array and component of "stress_xx", "displacement_y", "displacement" (its size) or "damage"."""
        whole = self.array(name)
        if whole:
            return whole, 'Magnitude' if self.arrays[whole].GetNumberOfComponents() > 1 else ''
        single = self.array(name.replace('.', '_'))
        if single:
            return single, ''
        base, _, part = name.replace('.', '_').rpartition('_')
        whole = self.array(base)
        for k in range(self.arrays[whole].GetNumberOfComponents() if whole else 0):
            given = str(self.arrays[whole].GetComponentName(k))
            if given.lower() == part:
                return whole, given
        sys.exit('views.py: there is no field %s; there are %s' % (name, ', '.join(sorted(a.rstrip('_') for a in self.arrays))))

    def cubes(self, points):
        pv = self.pv
        if self.wishes.magnify and self.array('displacement'):
            points = pv.WarpByVector(Input=points, Vectors=['POINTS', self.array('displacement')], ScaleFactor=self.wishes.magnify)
        glyph = pv.Glyph(Input=points, GlyphType='Box', ScaleArray=['POINTS', 'No scale array'], OrientationArray=['POINTS', 'No orientation array'])
        glyph.ScaleFactor = self.spacing
        glyph.GlyphMode = 'All Points'
        return glyph


def colour(pv, display, view, field, part, wishes):
    pv.ColorBy(display, ('POINTS', field, part) if part else ('POINTS', field))
    table = pv.GetColorTransferFunction(field)
    table.ApplyPreset('Viridis (matplotlib)' if field == 'damage' or part == 'Magnitude' else 'Cool to Warm', True)
    if wishes.range:
        table.RescaleTransferFunction(*[float(v) for v in wishes.range.split(',')])
    elif field == 'damage':
        table.RescaleTransferFunction(0, 1)
    else:
        display.RescaleTransferFunctionToDataRange(False, True)
    bar = pv.GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = field.rstrip('_'), '' if part == 'Magnitude' else part
    bar.TitleColor = bar.LabelColor = [0, 0, 0]
    bar.TitleFontSize = bar.LabelFontSize = 20
    bar.WindowLocation, bar.Position, bar.ScalarBarLength = 'Any Location', [0.88, 0.15], 0.7
    bar.Visibility = 1
    return bar


def new_view(pv, wishes, eye, up, axes):
    view = pv.CreateView('RenderView')
    view.ViewSize = [int(v) for v in wishes.size.split(',')]
    for name, value in (('UseColorPaletteForBackground', 0), ('Background', [1, 1, 1]), ('OrientationAxesLabelColor', [0, 0, 0])):
        if hasattr(view, name):
            setattr(view, name, value)
    view.CameraParallelProjection = 1
    view.CameraFocalPoint = [0, 0, 0]
    view.CameraPosition = list(eye)
    view.CameraViewUp = list(up)
    view.OrientationAxesVisibility = 0 if axes else 1
    if axes:
        view.AxesGrid.Visibility = 1
        for letter in 'XYZ':
            for what in ('TitleColor', 'LabelColor'):
                setattr(view.AxesGrid, letter + what, [0, 0, 0])
            setattr(view.AxesGrid, letter + 'Title', letter.lower() + ' (m)')
        view.AxesGrid.GridColor = [0.6, 0.6, 0.6]
    return view


def picture(result, path, field, part, eye, up, source, axes, outline):
    pv, wishes = result.pv, result.wishes
    view = new_view(pv, wishes, eye, up, axes)
    display = pv.Show(source, view)
    display.Representation = 'Surface'
    display.Specular = 0
    if axes:                                           # colours as on the bar
        display.Ambient, display.Diffuse = 1, 0
    bar = colour(pv, display, view, field, part, wishes)
    if outline:
        frame = pv.Show(pv.Outline(Input=result.reader), view)
        frame.AmbientColor = frame.DiffuseColor = [0.4, 0.4, 0.4]
    view.ViewTime = result.time
    pv.ResetCamera(view)
    pv.Render(view)
    pv.SaveScreenshot(path, view, ImageResolution=view.ViewSize, TransparentBackground=0)
    bar.Visibility = 0
    pv.Delete(view)
    print(path)


def between(pv, source, array, low, high):
    points = pv.Threshold(Input=source, Scalars=['POINTS', array])
    if hasattr(points, 'LowerThreshold'):
        points.LowerThreshold, points.UpperThreshold, points.ThresholdMethod = low, high, 'Between'
    else:                                              # before ParaView 5.10
        points.ThresholdRange = [low, high]
    points.UpdatePipeline()
    return points


def section_of(result, text):
    """The layer of points within half a spacing of the plane, seen along its axis."""
    axis, _, place = text.partition('=')
    k, at, half = 'xyz'.index(axis.strip()), float(place), 0.5 * result.spacing
    places = result.pv.Calculator(Input=result.reader, ResultArrayName='place', Function='coords' + 'XYZ'[k])
    layer = between(result.pv, places, 'place', at - half * (1 - 1e-6), at + half * (1 + 1e-6))
    if layer.GetDataInformation().GetNumberOfPoints() == 0:
        sys.exit('views.py: the section %s meets no points: they lie between %g and %g m' % (text, result.bounds[2 * k], result.bounds[2 * k + 1]))
    eye = [(1, 0, 0), (0, -1, 0), (0, 0, 1)][k]
    return result.cubes(layer), eye, (0, 0, 1) if k < 2 else (0, 1, 0)


def damaged(result):
    return result.cubes(between(result.pv, result.reader, 'damage', result.wishes.above, 2))


def wanted(result, field):
    """(suffix of the name, kind, text) of each picture of a field."""
    wishes = result.wishes
    if result.flat:
        return [('', 'side', 'front')]
    if wishes.view or wishes.section:
        views = [v for v in (wishes.view or '').split(',') if v]
        cuts = [s for s in (wishes.section or '').split(',') if s]
    else:
        views = ['front', 'back', 'iso'] + (['crack'] if field == 'damage' else [])
        cuts = ['z=%.9g' % (0.5 * (result.bounds[4] + result.bounds[5]))]
    named = [('_' + '_'.join(s.replace('=', ' ').split()), 'section', s) for s in cuts]
    if not (wishes.view or wishes.section):
        named = [('', 'section', cuts[0])]
    return named + [('_' + v, 'crack' if v == 'crack' else 'side', v) for v in views]


def draw_all(pv, wishes):
    result = Result(pv, wishes)
    folder = wishes.out or wishes.directory
    os.makedirs(folder, exist_ok=True)
    for step in result.steps():
        result.time = result.times[step]
        result.reader.UpdatePipeline(result.time)
        number = '_%04d' % step if wishes.step == 'all' else ''
        for name in wishes.field.split(','):
            field, part = result.part(name)
            for suffix, kind, text in wanted(result, field):
                path = os.path.join(folder, name.replace('_', '.') + suffix + number + '.png')
                if kind == 'section':
                    source, eye, up = section_of(result, text)
                else:
                    source, (eye, up) = damaged(result) if kind == 'crack' else result.cubes(result.reader), SIDES[text]
                picture(result, path, field, part, eye, up, source, text not in ('iso', 'crack'), kind == 'crack')


def main(words):
    wishes = read_arguments(words)
    try:
        import paraview.simple as pv
    except ImportError:
        sys.exit('views.py: run this by ParaView: pvbatch views.py DIR')
    pv._DisableFirstRenderCameraReset()
    draw_all(pv, wishes)


if __name__ == '__main__':
    main(sys.argv[1:])
