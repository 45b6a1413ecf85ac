# SPDX-License-Identifier: GPL-3.0-or-later
"""What needs the library itself (libperigal.so, by ctypes): stiffness matrices, families, shape functions.

The layout of the structures is that of include/perigal of the same version.
"""
import ctypes
import os
from collections import namedtuple
from ctypes import POINTER, byref, c_char, c_char_p, c_double, c_int, c_long, c_size_t, c_ubyte, c_void_p

import numpy

from perigal.program import Failed, SceneError, UsageError, program, scene_file, settings

OK, E_SCENE, E_USAGE = 0, 1, 2


class Sparse(namedtuple('Sparse', 'data indices indptr shape')):
    """A sparse matrix by compressed columns. csc () makes it one of scipy.sparse, dense () an array."""

    def __repr__(self):
        return f'Sparse({self.shape[0]} x {self.shape[1]}, {len(self.data)} entries)'

    def csc(self):
        from scipy.sparse import csc_matrix
        return csc_matrix((self.data, self.indices, self.indptr), shape=self.shape)

    def columns(self):
        """The column of every entry."""
        return numpy.repeat(numpy.arange(self.shape[1]), numpy.diff(self.indptr))

    def dense(self):
        out = numpy.zeros(self.shape)
        out[self.indices, self.columns()] = self.data
        return out

    def __matmul__(self, x):
        """The product with a vector."""
        return numpy.bincount(self.indices, weights=self.data * numpy.asarray(x)[self.columns()],
                              minlength=self.shape[0])


# ---- structures of the library ------------------------------------------------------------------------------
def _shown(value):
    """A value of a structure in words; what a pointer leads to has a length that only the library knows."""
    if isinstance(value, ctypes.Array):
        return list(value)
    if value is None or isinstance(value, (int, float, bytes, ctypes.Structure)):
        return value
    return _Words('array' if value else 'none')


class _Words(str):
    __repr__ = str.__str__


class _Structure(ctypes.Structure):
    """A structure of the library's headers (`of` names it there), field by field; it shows its values, not its address."""

    def __repr__(self):
        parts = [f'{field[0]}={_shown(getattr(self, field[0]))!r}' if not _is_address(field[1]) else
                 f'{field[0]}={"array" if getattr(self, field[0]) else "none"}' for field in self._fields_]
        return f'{type(self).__name__.lstrip("_")}({", ".join(parts)})'


def _is_address(kind):
    return kind is c_void_p


class _Matrix(_Structure):
    of = 'pg_sparse'
    _fields_ = [('nrow', c_size_t), ('ncol', c_size_t), ('symmetric', c_int), ('start', POINTER(c_long)),
                ('row', POINTER(c_long)), ('value', POINTER(c_double))]


class _Family(_Structure):
    of = 'pg_family'
    _fields_ = [('n', c_size_t), ('start', POINTER(c_size_t)), ('node', POINTER(c_int))]


class _Cloud(_Structure):
    of = 'pg_cloud'
    _fields_ = [('dim', c_int), ('n', c_size_t), ('x', c_void_p), ('volume', c_void_p), ('block', c_void_p),
                ('size', c_void_p), ('metric', c_void_p), ('h', c_double), ('step', c_double * 3),
                ('regular', c_int), ('centred', c_int), ('thickness', c_double), ('low', c_double * 3),
                ('high', c_double * 3), ('subdomain', c_void_p), ('passed', c_char * 64),
                ('between', c_void_p)]


class _Rows(_Structure):
    of = 'pg_rows'
    _fields_ = [('dim', c_int), ('n', c_size_t), ('x', c_void_p), ('weight', c_void_p), ('own', c_void_p),
                ('cell', c_void_p), ('family', _Family), ('N', POINTER(c_double)), ('dN', POINTER(c_double)),
                ('w', c_void_p), ('at', c_void_p), ('wide', c_void_p), ('grade', POINTER(c_ubyte)), ('copied', c_size_t),
                ('copied_bonds', c_size_t), ('eye', c_void_p), ('parted', c_size_t)]


class _Choice(_Structure):
    of = 'pg_shape_choice'
    _fields_ = [('approximation', c_char_p), ('kernel', c_char_p), ('support', c_char_p), ('weights', c_char_p),
                ('degenerate', c_char_p), ('order', c_int), ('horizon', c_double)]


class _Equations(_Structure):
    of = 'pg_equations'
    _fields_ = [('n', c_size_t), ('unknowns', c_int), ('dim', c_int), ('K', _Matrix), ('f', POINTER(c_double)),
                ('T', _Matrix), ('g', POINTER(c_double)), ('N', _Matrix), ('selects', c_int),
                ('free', POINTER(c_size_t)), ('idle', c_size_t)]


