# ---- mechanics/force/reinforced.c ----
listed reinforced "bond, stiffer by a factor"
offered method.force reinforced
key method.reinforcement "(reinforced) How much stiffer bonds are"
key method.evaluation "(bond, fcbm, lps, gmpd, reinforced)"
stiff=(--set 'method={force: reinforced, reinforcement: 2, horizon: 3 spacing, accept_inexact: yes}')
plain=(--set 'method={force: bond, horizon: 3 spacing, accept_inexact: yes}')
expect "a run with it"                        0 '*' '*' run plate.yaml -o "$work/stiff" "${once[@]}" "${stiff[@]}"
expect "the same plate without it"            0 '*' '*' run plate.yaml -o "$work/plain" "${once[@]}" "${plain[@]}"
python3 - "$work/stiff/history.csv" "$work/plain/history.csv" <<'END'
import csv, sys
a, b = (list (csv.reader (open (name))) for name in sys.argv[1:])
column = next (k for k, name in enumerate (a[0]) if name.startswith ('top.force_y'))
sys.exit (not abs (float (a[-1][column]) / float (b[-1][column]) - 2) < 1e-6)
END
verdict "bonds twice as stiff bear twice the force" $?
expect "the plan names it"                    0 'force reinforced, constant kernel' '*' check plate.yaml "${stiff[@]}"
expect "its key is required"                 65 '' 'method.reinforcement: is missing' check plate.yaml --set method.force=reinforced
expect "its key has a range"                 65 '' 'method.reinforcement = 0.5: must lie in \[1, inf)' \
       check plate.yaml "${stiff[@]}" --set method.reinforcement=0.5
expect "its key is ignored by another force"  0 'ignored with force: bond: reinforcement of method' '*' check plate.yaml "${plain[@]}" --set method.reinforcement=2
expect "keys of other forces are ignored"     0 'ignored with force: reinforced: beam of method' '*' check plate.yaml "${stiff[@]}" --set method.beam=chen
expect "a criterion that it cannot serve"    65 '' 'those of force: reinforced show only stretch: use stretch, or force: ' \
       check plate.yaml "${stiff[@]}" --set 'failure={criterion: principal_stress, tensile_strength: 1 MPa}'
expect "other forces name it where it helps" 65 '' 'not with force: galerkin so far: use bond, fcbm, lps, gmpd or reinforced' \
       check plate.yaml --set 'solver={kind: verlet, end: 1 us}' --set 'initial={velocity: {x: 1 m/s}}'
expect "no rotations"                        65 '' 'points of force: reinforced have no rotations, only those of force: gmpd' \
       check plate.yaml "${stiff[@]}" --set 'boundary[0]={set: top, moment: {z: 1 N m}}'
expect "an anisotropic material"             65 '' 'force: reinforced makes its bonds from .*use force: galerkin' \
       check plate.yaml "${stiff[@]}" --set 'materials.glass={model: cubic, stiffness_11: 160 GPa, stiffness_12: 60 GPa, stiffness_44: 80 GPa}'
