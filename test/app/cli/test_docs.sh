#!/bin/bash
# test_docs.sh BUILD: documents agree with the tree: links, files and functions they name, keys of the scene, commands of README.md.
perigal=$(realpath "$1/perigal"); n=0; bad=0
cd "$(dirname "$0")/../../.." || exit 1
pages=(README.md doc/*.md data/*/README.md matlab-compat/README.md)
report() {   # name, faults (one a line)
    n=$((n + 1))
    if [ -z "$2" ]; then echo "ok $n - $1"; else bad=1; echo "not ok $n - $1"; sed 's/^/# /' <<< "$2"; fi
}
report "every link leads to a file" "$(for page in "${pages[@]}"; do
    grep -oE '\]\([^)# ]+' "$page" | sed 's/^](//' | grep -v '^http' | while read -r to; do [ -e "$(dirname "$page")/$to" ] || echo "$page: $to"; done; done)"
report "doc/input.md is what the program prints (make doc)" "$("$perigal" help --manual | diff doc/input.md - | head -20)"
report "files named by doc/method.md exist" "$(grep -oE '`([a-z_]+/)+[a-z0-9_]+\.[ch]`' doc/method.md | tr -d '\`' | sort -u |
    while read -r f; do [ -e "src/$f" ] || [ -e "$f" ] || echo "$f"; done)"
report "files named by doc/notation.md, accuracy.md, architecture.md and testing.md exist" "$(cat doc/notation.md doc/accuracy*.md doc/architecture.md doc/testing.md |
    grep -oE '`([a-z_]+/)+[a-z0-9_]+\.[ch]`' | tr -d '\`' | sort -u |
    while read -r f; do [ -e "src/$f" ] || [ -e "$f" ] || echo "$f"; done)"
report "functions named by doc/method.md exist" "$(grep -oE '`([a-z_]+/)+[a-z0-9_]+\.c` (`[a-zA-Z_]+`(, )?)+' doc/method.md | while read -r line; do
    file=src/$(cut -d'`' -f2 <<< "$line"); for f in $(cut -d' ' -f2- <<< "$line" | tr -d '`,'); do grep -qE "(^| |\*)$f \(" "$file" || echo "$file: $f"; done; done)"
report "headings cited as 'theory X' exist" "$(grep -rhoE 'theory [A-H][0-9][a-z]?' src include | sort -u |
    while read -r _ key; do grep -q "^## $key " doc/method.md || echo "$key"; done)"
report "folders of doc/architecture.md are those of src, in the order of make lint" "$(diff <(grep -oE '^\| `[a-z_/]+` \|' doc/architecture.md | tr -d '|` ') \
    <(make -s --no-print-directory print-ORDER | tr ' ' '\n' | while read -r folder; do ! compgen -G "src/$folder/*.[ch]" > /dev/null || echo "$folder"; done))"
# With PERIGAL_TEST_SIZE=long as they stand. In short size scene.yaml on the widest lattice that suits it, if one does (test_check.sh has some of those of
# plans/ as they stand); of others and of its variants scene_NAME.yaml all that is known before a body is built, which memory for none ends.
. test/app/cli/coarse.sh
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT
right_in_short() {
    [[ $1 = */scene.yaml ]] && wider "$1" "$widest" -q || known "$1" -q
}
right() { [ "$PERIGAL_TEST_SIZE" != long ] && right_in_short "$1" || "$perigal" check "$1" -q 2>&1 > /dev/null; }
report "every scene of data/ is right" "$(for s in data/*/scene*.yaml; do right "$s"; done)"
report "every scene of data/ has a README" "$(for s in data/*/; do [ -e "$s/README.md" ] || echo "$s"; done)"
report "the scene in README.md is the one of the demo" "$(diff <(sed -n '/^```yaml/,/^```/p' README.md | grep -v '^```' | sed 's/  *#.*//') \
    <(grep -v '^#' data/disk_crack/scene.yaml | sed 's/  *#.*//'))"
report "keys of report.json are those of doc/output.md" "$(for key in $(grep -oE 'pg_json_[a-z]+ \(j, "[a-z_0-9]+"' src/app/results/json.c | cut -d'"' -f2); do
    grep -q "\b$key\b" doc/output.md || echo "$key"; done)"
echo "1..$n"
exit $bad
