# ranks.sh BUILD, for test_*.sh of this folder to read first: perigal-mpi as $mpi, run on several ranks by `ranks N ...`. Where MPI or PETSc is
# not installed the tests say that they are skipped.
. "$(dirname "$0")/../cli/expect.sh"
cd "$(dirname "$0")" || exit 1
mpi=$(dirname "$perigal")/perigal-mpi
if [ ! -x "$mpi" ] || ! command -v mpirun > /dev/null; then
    echo "ok 1 - # SKIP perigal-mpi is built where petsc-dev, mpi-default-dev and mpi-default-bin are installed"; echo 1..1; exit 0
fi
# root may run them, more ranks than cores too, which then give way to each other; without threads of BLAS
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_btl_vader_single_copy_mechanism=none
export OMPI_MCA_rmaps_base_oversubscribe=1 OMP_NUM_THREADS=1
# without a look for fast networks (0.2 s a run); not bound to the cores that another test is bound to
export OMPI_MCA_pml=ob1 OMPI_MCA_hwloc_base_binding_policy=none
ranks() { local n=$1; shift; timeout 300 mpirun --oversubscribe -n "$n" "$mpi" run "$@" --quiet > "$work/out" 2> "$work/err"; }
alone() { "$perigal" run "$@" --quiet --threads 1 > "$work/out" 2> "$work/err"; }
# alike SHARE DIR DIR TABLE [COLUMN...]: the same rows, see compare.py
alike() { python3 compare.py "$1" "$2/$4" "$3/$4" "${@:5}" > "$work/why" 2>&1; }
