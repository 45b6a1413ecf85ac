#!/bin/bash
# test_paraview.sh BUILD: data/paraview/views.py reads its arguments and makes the pictures it should, with a stand-in for ParaView
# that accepts every call and notes the files; what ParaView draws is not tested here.
script=$PWD/data/paraview/views.py; work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; n=0; bad=0
verdict () { n=$((n + 1)); if [ "$2" -eq 0 ]; then echo "ok $n - $1"; else bad=1; echo "not ok $n - $1"; fi; }
mkdir -p "$work/run" "$work/fake/paraview"; : > "$work/run/result.e"; : > "$work/fake/paraview/__init__.py"
cat > "$work/fake/paraview/simple.py" << 'END'
import sys
class Any:
    """Answers to every name and call."""
    def __init__(self, **given): self.__dict__.update(given)
    def __getattr__(self, name):
        if name.startswith('__'): raise AttributeError(name)
        value = Any(); setattr(self, name, value); return value
    def __call__(self, *words, **given): return Any(**given)
    def __len__(self): return 0
class Array(Any):
    def GetNumberOfComponents(self): return len(self.names)
    def GetComponentName(self, k): return self.names[k]
    def GetName(self): return self.name
    def GetRange(self, k): return (0.5e-9, 1e-9)
class Info(Any):
    arrays = [Array(name='damage', names=['']), Array(name='displacement_', names=['X', 'Y', 'Z']), Array(name='stress_yy', names=['']), Array(name='volume', names=[''])]
    def GetNumberOfArrays(self): return len(self.arrays)
    def GetArray(self, k): return self.arrays[k]
    def GetBounds(self): return (0, 0.04, 0, 0.06, 0, 0.02)
    def GetNumberOfPoints(self): return 9
class Source(Any):
    def GetDataInformation(self): return Info()
    def GetPointDataInformation(self): return Info()
    def UpdatePipeline(self, time=None): pass
def ExodusIIReader(**given): return Source(TimestepValues=[0.5, 1.0], **given)
Glyph = Calculator = Threshold = WarpByVector = lambda **given: Source(**given)
def SaveScreenshot(path, *words, **given): open(path, 'w').close()
def __getattr__(name): return Any()
END
python3 -m py_compile "$script" 2> /dev/null; verdict "the script is Python" $?
rm -rf "$(dirname "$script")/__pycache__"
python3 "$script" --help | grep -q 'magnify'; verdict "--help explains the options" $?
fake () { PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$work/fake python3 "$script" "$@" 2>&1; }
python3 -S -c 'import paraview' 2> /dev/null || { out=$(python3 "$script" "$work/run" 2>&1); grep -q 'pvbatch' <<< "$out"; verdict "without ParaView it says how to run it" $?; }
fake "$work" | grep -q 'holds no result.e'; verdict "a folder without result is named" $?
fake "$work/run" --view bak | grep -q 'no view is called bak: one of front'; verdict "an unknown view is named" $?
fake "$work/run" --section w=1 | grep -q 'expected AXIS=PLACE'; verdict "a wrong section is named" $?
fake "$work/run" --field strain_xx | grep -q 'there is no field strain_xx; there are damage, displacement'; verdict "an unknown field is named" $?
fake "$work/run" --step 7 | grep -q 'steps are 0 to 1'; verdict "an unknown step is named" $?
names=$(fake "$work/run" --out "$work/a" | xargs -n 1 basename | sort | xargs)
[ "$names" = "damage.png damage_back.png damage_crack.png damage_front.png damage_iso.png displacement.png displacement_back.png displacement_front.png displacement_iso.png" ]
verdict "pictures by default: sections, sides, iso, crack" $?
names=$(fake "$work/run" --out "$work/b" --field displacement_y --view left,crack --section x=0.005 --step all --magnify 5 | xargs -n 1 basename | sort | xargs)
[ "$names" = "displacement.y_crack_0000.png displacement.y_crack_0001.png displacement.y_left_0000.png displacement.y_left_0001.png displacement.y_x_0.005_0000.png displacement.y_x_0.005_0001.png" ]
verdict "chosen fields, views and steps" $?
[ "$(ls "$work/b" | wc -l)" -eq 6 ]; verdict "files are where --out says" $?
echo "1..$n"
exit $bad
