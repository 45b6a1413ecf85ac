#!/bin/bash
# test_golden.sh BUILD: every scene of wrong/ is refused by check with exit code 65 and exactly the message beside it (NAME.txt), and by run
# (every fourth scene; with PERIGAL_TEST_SIZE=long all) in the same words.
# After a deliberate change of a message: test/app/cli/test_golden.sh BUILD --accept, and read the differences.
perigal=$(realpath "$1/perigal"); accept=$2; n=0; bad=0
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT
every=4; [ "$PERIGAL_TEST_SIZE" = long ] && every=1
cd "$(dirname "$0")/wrong" || exit 1
for scene in *.yaml; do
    name=${scene%.yaml}; n=$((n + 1))
    message=$("$perigal" check "$scene" 2>&1 > /dev/null); code=$?
    [ "$accept" = --accept ] && printf '%s\n' "$message" > "$name.txt"
    if [ $((n % every)) -eq 0 ]; then
        again=$("$perigal" run "$scene" -o "$work/out" 2>&1 > /dev/null); started=$?
        [ $started -eq $code ] && [ "$again" = "$message" ] || { code="$code, of run $started"; message=$again; }
    fi
    if [ "$code" = 65 ] && [ "$message" = "$(cat "$name.txt" 2> /dev/null)" ]; then echo "ok $n - $name"
    else
        bad=1; echo "not ok $n - $name (exit code $code)"
        diff <(cat "$name.txt" 2> /dev/null) <(printf '%s\n' "$message") | sed 's/^/# /'
    fi
done
echo "1..$n"
exit $bad
