# mpirun.sh, for scripts that have set $mpi and $work: `ranks N ARGUMENTS...` runs a scene on so many, `launch` is the command before their number.
# root may run them, more ranks than cores too; without threads of BLAS
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_btl_vader_single_copy_mechanism=none
export OMPI_MCA_rmaps_base_oversubscribe=1 OMP_NUM_THREADS=1
# without a look for fast networks (0.2 s a run); not bound to the cores that another test is bound to
export OMPI_MCA_pml=ob1 OMPI_MCA_hwloc_base_binding_policy=none
launch=(mpirun --oversubscribe)
# A rank that waits for another one asks again and again and gives way in between, which beside other work still costs it a slice of time, some
# milliseconds, at every message. Here it sleeps for a moment instead: a third of the time where ranks are more than cores.
printf '#include <time.h>\nint sched_yield (void) { struct timespec t = { 0, 1000 }; return nanosleep (&t, 0); }\n' > "$work/sleep.c"
case $mpi in
    *asan*|*tsan*) ;;                                  # their own library wants to be the first
    *) ${CC:-gcc} -shared -fPIC -o "$work/sleep.so" "$work/sleep.c" 2> /dev/null && launch+=(-x LD_PRELOAD="$work/sleep.so") ;;
esac
bare=(--set 'output.pictures=[]' --set 'output.views=[]')                              # ranks draw none
ranks() { local n=$1; shift; timeout 300 "${launch[@]}" -n "$n" "$mpi" run "$@" "${bare[@]}" --quiet > "$work/out" 2> "$work/err"; }
