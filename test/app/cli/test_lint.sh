#!/bin/bash
# test_lint.sh BUILD: the measures of .ci/lint, on a made-up tree whose numbers are known.
. "$(dirname "$0")/expect.sh"
lint=$(realpath "$(dirname "$0")/../../../.ci/lint")
mkdir -p "$work/tree/src/low" "$work/tree/src/mechanics" "$work/tree/src/ranks" "$work/tree/include/perigal" && cd "$work/tree" || exit 1
# measured NAME NUMBER PATTERN: the row of the table, and what --why says of it
measured() {
    "$lint" --measures --why ranks low mechanics > "$work/out" 2> "$work/err"
    grep -q "^lint: $1  *$2 / " "$work/out" && grep -q -- "$3" "$work/out"; verdict "$1 is $2 ($3)" $?
}
echo 'typedef struct { const char *name; int (*reads) (void); } pg_method;' > include/perigal/model.h
cat > include/perigal/force.h <<'END'
typedef struct { int (*bound) (void); double (*row_sums) (void); int flag; } pg_force_motion;
typedef struct { pg_method method; int (*create) (void); void *(*own[2]) (int); double (*at)[3]; pg_force_motion motion; } pg_force_type;
END
cat > src/low/shared.h <<'END'
typedef struct { double x, y[3]; union { int a; float b; }; struct { int deep; } inner; } pair;        /* five fields; Those of a pair */
typedef struct { pair first; int two, three, four, five, six, seven; } alone;
typedef struct { const pair *held; int many, more, less, most, least, none, all; } wide;
END
cat > src/low/one.c <<'END'
#include "shared.h"
/* As that of two. */
int two (void); int top (void);
int one (pair *p, alone *q, int *n) { p->x = 1; q->two += *n == 2; q->seven++; return two () + top (); }
END
cat > src/low/two.c <<'END'
#include "shared.h"
/* Those that the file asks: shape_functions, pg_rank. */
int three (const void *s);
int two (void) { pair many[2]; many[1].y[0] = many[0].x == 2; --many[1].inner.deep; return three ("pg_rank"); }
END
cat > src/low/three.c <<'END'
#include "shared.h"
int one (pair *p, alone *q, int *n); int pg_rank_count (void);
int three (const wide *w) { return w->held->x >= 2 && one (0, 0, &w->many) && w->held->y[0] != 2; }     /* reads only */
int four (const alone *q) { return q->two == 3 && one (&q->first, 0, &q->two); }
int share (wide *w) { int pg_ranks_sum = w->more; return one (&w->held->x, 0, 0) + pg_ranks_sum; }
int shape_functions;
END
cat > src/mechanics/top.c <<'END'
typedef struct { int (*look) (void); int deep, wide; } small;
const small table = { 0, 1, 2 };
int shape_functions, pg_owns;
int top (void) { return table.deep; }
END
echo 'int subdomain (int x) { return x <<= 2 + "a b"[0]; }        // 18 tokens' > src/ranks/ranks.c
measured 'call cycle' - 'older than their source: 5, .* make first'
for f in src/*/*.c; do mkdir -p "build/release/${f%/*}"; ${CC:-cc} -w -c -o "build/release/${f%c}o" "$f"; done
measured 'call cycle'          3 '^    low/three$'
measured 'upward links'        1 'low/one.c uses top of mechanics/top.c'
measured 'entries of a force'  4 'members of pg_force_type'
measured '... with extensions' 7 'pg_force_type'
measured 'other interface'     3 'small has 3 entries (src/mechanics/top.c)'
measured 'fields many write'   5 'pair has 5 fields, 2 files write them'
measured 'shape_functions'     1 '^    src/low/three.c$'
measured 'files that know ranks' 2 '^    src/mechanics/top.c$'
measured 'largest folder'      4 'src/low: 4 files'
measured 'top folders'         3 'folders in src'
measured 'lines'              22 'of src'
measured 'comments that lean'  2 'src/low/two.c:2: Those that'
"$lint" --comments 7 3 > "$work/out"; "$lint" --comments 7 3 | diff - "$work/out" > "$work/why" && [ "$(grep -c '^src/.*:[0-9]*: ' "$work/out")" -eq 3 ]
verdict "three comments are drawn, the same ones by the same seed" $?
cp "${lint%/*}/measures.py" "$work" && sed '/^RULES =/i NOT_YET.clear()' "$lint" > "$work/strict"
python3 "$work/strict" --measures ranks low mechanics > "$work/out" 2> "$work/err"; [ $? -eq 1 ] && grep -q '^lint: upward links .* FAILED ' "$work/out"
verdict "a measure that is no longer excused fails" $?
rm -r src/low src/mechanics
measured 'tokens'             18 'without comments'
measured 'tokens a line'    18.0 'of the 1 lines'
finish
