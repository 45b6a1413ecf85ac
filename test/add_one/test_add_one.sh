#!/bin/bash
# test_add_one.sh BUILD: a kernel, a criterion, a material, a solver, a force, a writer: each is one file (in a folder of the name of its catalogue here) and one line of
# list.h, and then the program knows it everywhere: in its lists, its help, its messages, its manual, its runs.
tree=$(dirname "$0")/../..
program=$("$(dirname "$0")/build" "$1") || { echo "not ok 1 - a program with the entries of test/add_one is built"; exit 1; }
. "$tree/test/app/cli/expect.sh" "$program"
cd "$(dirname "$0")" || exit 1
verdict "a program with one file and one line more for each entry is built" 0
"$perigal" list > "$work/list"; "$perigal" help --manual > "$work/manual"
# listed NAME SUMMARY: perigal list names it with its summary; offered KEY NAME: the manual has it among the choices of the key
listed()  { grep -q "^  $1  *$2" "$work/list"; verdict "perigal list: $1" $?; }
offered() { grep -F "| \`$1\` |" "$work/manual" | grep -q "\`$2\`"; verdict "the manual: $1: $2" $?; }
# key PATH WORDS: a key of its own stands in the manual, with these words
key()     { grep -F "| \`$1\` |" "$work/manual" | grep -q -- "$2"; verdict "the manual: $1" $?; }
once=(--threads 1 --set solver.max_events=3)

for part in kernel criterion material solve force output; do
    if [ -e "check_$part.sh" ]; then . "./check_$part.sh"; fi
done
finish
