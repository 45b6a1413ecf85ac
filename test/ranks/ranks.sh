# ranks.sh BUILD, for test_*.sh of this folder to read first: perigal-mpi as $mpi, run on several ranks by `ranks N ...`. Where MPI or PETSc is
# not installed the tests say that they are skipped.
. "$(dirname "$0")/../app/cli/expect.sh"
cd "$(dirname "$0")" || exit 1
mpi=$(dirname "$perigal")/perigal-mpi
if [ ! -x "$mpi" ] || ! command -v mpirun > /dev/null; then
    echo "ok 1 - # SKIP perigal-mpi is built where petsc-dev, mpi-default-dev and mpi-default-bin are installed"; echo 1..1; exit 0
fi
. ./mpirun.sh
alone() { "$perigal" run "$@" "${bare[@]}" --quiet --threads 1 > "$work/out" 2> "$work/err"; }
# counted DIR DIR: their reports count the same steps, events, iterations and broken bonds
counts() { grep -E '^  "(steps|events|iterations|broken)": [0-9]+' "$1/report.json"; }
counted() { diff <(counts "$1") <(counts "$2") > "$work/why" && [ -s "$1/report.json" ]; }
# alike SHARE DIR DIR TABLE [COLUMN...]: the same rows, see compare.py
alike() { python3 -S compare.py "$1" "$2/$4" "$3/$4" "${@:5}" > "$work/why" 2>&1; }
