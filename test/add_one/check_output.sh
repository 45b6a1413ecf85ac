# ---- io/output/plain.c ----
listed plain "result.txt: the largest value of each field"
offered output.format plain
levels=(--threads 1 --set output.format=plain --set output.at.levels=4 --set solver.stepping=fixed --set solver.steps=4)
expect "a run with it"                         0 'results in [^ ]*: result.txt history.csv' '*' run plate.yaml -o "$work/text" "${levels[@]}"
[ "$(cut -d' ' -f1,2,3 "$work/text/result.txt" | xargs)" = "0 0.25 displacement 1 0.5 displacement 2 0.75 displacement 3 1 displacement" ]; verdict "result.txt: a line a level" $?
[ ! -e "$work/text/result.e" ]; verdict "no other file of fields" $?
many=(--threads 1 --quiet --set output.format=plain --set output.at.levels=300 --set solver.stepping=fixed --set solver.steps=300)
"$perigal" run plate.yaml -o "$work/text" "${many[@]}" --force > "$work/out" 2> "$work/err" & run=$!
for k in $(seq 1000); do [ "$(wc -l 2> /dev/null < "$work/text/result.txt" || echo 0)" -gt 20 ] && break; sleep 0.01; done
kill -TERM $run; wait $run; [ $? -eq 130 ] && [ -e "$work/text/checkpoint.nc" ]; verdict "a run that is interrupted" $?
expect "it goes on"                            0 '*' '*' run plate.yaml -o "$work/text" "${many[@]}" --resume
expect "a run that nobody disturbs"            0 '*' '*' run plate.yaml -o "$work/same" "${many[@]}"
[ "$(wc -l < "$work/same/result.txt")" -eq 300 ] && cmp "$work/same/result.txt" "$work/text/result.txt"; verdict "the same lines, none twice" $?
expect "another format in its folder"          0 '*' '*' run plate.yaml -o "$work/text" "${levels[@]}" --force --set output.format=vtk
[ -e "$work/text/result.pvd" ] && [ ! -e "$work/text/result.txt" ]; verdict "leaves nothing of it" $?
expect "ranks that divide the body refuse it" 65 '' 'output.format = plain: ranks that divide the body cannot write it' \
       check plate.yaml --ranks 2 --set output.format=plain --set 'method={force: bond, horizon: 3 spacing, accept_inexact: yes}' \
       --set 'solver={kind: verlet, end: 1 us}' --set 'initial={velocity: {x: 1 m/s}}' --set 'boundary=[]' --set 'cracks=[]'
expect "a misspelt format is told its name"   65 '' 'must be one of exodus, vtk, plain; did you mean plain?' check plate.yaml --set output.format=plane
