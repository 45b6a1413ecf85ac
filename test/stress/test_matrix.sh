#!/bin/bash
# test_matrix.sh BUILD: a sample of the matrix of conditions and methods (make stress), a check a condition; none may be wrong without a word.
# PERIGAL_TEST_SIZE=short takes a cell of each condition and of each method at least, long (make test-full) 2500.
build=$1
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
# python of the system: a plain python3 on the path may be a slow wrapper
python=/usr/bin/python3; [ -x "$python" ] || python=python3
TAP=1 OUT=$out KEEP= ONLY= "$python" "$(dirname "$0")/run" "$build" "${PERIGAL_TEST_SIZE:-short}" 1
