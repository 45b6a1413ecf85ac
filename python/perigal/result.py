# SPDX-License-Identifier: GPL-3.0-or-later
"""What a run left in its folder. Nothing is read before it is asked for, and of fields only what is asked for."""
import csv
import json
import os

import netCDF4
import numpy


def _numbers(values):
    """A few numbers of a column, from both ends."""
    if len(values) <= 5:
        return ', '.join(f'{v:.6g}' for v in values) or 'no rows'
    return f'{values[0]:.6g}, {values[1]:.6g}, ... {values[-1]:.6g}'


class Table:
    """Columns of a CSV file by name: table['energy_strain'] (NaN: not measured). names, units, data (rows x columns).

    len (table): rows; table[3], table[-1]: a row as a dict; table[2:5], table[[0, 4]]: a table of these rows. A loop
    goes over the rows; keys (), values (), items () are those of the columns.
    """

    def __init__(self, path):
        with open(path, encoding='utf-8', newline='') as file:
            text = file.read()
        if text and not text.endswith('\n'):            # the program is still writing this row
            text = text[:text.rfind('\n') + 1]
        lines = text.splitlines()
        if not lines:
            raise ValueError(f'{path} is empty')
        heads = [head.rpartition(' [') for head in next(csv.reader(lines[:1]))]
        numbers = [k for k, head in enumerate(heads) if head[2] != 'name]']
        self.names = [heads[k][0] or heads[k][2] for k in numbers]
        self.units = [heads[k][2][:-1] if heads[k][0] else '' for k in numbers]
        rows = [row for row in csv.reader(lines[1:])]
        self.data = numpy.array([[float(row[k]) if row[k] else numpy.nan for k in numbers] for row in rows],
                                dtype=float).reshape(len(rows), len(numbers))

    def __getitem__(self, name):
        if isinstance(name, (int, numpy.integer)):
            if not -len(self) <= name < len(self):
                raise IndexError(f'there is no row {name}; there are {len(self)}')
            return dict(zip(self.names, self.data[name].tolist()))
        if isinstance(name, (slice, list, numpy.ndarray)):
            some = Table.__new__(Table)
            some.names, some.units, some.data = self.names, self.units, self.data[name]
            return some
        if name not in self.names:
            raise KeyError(f'there is no column {name}; there are: {", ".join(self.names)}')
        return self.data[:, self.names.index(name)]

    def __iter__(self):
        return (self[k] for k in range(len(self)))

    def keys(self):
        return list(self.names)

    def values(self):
        return [self[name] for name in self.names]

    def items(self):
        return [(name, self[name]) for name in self.names]

    def __contains__(self, name):
        return name in self.names

    def __len__(self):
        return len(self.data)

    def __repr__(self):
        columns = [f'  {name}{f" [{unit}]" if unit else ""}: {_numbers(self[name])}'
                   for name, unit in zip(self.names, self.units)]
        return '\n'.join([f'{type(self).__name__}: {len(self)} rows, {len(self.names)} columns', *columns])


class Sweep(Table):
    """The table of a sweep: numbers as in Table, and of each run status ('done', 'failed', 'interrupted', 'waiting'),
    trouble (why it failed), folder; words: {key: values} of keys whose values are no numbers.

    result (k): the Result of run k (from 0).
    """

    def __init__(self, folder):
        path = os.path.join(os.fspath(folder), 'sweep.csv')
        super().__init__(path)
        with open(path, encoding='utf-8', newline='') as file:
            rows = list(csv.DictReader(file))
        self.status = [row['status [name]'] for row in rows]
        self.trouble = [row['trouble [name]'] for row in rows]
        self.folder = [os.path.join(os.fspath(folder), row['folder [name]']) for row in rows]
        own = [head for head in (rows[0] if rows else {}) if head.endswith(' [name]')][:-3]
        self.words = {head[:-7]: [row[head] for row in rows] for head in own}

    def result(self, k):
        return Result(self.folder[k])

    def __repr__(self):
        status = {s: self.status.count(s) for s in dict.fromkeys(self.status)}
        words = [f'  {key}: {", ".join(values[:5])}{" ..." if len(values) > 5 else ""}' for key, values in self.words.items()]
        return '\n'.join([super().__repr__(), *words, f'  status: {", ".join(f"{n} {s}" for s, n in status.items())}'])


