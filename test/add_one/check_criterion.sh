# ---- mechanics/criterion/tresca.c ----
listed tresca "largest shear stress reaches the shear strength"
offered failure.criterion tresca
key failure.shear_strength "(tresca) Largest shear stress"
key 'materials.{}.failure.shear_strength' "(tresca) As failure.shear_strength, for this material"
glass=(--set 'failure={criterion: tresca, shear_strength: 20 MPa}')
expect "a run in which it breaks bonds"        0 ' [1-9][0-9]* bonds broken' '*' run plate.yaml -o "$work/tresca" "${once[@]}" "${glass[@]}"
grep -q '"criterion": "largest shear stress >= 2e+07 Pa"' "$work/tresca/report.json"; verdict "report.json: its limit" $?
expect "its limit is missing"                 65 '' 'failure.criterion = tresca: tresca needs failure.shear_strength' check plate.yaml --set 'failure={criterion: tresca}'
expect "its limit, of a material"              0 '*' '*' check plate.yaml --set 'failure={criterion: tresca}' --set 'materials.glass.failure={shear_strength: 1 MPa}'
expect "its limit with another criterion"     65 '' 'failure.shear_strength = 1: has no effect with the criterion stretch' \
       check plate.yaml --set 'failure={criterion: stretch, critical_stretch: 1e-3, shear_strength: 1}'
expect "a limit of another criterion"         65 '' 'failure.cohesion = 1: has no effect with the criterion tresca' check plate.yaml "${glass[@]}" --set failure.cohesion=1
expect "a force that knows no stresses"       65 '' 'failure.criterion = tresca: tresca needs the stress of bonds, and those of force: bond show only' check plate.yaml "${glass[@]}" --set method.force=bond
expect "help for its limit"                    0 '(tresca) Largest shear stress' '' help failure.shear_strength
