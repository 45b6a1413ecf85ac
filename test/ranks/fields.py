#!/usr/bin/env python3
"""fields.py SHARE FILE FILE [NAME...]: do two result files (Exodus in classic netCDF) hold the same points, times and fields? Numbers may differ by
this share of the largest of their field, all components together; names behind are left out. Says the largest difference of each field.
fields.py --variables FILE: names of variables and their shapes."""
import array
import re
import struct
import sys

SIZE = {1: 1, 2: 1, 3: 2, 4: 4, 5: 4, 6: 8, 10: 8}
CODE = {1: 'b', 2: 'c', 3: 'h', 4: 'i', 5: 'f', 6: 'd', 10: 'q'}


class File:
    """Variables by name: .shape, .values ()"""

    def __init__(self, path):
        self.data = open(path, 'rb').read()
        if self.data[:3] != b'CDF':
            sys.exit(f'{path}: no classic netCDF')
        self.version, self.at = self.data[3], 4
        self.wide = '>q' if self.version == 5 else '>i'
        self.records = self.number()
        self.dimensions = self.listed(lambda: (self.text(), self.number()))
        self.attributes = dict(self.listed(self.attribute))
        self.variables = dict(self.listed(self.variable))
        # a record holds all variables that have records, each filled up to four bytes, unless there is only one
        own = [v for v in self.variables.values() if v['record']]
        self.step = sum(v['room'] for v in own) if len(own) > 1 else (own[0]['bytes'] if own else 0)

    def take(self, form):
        value = struct.unpack_from(form, self.data, self.at)[0]
        self.at += struct.calcsize(form)
        return value

    def number(self):
        return self.take(self.wide)

    def text(self):
        n = self.number()
        out = self.data[self.at:self.at + n].decode()
        self.at += (n + 3) // 4 * 4
        return out

    def listed(self, read):
        self.take('>i')
        return [read() for _ in range(self.number())]

    def attribute(self):
        name, kind, n = self.text(), self.take('>i'), self.number()
        raw = self.data[self.at:self.at + n * SIZE[kind]]
        self.at += (n * SIZE[kind] + 3) // 4 * 4
        return name, raw.rstrip(b'\0').decode() if kind == 2 else self.array(raw, kind)

    def variable(self):
        name = self.text()
        ids = [self.number() for _ in range(self.number())]
        self.listed(self.attribute)
        kind, room, begin = self.take('>i'), self.number(), self.take('>i' if self.version == 1 else '>q')
        shape = [self.dimensions[i][1] for i in ids]
        record, count = bool(shape) and shape[0] == 0, 1
        for n in shape[1 if record else 0:]:
            count *= n
        return name, dict(kind=kind, begin=begin, shape=([self.records] + shape[1:]) if record else shape, record=record,
                          bytes=count * SIZE[kind], room=(count * SIZE[kind] + 3) // 4 * 4)

    @staticmethod
    def array(raw, kind):
        out = array.array(CODE[kind], raw)
        if sys.byteorder == 'little':
            out.byteswap()
        return out

    def values(self, name):
        """All of a variable; of a text its words."""
        v = self.variables[name]
        raw = b''.join(self.data[v['begin'] + r * self.step:][:v['bytes']] for r in range(self.records if v['record'] else 1))
        if v['kind'] != 2:
            return self.array(raw, v['kind'])
        width = v['shape'][-1]
        return [raw[i:i + width].split(b'\0')[0].decode() for i in range(0, len(raw), width)]

    def fields(self):
        """Field, without the suffix of its component: its values; and places and times."""
        out = {name: self.values(name) for name in ('coordx', 'coordy', 'coordz', 'time_whole') if name in self.variables}
        for k, name in enumerate(self.values('name_nod_var')):
            base = re.sub(r'_([xyz]|[xyz]{2})$', '', name)
            out.setdefault(base, array.array('d')).extend(self.values(f'vals_nod_var{k + 1}'))
        return out


if __name__ == '__main__':
    if sys.argv[1] == '--variables':
        file = File(sys.argv[2])
        for name, v in file.variables.items():
            print(name, *v['shape'])
        sys.exit()
    share, out, wrong = float(sys.argv[1]), sys.argv[4:], 0
    one, other = [File(path).fields() for path in sys.argv[2:4]]
    if list(one) != list(other):
        sys.exit(f'{", ".join(one)} and {", ".join(other)}')
    for name, a in one.items():
        b = other[name]
        if name in out:
            continue
        size = max((abs(x) for x in a), default=0) or 1
        apart = max((abs(x - y) for x, y in zip(a, b)), default=0) / size if len(a) == len(b) else float('inf')
        bad = len(a) != len(b) or not apart <= share or any(x != x for x in b)
        print(f'{name}: {len(a)} numbers, {apart:.1e} of the largest{", TOO MUCH" if bad else ""}')
        wrong |= bad
    sys.exit(wrong)
