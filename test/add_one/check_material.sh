# ---- mechanics/material/cubic.c ----
listed cubic "linear, cubic symmetry"
offered 'materials.{}.model' cubic
key 'materials.{}.stiffness_44' "(cubic) Shear modulus"
crystal=(--set 'materials.glass={model: cubic, stiffness_11: 160 GPa, stiffness_12: 60 GPa, stiffness_44: 80 GPa, density: 2300}')
expect "force: galerkin carries it"            0 '*' '*' run plate.yaml -o "$work/cubic" "${once[@]}" "${crystal[@]}" --set method.integration=consistent
expect "the plan has its constants"            0 'c11 1.6e+11, c12 6e+10, c44 8e+10 Pa' '*' check plate.yaml "${crystal[@]}"
expect "waves: the fastest, the slowest"       0 'c_p [0-9.]* m/s, c_s [0-9.]* m/s$' '*' check plate.yaml "${crystal[@]}"
for force in bond lps gmpd fcbm; do
    expect "force: $force refuses it"         65 '' 'materials.glass.model = cubic: .*depends on the direction: use force: galerkin' check plate.yaml "${crystal[@]}" --set "method.force=$force"
done
expect "a fracture energy for its bonds"      65 '' 'failure.fracture_energy = 10: .*depends on the direction: give critical_stretch' \
       check plate.yaml "${crystal[@]}" --set 'failure={criterion: stretch, fracture_energy: 10}'
expect "a key of another model"               65 '' 'materials.glass.poissons_ratio = 0.2: is no key of model: cubic, which reads stiffness_11, stiffness_12, stiffness_44 and density' \
       check plate.yaml "${crystal[@]}" --set materials.glass.poissons_ratio=0.2
expect "its key with another model"           65 '' 'materials.glass.stiffness_44 = 1: is no key of model: elastic' check plate.yaml --set materials.glass.stiffness_44=1
expect "a constant that is missing"           65 '' 'materials.glass.stiffness_44: is missing: Shear modulus' check plate.yaml --set 'materials.glass={model: cubic, stiffness_11: 1, stiffness_12: 0}'
