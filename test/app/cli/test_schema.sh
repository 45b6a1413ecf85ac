#!/bin/bash
# test_schema.sh BUILD: the JSON schema of scenes: every scene of data/ fits it, as the program itself reads it; wrong keys, choices and shapes
# do not. The completion of the shell knows commands, options, keys.
. "$(dirname "$0")/expect.sh"
cd "$(dirname "$0")/../../.." || exit 1
"$perigal" help --schema > "$work/schema.json" 2> "$work/err" && python3 -m json.tool "$work/schema.json" > /dev/null 2>> "$work/err"
verdict "the schema is JSON" $?
scenes=(data/*/scene*.yaml data/new/*/scene.yaml)
echoed() { echo "$work/${1//\//,}.json"; }
for scene in "${scenes[@]}"; do "$perigal" check "$scene" --echo > "$(echoed "$scene")" 2>> "$work/err"; done
python3 test/app/cli/validate.py "$work/schema.json" "$work"/data,*.json > "$work/out" 2>> "$work/err"
for scene in "${scenes[@]}"; do grep -qxF "$(echoed "$scene"): fits" "$work/out"; verdict "$scene fits" $?; done
scene=data/disk_crack/scene.yaml
"$perigal" check $scene --echo > "$work/good.json"
wrong() {   # name, change of the scene in Python, what validate.py says
    python3 -c "import json; s = json.load (open ('$work/good.json')); $2; json.dump (s, open ('$work/scene.json', 'w'))"
    python3 test/app/cli/validate.py "$work/schema.json" "$work/scene.json" > "$work/out" 2> "$work/err"
    [ $? -eq 1 ] && grep -qF -- "$3" "$work/out"; verdict "$1" $?
}
wrong 'a wrong key' "s['spacng'] = 1" '.spacng: unknown key'
wrong 'a wrong key in a list' "s['cracks'][0]['form'] = [0, 0]" '.cracks[0].form: unknown key'
wrong 'a wrong choice' "s['plane'] = 'stres'" "'stres' is none of"
wrong 'a list for a number' "s['thickness'] = [1]" '.thickness: [1] is no number or string'
wrong 'a wrong key below a name' "s['materials']['rock']['young'] = 1" '.materials.rock.young: unknown key'
wrong 'a dimension that is none' "s['dimension'] = 4" '4 is none of [1, 2, 3]'
# ---- completion ----------------------------------------------------------------------------------------------------------------
.ci/completion "$perigal" > "$work/completion" && bash -n "$work/completion"; verdict "the completion is a script" $?
complete_words() {   # words of the line, the last one unfinished: what could stand there
    bash -c '. "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _perigal; printf "%s\n" "${COMPREPLY[@]}"' - "$work/completion" "$@" > "$work/out" 2> "$work/err"
}
offers() { local name=$1 word=$2; shift 2; complete_words "$@"; grep -qxF -- "$word" "$work/out"; verdict "$name" $?; }
offers 'a command' converge perigal co
offers 'an option' --resume perigal run --re
offers 'a kind' explicit perigal new e
offers 'a key of --set' method.horizon= "$perigal" run scene.yaml --set method.hor
offers 'a key of help' failure.fracture_energy "$perigal" help failure.fr
offers 'a command of help' bench perigal help be
complete_words perigal run --spectr; [ ! -s "$work/out" ] || ! grep -q spectrum "$work/out"; verdict 'no option of another command' $?
finish
