#!/bin/bash
# test_golden.sh BUILD: every scene of wrong/ is refused with exit code 65 and exactly the message beside it (NAME.txt).
# After a deliberate change of a message: test/cli/test_golden.sh BUILD --accept, and read the differences.
perigal=$(realpath "$1/perigal"); accept=$2; n=0; bad=0
cd "$(dirname "$0")/wrong" || exit 1
for scene in *.yaml; do
    name=${scene%.yaml}; n=$((n + 1))
    message=$("$perigal" check "$scene" 2>&1 > /dev/null); code=$?
    [ "$accept" = --accept ] && printf '%s\n' "$message" > "$name.txt"
    if [ $code -eq 65 ] && [ "$message" = "$(cat "$name.txt" 2> /dev/null)" ]; then echo "ok $n - $name"
    else
        bad=1; echo "not ok $n - $name (exit code $code)"
        diff <(cat "$name.txt" 2> /dev/null) <(printf '%s\n' "$message") | sed 's/^/# /'
    fi
done
echo "1..$n"
exit $bad
