"""The picture of the matrix: a row a condition, a column a method, each cell in shares of the verdicts on its values."""
from html import escape

COLOURS = {'ok': '#4c9f70', 'refused': '#8fb4d9', 'inexact': '#e8b04b', 'defect': '#c0392b'}
MEANING = {'ok': 'within its limit', 'refused': 'refused with the reason', 'inexact': 'beyond its limit, and said so', 'defect': 'wrong without a word'}
SIDE, LEFT, TOP = 14, 230, 190


def draw(path, cells):
    conditions = list(dict.fromkeys(c for c, _, _ in cells))
    methods = sorted({m for _, m, _ in cells})
    found = {}
    for condition, method, verdict in cells:
        found.setdefault((condition, method), []).append(verdict)
    width, height = LEFT + SIDE * len(methods) + 130, TOP + SIDE * len(conditions) + 60
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" font-size="10">',
           f'<rect width="{width}" height="{height}" fill="white"/>']
    for k, method in enumerate(methods):
        x = LEFT + SIDE * k + 10
        out.append(f'<text transform="translate({x},{TOP - 6}) rotate(-60)">{escape(method)}</text>')
    for j, condition in enumerate(conditions):
        y = TOP + SIDE * j
        out.append(f'<text x="{LEFT - 6}" y="{y + 10}" text-anchor="end">{escape(condition)}</text>')
        for k, method in enumerate(methods):
            verdicts = found.get((condition, method))
            if verdicts:
                counts = ', '.join(f'{verdicts.count(v)} {v}' for v in COLOURS if v in verdicts)
                out.append(f'<g><title>{escape(condition)} | {escape(method)}: {counts}</title>')
                left = LEFT + SIDE * k
                for name, colour in COLOURS.items():
                    share = (SIDE - 1) * verdicts.count(name) / len(verdicts)
                    if share:
                        out.append(f'<rect x="{left:.2f}" y="{y}" width="{share:.2f}" height="{SIDE - 1}" fill="{colour}"/>')
                    left += share
                out.append('</g>')
    x = LEFT
    for name, colour in COLOURS.items():
        y = TOP + SIDE * len(conditions) + 20
        out.append(f'<rect x="{x}" y="{y}" width="{SIDE - 1}" height="{SIDE - 1}" fill="{colour}"/>'
                   f'<text x="{x + SIDE + 4}" y="{y + 10}">{name}: {MEANING[name]}</text>')
        x += 240
    out.append('</svg>')
    with open(path, 'w') as file:
        file.write('\n'.join(out) + '\n')
