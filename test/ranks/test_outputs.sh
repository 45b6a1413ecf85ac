#!/bin/bash
# test_outputs.sh BUILD: all that an explicit run can be asked for is the same from any number of ranks: gauges, averages, lengths of cracks, loose
# parts, energies, every field, what a report counts; materials and limits that vary over the body.
. "$(dirname "$0")/ranks.sh"

# counted DIR: what a report says, without what depends on the machine or on rounding
counted() {
    python3 - "$1/report.json" <<'PYTHON'
import json, sys
report = json.load(open(sys.argv[1]), parse_float=lambda text: f'{float(text):.9g}')
for key in 'seconds peak_bytes ranks division parts skipped patch patch_error notes warnings energy curve new_crack overlap_max'.split():
    report.pop(key, None)
for key in 'points bonds dofs evaluation_points eroded_points isolated_nodes fragments steps events broken tips'.split():
    assert key in report, key
# what is left unbalanced is rounding
balance = report.pop('balance')
assert balance['states'] > 0 and max(float(balance[key]) for key in ('forces', 'moments') if key in balance) < 1e-10, balance
print(json.dumps(report, indent=1, sort_keys=True))
warnings = [w for w in json.load(open(sys.argv[1]))['warnings'] if 'uniform stress' not in w]   # that of the patch test
print('\n'.join(warnings))
PYTHON
}
equal() {
    local name=$1 numbers=$2 r; shift 2
    alone outputs.yaml -o "$work/one" --force "$@"; verdict "$name: one process" $?
    [ "$(wc -l < "$work/one/events.csv")" -gt 100 ]; verdict "$name: something breaks" $?
    for r in $numbers; do
        rm -rf "$work/some"
        ranks "$r" outputs.yaml -o "$work/some" "$@" && alike 1e-9 "$work/one" "$work/some" events.csv
        verdict "$name: the same bonds on $r ranks" $?
        alike 1e-9 "$work/one" "$work/some" history.csv; verdict "$name: the same rows on $r ranks" $?
        python3 -S fields.py 1e-9 "$work/one/result.e" "$work/some/result.e" > "$work/why" 2>&1
        verdict "$name: the same fields on $r ranks" $?
        counted "$work/one" > "$work/counted" && counted "$work/some" | diff "$work/counted" - > "$work/why" 2>&1
        verdict "$name: the same report on $r ranks" $?
    done
}
long() { [ "$PERIGAL_TEST_SIZE" = long ]; }
some=3 all=2
[ "$PERIGAL_TEST_SIZE" = long ] && some='2 3 4 8' all=$some
equal "bond" "$all"
grep -q '"fragments": 1' "$work/one/report.json"; verdict "the crack through the body leaves a part" $?
grep -q '"isolated_nodes": 1[0-9]' "$work/one/report.json"; verdict "points are alone" $?
grep -q 'cut the body into 2 parts: 440 of its 1808 points' "$work/some/report.json"; verdict "the warning of two parts counts all points" $?
long && equal "lps" "$some" --set method.force=lps --set materials.steel.poissons_ratio=0.25
long && equal "gmpd" "$some" --set method.force=gmpd --set materials.steel.poissons_ratio=0.2 \
      --set 'failure={criterion: beam_limits, fracture_energy: 2 kJ/m2}'
equal "points that fail by their energy" "$some" --set 'failure={criterion: node_energy, fracture_energy: 2 kJ/m2}'
equal "a limit that varies" "$some" --set 'failure={criterion: stretch, critical_stretch: "0.006 * (1 + 10 * y / (1 m))"}'
equal "an end when a set is damaged" "$some" --set 'solver.stop={set: notch, damage: 5 %}'
[ "$(wc -l < "$work/one/history.csv")" -lt 41 ]; verdict "that run ends early" $?
finish
