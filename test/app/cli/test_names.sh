#!/bin/bash
# test_names.sh: what a newcomer looks for is found by file name: each row of "Where is ...?" in doc/architecture.md, "| what | `*pattern*` | `file` | ...", must
# find its file with find src -name.
cd "$(dirname "$0")/../../.." || exit 1
n=0; bad=0
while IFS='|' read -r _ what pattern file _; do
    what=$(sed 's,^ *,,; s, *$,,' <<< "$what"); pattern=$(tr -d ' `' <<< "$pattern"); file=$(tr -d ' `' <<< "$file")
    n=$((n + 1))
    if find src -name "$pattern" | grep -qx "src/$file"; then echo "ok $n - $what: $pattern"
    else bad=1; echo "not ok $n - $what: find src -name '$pattern' does not find src/$file"; fi
done < <(grep -E '^\| [^|]* \| `\*[^|]*\*` \| `([a-z_]+/)+[a-z_0-9]+\.[ch]` \|' doc/architecture.md)
n=$((n + 1))
if [ $n -ge 21 ]; then echo "ok $n - at least 20 names"; else bad=1; echo "not ok $n - only $((n - 1)) rows"; fi
echo "1..$n"
exit $bad
