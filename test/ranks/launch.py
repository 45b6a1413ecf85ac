"""How tests in Python start several ranks on one machine: root may run them, more than there are cores too, without a look for fast networks."""
import os
import subprocess

LAUNCH = ['mpirun', '--oversubscribe', '--allow-run-as-root']
os.environ.update(OMPI_MCA_mpi_yield_when_idle='1', OMPI_MCA_btl_vader_single_copy_mechanism='none', OMPI_MCA_pml='ob1', OMPI_MCA_hwloc_base_binding_policy='none')


def ranks_sleep(folder, program):
    """A rank that waits for another one asks again and again; beside other work it is better to sleep in between, as the tests of ranks do (mpirun.sh), by a
    library in this folder. Not with sanitizers, whose own library wants to be the first."""
    if 'asan' in program or 'tsan' in program:
        return
    source, library = os.path.join(folder, 'sleep.c'), os.path.abspath(os.path.join(folder, 'sleep.so'))
    with open(source, 'w', encoding='ascii') as out:
        out.write('#include <time.h>\nint sched_yield (void) { struct timespec t = { 0, 1000 }; return nanosleep (&t, 0); }\n')
    if subprocess.run([*os.environ.get('CC', 'gcc').split(), '-shared', '-fPIC', '-o', library, source], capture_output=True).returncode == 0:
        LAUNCH.extend(['-x', f'LD_PRELOAD={library}'])