_loaded = None


def library():
    """The library: $PERIGAL_LIBRARY, the source tree around this package, beside the program, or as installed."""
    global _loaded
    if _loaded:
        return _loaded
    here = os.path.dirname(os.path.abspath(__file__))
    places = [os.environ.get('PERIGAL_LIBRARY'),
              os.path.join(here, '..', '..', 'build', 'release', 'libperigal.so.0'), _beside_program(),
              'libperigal.so.0']
    for place in places:
        if not place or (os.path.isabs(place) and not os.path.exists(place)):
            continue
        try:
            _loaded = ctypes.CDLL(place)
        except OSError:
            if place == places[0]:
                raise
            continue
        _loaded.pg_last_error.restype = c_char_p
        return _loaded
    raise FileNotFoundError('there is no libperigal.so.0: build it (make), install it, or name it by the environment '
                            'variable PERIGAL_LIBRARY')


def _beside_program():
    try:
        return os.path.join(os.path.dirname(os.path.realpath(program())), '..', 'lib', 'libperigal.so.0')
    except FileNotFoundError:
        return None


def _try(status):
    if status != OK:
        kind = {E_SCENE: SceneError, E_USAGE: UsageError}.get(status, Failed)
        raise kind(library().pg_last_error().decode('utf-8', 'replace'))


def _array(pointer, n, kind=float):
    """A copy of n numbers of the library."""
    return numpy.ctypeslib.as_array(pointer, (n,)).astype(kind) if n else numpy.zeros(0, kind)


def _doubles(values, what, columns=None):
    """An array of the library's kind, or UsageError."""
    a = numpy.ascontiguousarray(values, dtype=float)
    if a.ndim != (1 if columns == 1 else 2) or (columns not in (None, 1) and a.shape[1] != columns):
        raise UsageError(f'{what}: an array of {a.shape} is not what is needed')
    return a


def _matrix(m):
    """A copy; of a symmetric one both triangles."""
    indptr = _array(m.start, m.ncol + 1, int)
    nnz = int(indptr[-1])
    row, value = _array(m.row, nnz, int), _array(m.value, nnz)
    if not m.symmetric:
        return Sparse(value, row, indptr, (m.nrow, m.ncol))
    column = numpy.repeat(numpy.arange(m.ncol), numpy.diff(indptr))
    off = row != column
    i, j = numpy.concatenate((row, column[off])), numpy.concatenate((column, row[off]))
    v, order = numpy.concatenate((value, value[off])), numpy.lexsort((i, j))
    starts = numpy.concatenate(([0], numpy.cumsum(numpy.bincount(j, minlength=m.ncol))))
    return Sparse(v[order], i[order], starts, (m.nrow, m.ncol))


# ---- points -------------------------------------------------------------------------------------------------
class _points:
    """A cloud of the library while a with block lasts."""

    def __init__(self, x, volume, spacing, thickness):
        self.x = _doubles(x, 'points')
        self.volume = None if volume is None else _doubles(volume, 'volume', 1)
        if self.volume is not None and len(self.volume) != len(self.x):
            raise UsageError(f'volume: {len(self.volume)} volumes of {len(self.x)} points')
        self.spacing, self.thickness, self.cloud = spacing, thickness, _Cloud()

    def __enter__(self):
        _try(library().pg_cloud_of_arrays(byref(self.cloud), c_int(self.x.shape[1]), c_size_t(len(self.x)),
                                          self.x.ctypes, self.volume.ctypes if self.volume is not None else None,
                                          c_double(self.spacing or 0), c_double(self.thickness)))
        return self.cloud

    def __exit__(self, *ignored):
        library().pg_cloud_clear(byref(self.cloud))


def families(x, horizon, centres=None, tensor=False, closed=True):
    """Which of the points x (n x 1, 2 or 3, m) each of them, or each of other centres, sees within the horizon (m).

    Returns (start, node): centre k sees node[start[k]:start[k + 1]], ascending. tensor: squares or cubes instead of
    balls; closed: a distance of exactly the horizon counts. UsageError.
    """
    x = _doubles(x, 'points')
    centres = x if centres is None else _doubles(centres, 'centres', x.shape[1])
    if not 0 < horizon < 1e300:
        raise UsageError('the horizon must be above 0')
    family = _Family()
    with _points(x, None, horizon, 1) as cloud:
        _try(library().pg_family_build(byref(family), byref(cloud), c_size_t(len(centres)), centres.ctypes,
                                       c_double(horizon), c_int(tensor), c_int(closed)))
        start = _array(family.start, len(centres) + 1, int)
        node = _array(family.node, int(start[-1]), int)
        library().pg_family_clear(byref(family))
    return start, node


