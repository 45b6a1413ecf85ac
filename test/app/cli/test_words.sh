#!/bin/bash
# test_words.sh BUILD: what a user reads is true and leads on: warnings, progress, faults that come together, hints.
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")" || exit 1
once=(--threads 1 --set solver.max_events=1 --set output.pictures='[]')
# holds NAME FILE PATTERN: is the pattern there?
holds() { local good=1; grep -q -- "$3" "$2" && good=0; verdict "$1" $good; [ $good -eq 0 ] || sed 's/^/# /' "$2" | head -30; }

# ---- warnings are of the run, not of the screen -----------------------------------------------------------------------------
loose=(--set 'boundary[1].displacement={y: 0}' --set 'method={force: bond}' --set 'failure={criterion: stretch, critical_stretch: 1e-3}')
loose+=(--set 'boundary[0].essential=penalty' --set spacing='0.5 mm')
expect "a quiet run prints warnings only"       0 '' 'warning: nothing holds the body along x' run plate.yaml --quiet -o "$work/loose" "${once[@]}" "${loose[@]}"
holds "report.json: nothing holds the body"     "$work/loose/report.json" '"nothing holds the body along x: '
holds "report.json: another Poisson's ratio"    "$work/loose/report.json" "^ *\"material glass: Poisson's ratio is 0.3333, not 0.22"
holds "report.json: keys that are ignored"       "$work/loose/report.json" '"ignored with force: bond: boundary\[0\].essential'
python3 -c "import json, sys; w = json.load (open (sys.argv[1]))['warnings']; sys.exit (len (w) < 3 or len (set (w)) != len (w))" "$work/loose/report.json"
verdict "each of them once" $?
"$perigal" check plate.yaml --json "${loose[@]}" > "$work/out" 2> "$work/err"
python3 -c "import json, sys; r = json.load (open (sys.argv[1])); sys.exit (len (r['warnings']) != 4 or len (r['notes']) < 1)" "$work/out"
verdict "check --json has them too" $?
"$perigal" run plate.yaml -o "$work/loud" "${once[@]}" "${loose[@]}" > "$work/out" 2> "$work/err"
[ "$(grep -c 'warning: nothing holds the body along x' "$work/out")" -eq 1 ]; verdict "on the screen each comes once" $?

# ---- progress ---------------------------------------------------------------------------------------------------------------
# Without a terminal: a line each tenth of the nearest end, which is named; event stepping counts events.
"$perigal" run plate.yaml -o "$work/events" --threads 1 --set solver.max_events=20 > "$work/out" 2> "$work/err"
[ "$(grep -c ' % of max_events, [0-9]* event' "$work/err")" -ge 6 ]; verdict "progress goes on after the peak of the load" $?
holds "it ends at its end" "$work/err" '^100.0 % of max_events, 20 events.*, load factor .*, stiffness .* of the initial one, .* bonds broken, residual'
"$perigal" run plate.yaml -o "$work/load" --threads 1 --set failure='{criterion: none}' > "$work/out" 2> "$work/err"
holds "event stepping without a break: the load" "$work/err" '^ 50.0 % of the load, 0 events, load factor 0.5'
"$perigal" run plate.yaml -o "$work/stop" --threads 1 --set 'solver.stop={set: right, damage: 20 %}' > "$work/out" 2> "$work/err"
holds "event stepping to a damage: that damage" "$work/err" '^100.0 % of stop.damage, [0-9]* events.*, damage in stop.set 0\.2'
"$perigal" run plate.yaml -o "$work/fixed" --threads 1 --set solver='{kind: static, stepping: fixed, steps: 10}' --set failure='{criterion: none}' > "$work/out" 2> "$work/err"
holds "fixed steps: the steps" "$work/err" '^ 50.0 %, step 5, load factor 0.5'
"$perigal" run bonds.yaml -o "$work/verlet" --threads 1 > "$work/out" 2> "$work/err"
holds "time steps: the steps and the time" "$work/err" '^ 60.[0-9] %, step [0-9]*, 0.00012[0-9]* s, '
# On a terminal of 60 columns no line is longer, so that each rewrites the one before.
python3 - "$perigal" "$work" > "$work/out" 2> "$work/err" <<'END'
import fcntl, os, pty, re, struct, sys, termios
pid, fd = pty.fork ()
if pid == 0:
    os.read (0, 1)                                     # the size is set
    null = os.open (os.devnull, os.O_WRONLY)
    os.dup2 (null, 1)
    os.execv (sys.argv[1], [sys.argv[1], 'run', 'plate.yaml', '-o', sys.argv[2] + '/tty', '--threads', '1', '--set', 'spacing=0.2 mm', '--set', 'solver.max_events=300'])
