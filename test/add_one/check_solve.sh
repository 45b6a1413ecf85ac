# ---- solve/geometric.c ----
listed geometric "quasi-static equilibria at load factors"
offered solver.kind geometric
key solver.ratio "(geometric) Share of the load that is left"
grep -F '| `solver.tolerance` |' "$work/manual" | grep -q '(static, newmark, geometric)'; verdict "the manual: keys that it shares name it" $?
ratio=(--set 'solver={kind: geometric, ratio: 0.5}' --set output.at.levels=4)
expect "a run with it"                         0 ' 4 steps' '*' run plate.yaml -o "$work/geometric" --threads 1 "${ratio[@]}"
cut -d, -f2 "$work/geometric/history.csv" > "$work/factors"
grep -q '^0.875' "$work/factors" || grep -q ',0.875' "$work/geometric/history.csv"; verdict "its load factors" $?
expect "a run in which bonds break"            0 ' [1-9][0-9]* bonds broken' '*' run plate.yaml -o "$work/broke" --threads 1 "${ratio[@]}" --set 'failure={criterion: stretch, critical_stretch: 1e-3}'
expect "a key of another solver is noted"      0 'solver.kind: geometric, in solver: .*stages' '*' check plate.yaml "${ratio[@]}" --set solver.stages=3
expect "its key with another solver is noted"  0 'solver.kind: static, in solver: ratio' '*' check plate.yaml --set solver.ratio=0.5
expect "its key out of range"                 65 '' 'solver.ratio = 2: must lie in (0, 1)' check plate.yaml "${ratio[@]}" --set solver.ratio=2
expect "what goes with stages alone"          65 '' 'solver.break = passing: passing goes with solver.kind: adr, relax' check plate.yaml "${ratio[@]}" --set solver.break=passing
expect "a force that is not linear"           65 '' 'solver.kind = geometric: method.stretch: finite .* or solver.kind: verlet, central, adr, relax' \
       check plate.yaml "${ratio[@]}" --set 'method={force: bond, stretch: finite}'
