#!/bin/bash
# test_parts.sh BUILD: while the run of several ranks goes on, and when it was ended from outside, result.e lies in parts: each says what programs
# that read the parallel form of Exodus (Nemesis) need, and perigal plot and perigal compare read them as one.
. "$(dirname "$0")/ranks.sh"
# a row every 10 steps, fields every 20: so many that the run has not ended by itself before it is ended, and as many as are compared
long=(--set solver.time_steps=60000 --set output.at.rows=6000 --set output.at.levels=3000)
first=(--set solver.time_steps=200 --set output.at.rows=20 --set output.at.levels=10)

# ended DIR: the run begins, and is ended when some fields have been written
ended() {
    timeout 120 "${launch[@]}" -n 3 "$mpi" run plate.yaml -o "$1" --quiet "${bare[@]}" "${long[@]}" > "$work/out" 2> "$work/err" &
    local pid=$! k
    for k in $(seq 400); do
        [ "$(wc -l 2> /dev/null < "$1/history.csv" || echo 0)" -gt 20 ] && break
        sleep 0.1
    done
    kill -TERM $pid; wait $pid 2> /dev/null
    [ -s "$1/result.e.3.0" ] && [ -s "$1/result.e.3.2" ] && [ ! -e "$1/result.e" ]
}
ended "$work/some"; verdict "a run that was ended leaves parts" $?
cp -r "$work/some" "$work/less"; cp -r "$work/some" "$work/other"

for r in 0 1 2; do python3 -S fields.py --variables "$work/some/result.e.3.$r" > "$work/variables" && grep -q '^node_num_map [0-9]*$' "$work/variables" \
    && grep -q '^elem_num_map' "$work/variables" && grep -q '^nem_ftype$' "$work/variables" && grep -q '^node_mapi' "$work/variables"; done
verdict "parts have what Nemesis asks for" $?
python3 - "$work/some" > "$work/why" 2>&1 << 'PYTHON'
import sys
from fields import File
parts = [File(f'{sys.argv[1]}/result.e.3.{r}') for r in range(3)]
numbers = [n for p in parts for n in p.values('node_num_map')]
length = [dict(p.dimensions) for p in parts]
assert len(set(numbers)) == len(numbers) == length[0]['num_nodes_global'] == length[0]['num_elems_global'], len(numbers)
for p, d in zip(parts, length):
    assert d['num_processors'] == 3 and d['num_procs_file'] == 1 and d['num_int_node'] == d['num_nodes'] == d['num_int_elem']
    assert p.values('nem_ftype')[0] == 0 and list(p.values('node_mapi')) == list(range(1, d['num_nodes'] + 1))
    assert sum(p.values('el_blk_cnt_global')) == d['num_elems_global'] and list(p.values('el_blk_ids_global')) == list(p.values('eb_prop1'))
    assert sorted(p.values('elem_num_map')) == sorted(p.values('node_num_map'))
PYTHON
verdict "every point is on one part, under its number" $?

"$perigal" plot "$work/some" --list > "$work/out" 2> "$work/err" && [ "$(wc -l < "$work/out")" -ge 5 ]; verdict "perigal plot lists the steps of the parts" $?
"$perigal" plot "$work/some" > "$work/out" 2> "$work/err" && [ -s "$work/some/damage.png" ]; verdict "perigal plot draws the body of all parts" $?
alone plate.yaml -o "$work/one" "${first[@]}"; verdict "the run of one process" $?
"$perigal" compare "$work/one" "$work/other" --step 4 --reference-step 4 > "$work/out" 2> "$work/err" \
    && grep -q "displacement: L2 0.000e+00" "$work/out"; verdict "perigal compare reads the parts as a reference" $?
"$perigal" compare "$work/some" "$work/one" --step 4 --reference-step 4 > "$work/out" 2> "$work/err" \
    && grep -q "displacement: L2 0.000e+00" "$work/out"; verdict "and the other way round" $?
rm "$work/less/result.e.3.1"
"$perigal" plot "$work/less" > "$work/out" 2> "$work/err"; [ $? -eq 70 ] && grep -q "result.e.3.1 is missing" "$work/err"
verdict "a missing part is named" $?

# parts that are to stay
alone plate.yaml -o "$work/one" --force --set solver.time_steps=40
ranks 2 plate.yaml -o "$work/kept" --set solver.time_steps=40 --set output.join=no && [ ! -e "$work/kept/result.e" ] \
    && [ -s "$work/kept/result.e.2.1" ] && grep -q '"outcome": "done"' "$work/kept/report.json"; verdict "parts that are to stay do so" $?
cp -r "$work/kept" "$work/again"
"$perigal" compare "$work/one" "$work/kept" > "$work/out" 2> "$work/err" && grep -q "displacement: L2 0.000e+00" "$work/out"
verdict "as a reference they are the whole" $?
"$perigal" compare "$work/again" "$work/one" > "$work/out" 2> "$work/err" && grep -q "displacement: L2 0.000e+00" "$work/out"
verdict "and as a result" $?

# two materials, one of which a part has nothing of
two=(--set 'materials={steel: {youngs_modulus: 192 GPa, poissons_ratio: 0.333333333333, density: 8000 kg/m3}, lead: {youngs_modulus: 16 GPa, poissons_ratio: 0.333333333333, density: 11000 kg/m3}}'
     --set 'blocks=[{material: steel, where: "x < 0.02"}, {material: lead, where: "x >= 0.02"}]' --set solver.time_steps=40)
alone plate.yaml -o "$work/one" --force "${two[@]}" && ranks 4 plate.yaml -o "$work/two" "${two[@]}" && python3 -S fields.py 1e-9 "$work/one/result.e" "$work/two/result.e" > "$work/why" 2>&1
verdict "a rank without a point of a material" $?
finish
