"""The matrix as tables for doc/stability.md: a row a condition, the worst number of what was accepted in silence, and why cells were refused."""
import re
from collections import Counter

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


def condition_table(rows):
    out = ['| condition | cells | ok | refused | inexact | defect | worst share of the limit among ok | worst inexact number |', '|---|---|---|---|---|---|---|---|']
    for condition in dict.fromkeys(r['condition'] for r in rows):
        own = [r for r in rows if r['condition'] == condition]
        count = Counter(r['verdict'] for r in own)
        share = [r['number'] / r['limit'] for r in own if r['verdict'] == 'ok' and r['limit'] > 0]
        far = [r['number'] for r in own if r['verdict'] == 'inexact']
        out.append(f"| {condition} | {len(own)} | " + ' | '.join(str(count[v]) for v in VERDICTS)
                   + (f' | {max(share):.2g} |' if share else ' | |') + (f' {max(far):.3g} |' if far else ' |'))
    return out


def refusal_table(rows, most=15):
    count = Counter((r['condition'], kind(r['reason'])) for r in rows if r['verdict'] == 'refused')
    out = ['| condition | refused because | cells |', '|---|---|---|']
    for (condition, why), n in sorted(count.items(), key=lambda item: -item[1])[:most]:
        out.append(f"| {condition} | {why.replace('|', '/')} | {n} |")
    rest = sum(count.values()) - sum(n for _, n in count.most_common(most))
    return out + ([f'| others | | {rest} |'] if rest else [])


def write(path, rows, size, seconds):
    total = Counter(r['verdict'] for r in rows)
    with open(path, 'w') as out:
        out.write(f"{len(rows)} cells ({size}) in {seconds / 60:.0f} minutes: " + ', '.join(f'{total[v]} {v}' for v in VERDICTS)
                  + f"; {100 * total['refused'] / max(1, len(rows)):.1f} % refused.\n\n")
        out.write('\n'.join(condition_table(rows)) + '\n\n' + '\n'.join(refusal_table(rows)) + '\n')
