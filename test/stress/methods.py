"""The columns of the matrix: every way to compute that the program lists, so that a new catalogue entry joins by itself.

A method is a name, the changes that it makes to a scene, and the family of conditions that it takes part in:
`static` methods carry a load to equilibrium, `motion` methods march in time, `break` methods let bonds fail.
"""
import subprocess

# Criteria read what bonds show: those of shape functions show stress and stretch, those of points stretch, energy, or (gmpd) bending. The rest of the pairs is
# not offered, so that there are no cells of them; a criterion or a force that is not named here is paired with all.
NOT_OFFERED = {('bond', 'principal_stress'), ('fcbm', 'principal_stress'), ('lps', 'principal_stress'), ('gmpd', 'principal_stress'),
               ('bond', 'mohr_coulomb'), ('fcbm', 'mohr_coulomb'), ('lps', 'mohr_coulomb'), ('gmpd', 'mohr_coulomb'),
               ('bond', 'drucker_prager'), ('fcbm', 'drucker_prager'), ('lps', 'drucker_prager'), ('gmpd', 'drucker_prager'),
               ('galerkin', 'node_energy'), ('gmpd', 'node_energy'),
               ('galerkin', 'beam_limits'), ('bond', 'beam_limits'), ('fcbm', 'beam_limits'), ('lps', 'beam_limits')}
BOND_POISSON = {('stress', 2): 1 / 3, ('strain', 2): 1 / 4, ('', 3): 1 / 4}


class Method:
    def __init__(self, name, changes, kinds, force='galerkin'):
        self.name, self.changes, self.kinds, self.force = name, changes, kinds, force

    @property
    def needs_lattice(self):
        """Sums by Fourier transforms take points of a lattice alone: clouds, meshes and moved points are not offered."""
        return self.force == 'fcbm'

    @property
    def takes_bars(self):
        """State-based and micropolar forces are those of bonds in one dimension, and are not offered there."""
        return self.force not in ('lps', 'gmpd')

    def poisson(self, plane, dimension):
        """Poisson's ratio of conditions that do not set one: what pair forces carry, else that of rock."""
        if dimension == 1:
            return 0
        if self.force in ('bond', 'fcbm'):
            return BOND_POISSON[(plane if dimension == 2 else '', dimension)]
        return 0.2


def catalogue(program):
    """The entries of `perigal list`: {key: [name, ...]}."""
    entries, key = {}, None
    for line in subprocess.run([program, 'list'], capture_output=True, text=True, check=True).stdout.splitlines():
        if line and not line[0].isspace():
            key = line.strip()
            entries[key] = []
        elif line.strip():
            entries[key].append(line.split()[0])
    return entries


def methods(program):
    has = catalogue(program)
    found = []
    for approximation in has['method.approximation']:
        for integration in has['method.integration']:
            for basis, horizon in (('linear', '2.0 spacing'), ('quadratic', '2.8 spacing')):
                changes = {'method': {'force': 'galerkin', 'approximation': approximation, 'integration': integration,
                                      'basis': basis, 'horizon': horizon}}
                kinds = {'static', 'break'} if basis == 'linear' else {'static'}
                found.append(Method(f'{approximation} {integration} {basis}', changes, kinds))
    for force in has['method.force']:
        if force != 'galerkin':
            found.append(Method(force, {'method': {'force': force}}, {'static', 'break'}, force))
    if 'gmpd' in has['method.force']:
        found.append(Method('gmpd volumetric', {'method': {'force': 'gmpd', 'volumetric': True}}, {'static'}, 'gmpd'))
    for kernel in has['method.kernel']:
        found.append(Method(f'rkpm gauss, {kernel}', {'method': {'kernel': kernel}}, {'static'}))
        found.append(Method(f'bond, {kernel}', {'method': {'force': 'bond', 'kernel': kernel}}, {'static'}, 'bond'))
    for linear in has['solver.linear']:
        found.append(Method(f'rkpm gauss, {linear}', {'solver': {'linear': linear}}, {'linear'}))
        found.append(Method(f'bond, {linear}', {'method': {'force': 'bond'}, 'solver': {'linear': linear}}, {'linear'}, 'bond'))
    for solver in has['solver.kind']:
        for force in has['method.force']:
            kinds = {'relaxed'} if solver in ('adr', 'relax') else {'motion'} if solver != 'static' else set()
            if kinds:
                found.append(Method(f'{force}, {solver}', {'method': {'force': force}, 'solver': {'kind': solver}}, kinds, force))
    for criterion in has['failure.criterion']:
        for force in (f for f in has['method.force'] if (f, criterion) not in NOT_OFFERED):
            changes = {'method': {'force': force}, 'failure': {'criterion': criterion}}
            found.append(Method(f'{force}, {criterion}', changes, {'criterion'}, force))
    return found
