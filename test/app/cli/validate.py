# SPDX-License-Identifier: GPL-3.0-or-later
"""validate.py SCHEMA SCENE.json...: as much of JSON schema as the one of scenes uses; prints what does not fit, and `SCENE.json: fits` where all does."""
import json
import sys

TYPES = {'object': dict, 'array': list, 'string': str, 'number': (int, float), 'integer': int}


def is_a(value, name):
    return isinstance(value, TYPES[name]) and not isinstance(value, bool)


def faults(value, schema, place):
    if 'anyOf' in schema:
        kinds = [list(faults(value, s, place)) for s in schema['anyOf']]
        if all(kinds):
            yield from kinds[0]
    if 'type' in schema:
        names = schema['type'] if isinstance(schema['type'], list) else [schema['type']]
        if not any(is_a(value, n) for n in names):
            yield f'{place}: {value!r} is no {" or ".join(names)}'
    if 'enum' in schema and value not in schema['enum']:
        yield f'{place}: {value!r} is none of {schema["enum"]}'
    if isinstance(value, dict):
        for key, inner in value.items():
            below = schema.get('properties', {}).get(key, schema.get('additionalProperties', {}))
            if below is False:
                yield f'{place}.{key}: unknown key'
            else:
                yield from faults(inner, below, f'{place}.{key}')
    if isinstance(value, list):
        for k, inner in enumerate(value):
            yield from faults(inner, schema.get('items', {}), f'{place}[{k}]')


schema, wrong = json.load(open(sys.argv[1], encoding='utf-8')), False
for path in sys.argv[2:]:
    found = list(faults(json.load(open(path, encoding='utf-8')), schema, ''))
    print('\n'.join(found or [f'{path}: fits']))
    wrong = wrong or bool(found)
sys.exit(wrong)
