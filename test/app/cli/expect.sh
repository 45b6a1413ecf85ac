# expect.sh BUILD, for test_*.sh to read before they go elsewhere: the program as $perigal, a folder $work of the test's own, checks that
# print TAP. At the end of a test: finish.
perigal=$(realpath "$1/perigal"); n=0; bad=0
work=$(mktemp -d); trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
verdict() {   # name, 0 for good; $latest: its name
    n=$((n + 1)); latest=$1
    if [ "$2" -eq 0 ]; then echo "ok $n - $1"; return; fi
    bad=1; echo "not ok $n - $1"; sed 's/^/# /' "$work/out" "$work/err" "$work/why" 2> /dev/null | head -40
}
# expect NAME CODE PATTERN-OF-STDOUT PATTERN-OF-STDERR ARGUMENTS...: an empty pattern wants an empty stream, '*' anything
expect() {
    local name=$1 code=$2 out=$3 err=$4 k good=0; shift 4
    "$perigal" "$@" > "$work/out" 2> "$work/err"; k=$?
    [ $k -eq "$code" ] || good=1
    matches "$out" "$work/out" && matches "$err" "$work/err" || good=1
    verdict "$name" $good
}
matches() {
    if [ -z "$1" ]; then [ ! -s "$2" ]; elif [ "$1" = '*' ]; then true; else grep -q -- "$1" "$2"; fi
}
finish() { echo "1..$n"; exit $bad; }
