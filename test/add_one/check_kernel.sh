# ---- discretization/kernel/cosine.c ----
listed cosine "(1 + cos (pi q)) / 2"
offered method.kernel cosine
expect "a run with it"                        0 '*' '*' run plate.yaml -o "$work/cosine" "${once[@]}" --set method.kernel=cosine
expect "a misspelt kernel is told its name"    65 '' 'cosine' run plate.yaml -o "$work/none" --set method.kernel=cosin