fcntl.ioctl (fd, termios.TIOCSWINSZ, struct.pack ('HHHH', 24, 60, 0, 0))
os.write (fd, b'\n')
text = b''
try:
    while True:
        more = os.read (fd, 65536)
        if not more: break
        text += more
except OSError: pass
os.waitpid (pid, 0)
shown = [line.split ('\033')[0] for line in text.decode ().split ('\r') if ' %' in line]
print (*shown, sep='\n')
sys.exit (not shown or max (map (len, shown)) > 59 or not any (re.search (r'% of .*, [0-9]+ events', line) for line in shown))
END
verdict "on a terminal progress fits one line" $?

# ---- steps of a result --------------------------------------------------------------------------------------------------------
"$perigal" plot "$work/events" --list > "$work/events.list" 2> "$work/err"; cp "$work/events.list" "$work/out"
last=$(awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) { if ($i ~ /^event /) e = i; if ($i ~ /^load_factor /) f = i } } NR > 1 { n += $e; at = sprintf ("event %d, load factor %.4g", n, $f) } END { print at }' "$work/events/history.csv")
[ "$(tail -1 "$work/out" | sed 's/^ *[0-9]* *//')" = "$last" ] && [[ $last == "event 20,"* ]]; verdict "steps are called by event and load factor ($last)" $?
expect "steps are counted from the end too"      0 '/last.png' '' plot "$work/events" --step -1 --out "$work/last.png"
"$perigal" plot "$work/events" --step -2 --out "$work/a.png" > "$work/out" 2> "$work/err" && "$perigal" plot "$work/events" --step "$(($(tail -1 "$work/events.list" | awk '{ print $1 }') - 1))" --out "$work/b.png" >> "$work/out" 2>> "$work/err" && cmp "$work/a.png" "$work/b.png" >> "$work/err" 2>&1
verdict "step -2 is the last but one" $?
expect "a step that is not there: which are"    64 '' 'has no step 99; its steps are 0 to [0-9]* (-1 is the last; perigal plot .* --list' plot "$work/events" --steps 1,99

# ---- help -------------------------------------------------------------------------------------------------------------------
"$perigal" help friction_angle > "$work/out" 2> "$work/err"
[ "$(grep -c '^  unit     rad' "$work/out")" -eq 2 ] && [ "$(grep -c '^  range    ' "$work/out")" -eq 2 ] && [ "$(grep -c '^  default  ' "$work/out")" -eq 2 ]
verdict "help KEY tells all of a key, in each of its places" $?

# ---- a value that lost its quotes --------------------------------------------------------------------------------------------
expect "--set KEY=VALUE without quotes"         64 '' "'mm' is not a file: a value with blanks needs quotes: --set 'spacing=4 mm'" check plate.yaml --set spacing=4 mm
expect "the same before the scene"              64 '' "quotes: --set 'spacing=4 mm'" check --set spacing=4 mm plate.yaml
expect "a map without quotes"                   64 '' "quotes: --set 'failure={criterion: none}'" run plate.yaml -s failure={criterion: none} -o "$work/none"
expect "converge says it too"                   64 '' "quotes: --set 'spacing=4 mm'" converge plate.yaml --set spacing=4 mm
expect "a scene that is not there is no value"  65 '' '^nowhere.yaml: cannot be opened' check --set spacing=4 nowhere.yaml
expect "an option of nothing"                   64 '' 'unknown option --verson (did you mean --version?)' --verson
expect "a misspelt option of run"               64 '' 'unknown option --reume (did you mean --resume?)' run plate.yaml --reume
expect "help of a misspelt command"             64 '' 'or the command run?' help runn
finish