class Result:
    """A result folder.

    folder, title, dimension, points; times (s; load factor; step number: doc/output.md, time_whole);
    fields: {name: list of components}, units: {name: unit}; history, events: Table; report: dict.
    """

    def __init__(self, folder):
        self.folder = os.fspath(folder)
        if not os.path.isdir(self.folder):
            raise FileNotFoundError(f'there is no folder {self.folder}')
        path = os.path.join(self.folder, 'result.e')
        if not os.path.exists(path):
            raise FileNotFoundError(f'{self.folder} has no result.e: it is no result folder, or the run has written '
                                    'no fields yet')
        self._path, self._index, self.units = path, {}, {}
        with netCDF4.Dataset(path) as file:
            self.title = getattr(file, 'title', '')
            self.dimension = len(file.dimensions['num_dim'])
            self.points = int(getattr(file, 'points', len(file.dimensions['num_nodes'])))
            self.spacing = float(getattr(file, 'spacing', numpy.nan))
            self.times = numpy.array(file['time_whole'][:], dtype=float)
            self._read_names(file)
        self.fields = {name: list(parts) for name, parts in self._index.items()}

    def __repr__(self):
        fields = [f'  {name}{f" [{self.units[name]}]" if self.units[name] else ""}: {", ".join(filter(None, parts)) or "scalar"}'
                  for name, parts in self.fields.items()]
        steps = f'{len(self.times)} steps' + (f', {self.times[0]:.6g} to {self.times[-1]:.6g}' if len(self.times) else '')
        title = f' ({self.title})' if self.title else ''
        return '\n'.join([f'Result {self.folder}{title}: {self.points} points in {self.dimension}D, {steps}', *fields])

    def _read_names(self, file):
        """Variables that share the attribute `field` are the components of one; variable k holds values of name k."""
        if 'name_nod_var' not in file.variables:
            return
        names = file['name_nod_var']
        names.set_auto_mask(False)
        for k, letters in enumerate(names[:], 1):
            name = b''.join(letters).split(b'\0')[0].decode().strip()
            variable = file[f'vals_nod_var{k}']
            field = getattr(variable, 'field', name)
            self._index.setdefault(field, {})[name[len(field) + 1:]] = k
            self.units[field] = getattr(variable, 'units', '')

    def field(self, name, component=None, step=-1):
        """A field at a step (number from 0, -1: the last; a slice or a list of numbers: several).

        Points x components, or only points for one component (or a field that has one); several steps: a first axis
        of steps. 'place' (m) and 'point_volume' (m3) are there for every result and have no steps.
        """
        fixed = {'place': ['coordx', 'coordy', 'coordz'][:self.dimension], 'point_volume': ['point_volume']}
        if name in fixed:
            with netCDF4.Dataset(self._path) as file:
                values = [numpy.array(file[v][:self.points], dtype=float) for v in fixed[name]]
            if component is not None:
                return values['xyz'.index(component)]
            return numpy.stack(values, axis=-1) if name == 'place' else values[0]
        if name not in self._index:
            raise KeyError(f'{self.folder} has no field {name}; it has: {", ".join([*self._index, *fixed])}')
        parts = self._index[name]
        if component is not None and component not in parts:
            raise KeyError(f'{name} has no component {component}; it has: {", ".join(parts)}')
        chosen = [parts[component]] if component is not None else list(parts.values())
        steps = numpy.arange(len(self.times))[step]
        with netCDF4.Dataset(self._path) as file:
            values = [numpy.array(file[f'vals_nod_var{k}'][steps, :self.points], dtype=float) for k in chosen]
        return values[0] if len(values) == 1 else numpy.stack(values, axis=-1)

    @property
    def history(self):
        """history.csv: one row a step."""
        return Table(os.path.join(self.folder, 'history.csv'))

    @property
    def events(self):
        """events.csv: one row a broken bond, in the order in which they broke."""
        return Table(os.path.join(self.folder, 'events.csv'))

    @property
    def report(self):
        """report.json as a dict; FileNotFoundError: the run has not ended, or was interrupted."""
        with open(os.path.join(self.folder, 'report.json'), encoding='utf-8') as file:
            return json.load(file)