def shape_functions(x, horizon, places=None, volume=None, spacing=None, thickness=1, approximation='rkpm',
                    kernel='cubic_spline', order=1, support='radial', weights='auto', degenerate='shepard',
                    alive=None):
    """Shape functions of points x (n x dim, m) at places (default: the points themselves), by the names of a scene.

    Returns (N, dN, grade): Sparse matrices places x points, one derivative an axis (1/m), and per place 0: full
    basis ... 4: no neighbour. volume (m3) of each point or a spacing (m) is needed. alive: a flag for each entry of
    `families` of the same places, horizon and support (closed for kernels that are not zero at the horizon).
    """
    rows = _Rows()
    words = [w.encode() for w in (approximation, kernel, support, weights, degenerate)]
    choice = _Choice(*words, order, horizon)
    with _points(x, volume, spacing, thickness) as cloud:
        at = None if places is None else _doubles(places, 'places', cloud.dim)
        n = cloud.n if at is None else len(at)
        flags = None
        if alive is not None:
            known = families(x, horizon, at, support == 'tensor', kernel_is_closed(kernel))[0][-1]
            flags = numpy.ascontiguousarray(alive, dtype=numpy.uint8)
            if flags.shape != (known,):
                raise UsageError(f'alive: {flags.shape} flags of {known} bonds')
        _try(library().pg_shape_functions(byref(rows), byref(choice), byref(cloud), c_size_t(n),
                                          at.ctypes if at is not None else None,
                                          flags.ctypes if flags is not None else None, c_int(1)))
        start = _array(rows.family.start, n + 1, int)
        nnz, dim = int(start[-1]), cloud.dim
        node = _array(rows.family.node, nnz, int)
        values = [_array(rows.N, nnz)] + list(_array(rows.dN, nnz * dim).reshape(-1, dim).T)
        grade = _array(rows.grade, n, int)
        shape = (n, int(cloud.n))
        library().pg_rows_clear(byref(rows))
    order = numpy.argsort(node, kind='stable')         # by columns; places ascend in each
    place = numpy.repeat(numpy.arange(n), numpy.diff(start))[order]
    indptr = numpy.concatenate(([0], numpy.cumsum(numpy.bincount(node, minlength=shape[1]))))
    N, *dN = [Sparse(v[order], place, indptr, shape) for v in values]
    return N, dN, grade


class _Kernel(_Structure):
    of = 'pg_kernel'
    _fields_ = [('name', c_char_p), ('summary', c_char_p), ('closed', c_int), ('value', c_void_p)]


def kernel_is_closed(name):
    """True if that kernel is not zero at the horizon, so that bonds of exactly its length count."""
    find = library().pg_kernel_find
    find.restype = POINTER(_Kernel)
    kernel = find(name.encode())
    if not kernel:
        raise UsageError(f"there is no kernel '{name}'")
    return bool(kernel.contents.closed)


# ---- scenes -------------------------------------------------------------------------------------------------
Equations = namedtuple('Equations', 'K f T g N free idle unknowns place')
Equations.__doc__ = """K d = f of a scene, d = T q + g: (T' K T) q = T' (f - K g), and N d are the displacements.

K (N/m, symmetric, both triangles), T, N: Sparse; f (N), g (m); free: the unknowns that supports leave free (None where T
ties several together); idle: how many are held because nothing resists them; unknowns: of a point; place (m)."""


def stiffness(scene, set=None, t=1, threads=1):
    """The linear system of a scene (file or dict) at load factor or time t, pre-cracks cut: Equations.

    Raises SceneError, UsageError (forces that reach neighbours of neighbours, platens, contact), Failed.
    """
    lib, session, e = library(), c_void_p(), _Equations()
    if not isinstance(t, (int, float)) or isinstance(t, bool):
        raise UsageError('t must be a number')
    words = [w.encode() for w in settings(set)[1::2]]
    with scene_file(scene) as file:
        _try(lib.pg_session_open(byref(session), os.fsencode(file), c_size_t(len(words)),
                                 (c_char_p * len(words))(*words), c_int(threads)))
    try:
        _try(lib.pg_session_equations(byref(e), session, c_double(t)))
        n = e.n // e.unknowns
        lib.pg_session_places.restype = POINTER(c_double)
        places = lib.pg_session_places(session)
        return Equations(_matrix(e.K), _array(e.f, e.n), _matrix(e.T), _array(e.g, e.n), _matrix(e.N),
                         _array(e.free, e.T.ncol, int) if e.selects else None, int(e.idle), int(e.unknowns),
                         _array(places, n * e.dim).reshape(-1, e.dim))
    finally:
        lib.pg_equations_clear(byref(e))
        lib.pg_session_close(byref(session))
