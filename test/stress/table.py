"""The matrix as tables for doc/stability.md: a row a condition, a row a method with what it bears, and why cells were refused."""
import re
from collections import Counter

RATIO = "Poisson's ratio"
VERDICTS = ('ok', 'refused', 'inexact', 'defect')


def kind(reason):
    """A refusal without its own numbers, names and places: what many cells share."""
    text = re.sub(r'^\S*scene\.yaml(:\d+)*: ', '', reason)
    text = re.sub(r'^perigal: ', '', text)
    text = re.sub(r'\([^)]*\)', '(...)', text)
    text = re.sub(r'[-+]?\d[\d.]*(e[-+]?\d+)?', '#', text)
    text = re.sub(r'under uniform stress [a-z]+ ', 'under uniform stress ', text)
    text = re.sub(r': this body is # % too (soft|stiff)', '', text)
    text = re.sub(r'#(, #)+', '#', text.split('; ')[0])
    return text if len(text) <= 110 else text[:110].rsplit(' ', 1)[0] + ' ...'


def expected_to_run(rows):
    return sum(r['expected'] == 'runs' for r in rows)


def shares(rows):
    return [float(r['number']) / float(r['limit']) for r in rows if r['number'] and float(r['limit']) > 0]


def condition_table(rows):
    out = ['| condition | cells | ok | of these refused as they must be | refused | inexact | defect | worst share of the limit among ok | worst share among inexact |',
           '|---|---|---|---|---|---|---|---|---|']
    for condition in dict.fromkeys(r['condition'] for r in rows):
        own = [r for r in rows if r['condition'] == condition]
        count = Counter(r['verdict'] for r in own)
        must = sum(r['verdict'] == 'ok' and r['expected'] != 'runs' for r in own)
        good, far = shares(r for r in own if r['verdict'] == 'ok'), shares(r for r in own if r['verdict'] == 'inexact')
        out.append(f"| {condition} | {len(own)} | {count['ok']} | {must or ''} | {count['refused'] or ''} | {count['inexact'] or ''} | {count['defect']} | "
                   + (f'{max(good):.2g}' if good else '') + ' | ' + (f'{max(far):.2g}' if far else '') + ' |')
    return out


def must_table(rows):
    """What must be refused, and is."""
    count = Counter((r['condition'], r['expected'][len('refused: '):]) for r in rows if r['expected'] != 'runs')
    return ['| condition | must be refused, since | cells |', '|---|---|---|'] + [f'| {c} | {why} | {n} |' for (c, why), n in count.items()]


def refusal_table(rows):
    """Every reason for which sound input was refused."""
    count = Counter((r['condition'], kind(r['reason'])) for r in rows if r['verdict'] == 'refused')
    return ['| condition | refused because | cells |', '|---|---|---|'] + [f"| {c} | {why.replace('|', '/')} | {n} |"
                                                                       for (c, why), n in sorted(count.items(), key=lambda item: -item[1])]


# ---- what each method bears --------------------------------------------------------------------------------------------

def value_of(row):
    return re.match(r'[^\s,|]+', row['value']).group(0).replace('1:', '')


def reach(rows, method, condition, where):
    """The values of a condition whose cells are all ok, from the mildest on, and behind them in brackets how far a run goes on with a warning; '-': none."""
    own = [r for r in rows if r['condition'] == condition and r['method'] == method and where in r['value'] and r['expected'] == 'runs']
    verdicts = {}
    for r in own:
        verdicts.setdefault(float(value_of(r)), []).append(r['verdict'])
    values = sorted(verdicts)
    if not values:
        return ''
    fine = [set(verdicts[v]) == {'ok'} for v in values]
    begin = next((k for k, well in enumerate(fine) if well), None)
    end = begin if begin is not None else -1
    while begin is not None and end + 1 < len(values) and fine[end + 1]:
        end += 1
    span = '-' if begin is None else f'{values[begin]:g}' if begin == end else f'{values[begin]:g} to {values[end]:g}'
    warned = [v for k, v in enumerate(values) if k > end and 'refused' not in verdicts[v] and all('refused' not in verdicts[w] for w in values[end + 1:k])]
    if begin is None:                                          # not from the smallest on, which are refused
        warned = [v for v in values if 'refused' not in verdicts[v]]
    return span + (f' ({warned[-1]:g})' if warned else '')


def method_table(rows):
    """Per method the values within which the patch error stays below 5 %, by dimension where they differ."""
    out = ['| method | horizon, spacings: bar; plane; 3D | points moved by, spacings: plane; 3D | graded mesh, plane; 3D | Poisson\'s ratio: plane stress; plane strain; 3D |',
           '|---|---|---|---|---|']
    for method in dict.fromkeys(r['method'] for r in rows if r['condition'] == 'horizon'):
        def of(condition, *where):
            return '; '.join(reach(rows, method, condition, w) for w in where)
        out.append(f"| {method} | {of('horizon', '1D', '2D', '3D')} | {of('moved lattice points', '2D', '3D')} | {of('graded mesh', '2D', '3D')} | "
                   f"{of(RATIO, 'plane stress', 'plane strain', '3D')} |")
    return out


def step_table(rows):
    """Per solver in motion the largest time step that ran and kept its energy, and the stable one that a refusal named."""
    out = ['| method | largest of the steps 1e-9 to 1e-3 s that keeps the energy | stable up to, as the refusal of the next says |', '|---|---|---|']
    for method in dict.fromkeys(r['method'] for r in rows if r['condition'] == 'time step'):
        own = [r for r in rows if r['condition'] == 'time step' and r['method'] == method]
        good = [float(value_of(r)) for r in own if r['verdict'] == 'ok' and not r['reason']]
        named = [m.group(1) for r in own for m in [re.search(r'stable up to (\S+) s', r['reason'])] if m]
        out.append(f"| {method} | {max(good):g} s | {named[0] + ' s' if named else 'any'} |" if good else f'| {method} | - | |')
    return out


def write(path, rows, size):
    total, should = Counter(r['verdict'] for r in rows), expected_to_run(rows)
    with open(path, 'w') as out:
        out.write(f"{len(rows)} cells ({size}): " + ', '.join(f'{total[v]} {v}' for v in VERDICTS)
                  + f"; of the {should} that should run {100 * total['refused'] / max(1, should):.1f} % are refused.\n\n")
        for part in (condition_table, method_table, step_table, must_table, refusal_table):
            out.write('\n'.join(part(rows)) + '\n\n')
