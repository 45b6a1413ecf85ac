#!/bin/bash
# test_install.sh BUILD: make install into a staging folder; a program compiled against it runs, with the shared and the static library.
build=$1; n=0; bad=0; root=$(realpath "$(dirname "$0")/../../.."); cd "$root" || exit 1
case $build in *asan*) echo "ok 1 - skipped: a sanitized library wants a sanitized program"; exit 0 ;; esac
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT
try() {   # name, command...
    local name=$1; shift; n=$((n + 1))
    if "$@" > "$work/log" 2>&1; then echo "ok $n - $name"; else bad=1; echo "not ok $n - $name"; sed 's/^/# /' "$work/log"; fi
}
try "install under DESTDIR" env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL make -s BUILD="$build" DESTDIR="$work/stage" prefix=/opt/perigal install
at=$work/stage/opt/perigal
export PKG_CONFIG_PATH=$at/lib/pkgconfig PKG_CONFIG_SYSROOT_DIR=$work/stage
try "pkg-config knows the prefix" grep -qx 'prefix=/opt/perigal' "$at/lib/pkgconfig/perigal.pc"
compile() { ${CC:-gcc} -std=c17 -Wall -Wextra -Werror test/app/cli/use_library.c -o "$work/$1" "${@:2}" -lm; }
try "compile, shared" compile shared $(pkg-config --cflags --libs perigal)
mkdir "$work/only" && cp "$at/lib/libperigal.a" "$work/only"
try "compile, static" compile static $(pkg-config --cflags perigal) -L"$work/only" $(pkg-config --static --libs perigal | sed "s|-L[^ ]*||")
export LD_LIBRARY_PATH=$at/lib
export OMP_THREAD_LIMIT=1 OPENBLAS_NUM_THREADS=1
try "shared library is used" bash -c 'ldd "$1" | grep -q "$2/lib/libperigal.so.0"' - "$work/shared" "$at"
try "static program needs no libperigal.so" bash -c '! ldd "$1" | grep -q libperigal' - "$work/static"
try "run, shared" bash -c '"$1" test/app/cli/plate.yaml > "$1.txt"' - "$work/shared"
try "run, static" bash -c '"$1" test/app/cli/plate.yaml > "$1.txt"' - "$work/static"
try "both say the same" cmp "$work/shared.txt" "$work/static.txt"
try "the answer is that of the scene" grep -q 'largest displacement 1\.0[0-9]*e-05 m' "$work/shared.txt"
try "installed program runs" "$at/bin/perigal" check test/app/cli/plate.yaml
try "documents are installed" test -s "$at/share/doc/perigal/README.md" -a -s "$at/share/doc/perigal/doc/input.md" -a -s "$at/share/doc/perigal/COPYING"
try "installed scenes are checked where they lie" "$at/bin/perigal" check "$at/share/perigal/scenes/kirsch_mesh/scene.yaml"
try "schema and completion are installed" bash -c 'python3 -m json.tool "$1/perigal/scene.schema.json" > /dev/null && bash -n "$1/bash-completion/completions/perigal"' - "$at/share"
try "functions for MATLAB and the Python package are installed" test -s "$at/share/perigal/matlab/perigal_run.m" -a -s "$at/share/perigal/python/perigal/__init__.py"
page=$at/share/man/man1/perigal.1
try "every command stands in the man page" bash -c '"$1" --help | sed -n "s/^  perigal \([a-z]*\) .*/\1/p" | while read -r c; do grep -q "^.SS perigal $c" "$2" || exit 1; done' - "$at/bin/perigal" "$page"
try "no line of the man page is taken for a command of its own" bash -c '! grep -n "^\." "$1" | grep -v ":\.\(TH\|SH\|SS\|B\|I\|RI\|nf\|fi\)\b"' - "$page"
echo "1..$n"
exit $bad
