#!/bin/bash
# test_messages.sh BUILD: src/app/mpi/messages.c alone, on 3 and 4 processes: sums, maxima, ghosts, lists; see messages_check.c
. "$(dirname "$0")/ranks.sh"
case $mpi in *asan*) sane=-fsanitize=address,undefined ;; *tsan*) sane=-fsanitize=thread ;; *) sane= ;; esac
${CC:-gcc} -std=c17 -D_POSIX_C_SOURCE=200809L -O1 -w $sane -I../../include -I../../src $(pkg-config --cflags mpi) messages_check.c ../../src/app/mpi/messages.c \
    "$(dirname "$mpi")/libperigal.a" $(pkg-config --libs mpi) -lm -lpthread -ldl -o "$work/check" > "$work/why" 2>&1
verdict "it is built" $?
for r in 3 4; do
    timeout 60 "${launch[@]}" -n "$r" "$work/check" > "$work/why" 2>&1; verdict "$r processes" $?
done
finish
