"""A smaller scene that still violates an invariant: parts are left out one after the other as long as it does."""
import copy

from scenes import Scene

NEEDED = {'dimension', 'body', 'spacing', 'materials', 'boundary', 'solver', 'output', 'mesh', 'points', 'thickness'}


def candidates(data):
    """Scenes with one thing less: a section, a key of one, an element of a list; then a coarser lattice."""
    for key in list(data):
        if key not in NEEDED:
            less = copy.deepcopy(data)
            del less[key]
            yield less
    for section in ('method', 'solver', 'output', 'failure', 'contact'):
        for key in list(data.get(section, {})):
            if key not in ('kind', 'criterion', 'pictures'):
                less = copy.deepcopy(data)
                del less[section][key]
                yield less
    for section in ('body', 'cracks', 'boundary', 'blocks'):
        if len(data.get(section, [])) > 1:
            for k in range(len(data[section])):
                less = copy.deepcopy(data)
                del less[section][k]
                yield less
    if data.get('spacing', 1) < 0.2:
        yield {**copy.deepcopy(data), 'spacing': data['spacing'] * 1.25}


def smallest(scene, violates, tries=60):
    best, smaller = scene, True
    while smaller and tries > 0:
        smaller = False
        for data in candidates(best.data):
            tries -= 1
            if tries < 0:
                break
            attempt = Scene(scene.seed, scene.kind, data, scene.files)
            if violates(attempt):
                best, smaller = attempt, True
                break
    return best
