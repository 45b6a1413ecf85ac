#!/bin/bash
# test_combinations.sh BUILD: every combination of force, solver, dimension, criterion, contact and processes that ran before runs (table.txt beside this file, made by
# run BUILD > table.txt). PERIGAL_TEST_SIZE=short takes every 27th, long all.
here=$(dirname "$0"); part=5/27; [ "$PERIGAL_TEST_SIZE" = long ] && part=1/1
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
python=/usr/bin/python3; [ -x "$python" ] || python=python3
said=$("$python" "$here/run" "$1" PART=$part JOBS=1 AGAINST="$here/table.txt" OUT="$work/rows.csv"); code=$?
sed 's/^/# /' <<< "$said"
[ $code -eq 0 ] && grep -q '^[1-9][0-9]* run, ' <<< "$said" && echo "ok 1 - what ran runs" || { echo "not ok 1 - what ran runs"; code=1; }
echo "1..1"; exit $code
