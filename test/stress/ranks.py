"""Two and three processes that share a run (perigal-mpi) give what one gives. Without MPI there are no such cells, and the run says so."""
from cells import Cell, Run, same
from contact import FRICTION, block
from elastic import base, label, plain
from growth import is_load, plate_of_space, strip
from motion import breaking_scene
from scenes import merged

SAME, SAME_BROKEN = 1e-7, 1e-6          # what is left of a solved system on several ranks; of events that follow each other


def pair(condition, value, method, scene, ranks, limit, seconds=60):
    return Cell(condition, f'{value}, {ranks} ranks', method.name, [Run(scene), Run(scene, ranks=ranks)], 'change of the answer', same(only=is_load), limit,
                seconds=seconds)


def cells(method):
    plane = 'stress'
    if 'static' in method.kinds and 'gauss, ' not in method.name and 'bond, ' not in method.name:
        for dimension, ranks in ((2, 2), (2, 3), (3, 3)):
            scene = plain(base(method, dimension, plane if dimension == 2 else ''))
            yield pair('ranks', label(dimension, plane), method, scene, ranks, SAME)
            if dimension == 2 and ranks == 2:
                yield pair('ranks', 'each holds a part of the body', method, merged(scene, {'solver': {'division': 'subdomains'}}), ranks, SAME)
    if 'break' in method.kinds:
        for ranks in (2, 3):
            yield pair('ranks, cracks', 'facets', method, strip(method, events=2), ranks, SAME_BROKEN)
        slides = block(method, 2, crack=(0.35, 0.67), contact={'kind': 'friction', 'coefficient': FRICTION})
        yield pair('ranks, cracks', 'closed faces', method, plain(slides), 3, SAME_BROKEN)
        if method.force == 'galerkin':
            yield pair('ranks, cracks', 'front', method, plate_of_space(method, events=1), 3, SAME_BROKEN)
    if 'motion' in method.kinds:
        scene = merged(breaking_scene(method), {'spacing': 0.2, 'solver': {'end': 1e-4}})
        if 'newmark' in method.name:
            scene['solver']['dt'] = 1e-5
        for ranks in (2, 3):
            # many messages a step: too long for the samples of the tests where ranks are more than cores
            yield pair('ranks, in motion', 'bonds that break', method, scene, ranks, SAME_BROKEN, seconds=120)
