#!/bin/sh
# Tables that are read again: the ledger adds up and is that of the states, and
# a run that begins in a table goes on as the one that wrote it.
. "$(dirname "$0")/verdict.sh"
work_apart

run() {
    "$elasto" --headless --quiet "$@" 2>error
    code=$?
    [ $code = 0 ] || [ $code = 3 ] || echo "$*: exit $code: $(cat error)"
}

# ledger MASS GRAVITY LINE: total is the sum of what is stored; with what was
# lost it is the start's total and the work done; kinetic energy and gravity's
# are those of the states.  All to rounding, 1e-12 of the largest number or of
# what all heights add up to.
ledger() {
    m=$1 g=$2
    shift 2
    run "$@" --energies energies --states states
    awk -F, -v m="$m" -v g="$g" -v line="$*" '
        function bad(what, off) {
            if (!(off <= 1e-12 * size && off >= -1e-12 * size) && !told[what]++)
                print line ": step " $1 ": " what " is off by " off
        }
        FNR == 1 { file++; n = split($0, column)
            for (c = 1; c <= n; c++) at[column[c]] = c
            next }
        file == 1 { k[$1] += m / 2 * ($6 * $6 + $7 * $7)
            p[$1] += m * g * $5; size += m * g * ($5 < 0 ? -$5 : $5)
            next }
        { stored = $at["kinetic"] + $at["elastic"] + $at["gravity"] + \
              $at["contact"]
          gone = $at["plastic"] + $at["fracture"] + $at["damping"] + \
              $at["friction"] + $at["dissipated"]
          if (FNR == 2) first = $at["total"]
          if (first > size) size = first
          if (k[$1] > size) size = k[$1]
          bad("total", $at["total"] - stored)
          bad("what is gone", first + $at["work"] - $at["total"] - gone)
          bad("kinetic", $at["kinetic"] - k[$1])
          bad("gravity", $at["gravity"] - p[$1]); rows++ }
        END { if (rows < 41) print line ": " rows " rows" }' states energies
}
verdict energies_add_up "$(
    ledger 40 0 square --steps 40
    ledger 40 9.81 square --steps 60 --gravity 9.81 --ground 0.2,1,0,-0.7 \
        --friction 0.3 --stretch 1 --damping 0.002 --yield 0.05
)"

# goes_on STEPS LINE: as many steps from the table of as many steps before.
goes_on() {
    steps=$1
    shift
    run "$@" --steps "$steps" --states first
    run "$@" --steps "$steps" --states second --state first
    run "$@" --steps $((2 * steps)) --states both
    tail -n 20 both | cut -d, -f3- >end
    tail -n 20 second | cut -d, -f3- | cmp - end
}
verdict runs_go_on_from_their_tables "$(
    goes_on 20 hang --segments 5
    goes_on 30 drop
    goes_on 15 slope
    # from a step in between, of lines and of arrays
    run hang --segments 4 --steps 9 --states both.csv
    run hang --segments 4 --steps 9 --states both.npz
    for file in both.csv both.npz; do
        run hang --segments 4 --steps 5 --states $file.csv --state $file --state-step 4
        tail -n 25 $file.csv | cut -d, -f3- >end
        tail -n 25 both.csv | cut -d, -f3- | cmp - end
        run hang --segments 4 --steps 1 --states $file.csv --state $file
        sed -n 2,26p $file.csv | cut -d, -f3- | cmp - end
    done
)"

refused() { # LINE WORDS [TABLE]
    # shellcheck disable=SC2086
    refuses 2 "$2" "$elasto" --headless --state "${3:-table}" $1
}
# A cell that is pressed in at a corner: both triangles of a solid are well, one
# of the four that springs have is not.
verdict solids_begin_where_their_triangles_are_well "$(
    printf '%s\n' step,time,node,x,y,vx,vy 0,0,0,-0.5,-0.5,0,0 \
        0,0,1,-0.5,0.5,0,0 0,0,2,0.5,-0.5,0,0 0,0,3,-0.1,-0.1,0,0 >pressed
    run --segments 1 --steps 1 --state pressed --material neo-hookean
    "$elasto" --headless --segments 1 --steps 1 --state pressed --cells on \
        2>error && echo 'cells begin turned over'
)"

verdict other_tables_are_refused "$(
    refused '' "--state 'table': No such file"
    run --steps 2 --states table
    run --steps 2 --states table.npz
    refused '--state-step 3' 'step 3 is not in it' table.npz
    refused '--segments 5' 'last step has 25 nodes, the body 36' table.npz
    for table in bodies.npz bodies.csv; do
        run --body 0,0 --body 2,0 --steps 1 --states $table
        refused '' 'last step has 50 nodes, the body 25' $table
    done
    head -c 1500 table.npz >part.npz
    mv part.npz table.npz
    refused '' 'x, y, vx, vy must be arrays of one shape' table.npz
    refused '--segments 5' 'last step has 25 nodes, the body 36'
    refused '--ground 0,1,0,0' 'would begin at a distance of'
    refused '--states table' 'are one file'
    refused 'circle' 'circle'
    refused '--state-step 3' 'step 3 is not in it'
    sed 's/^2,\(.*\),[^,]*$/2,\1,nan/' table >other && mv other table
    refused '' 'line 52 is not one that --states writes'
    run --stretch -1 --steps 1 --states table
    refused '--cells on' 'a cell begins turned over'
)"

# Rows are taken back twice, and in between steps without updates write none:
# those of steps 1 and 2 are left.
verdict rows_are_taken_back "$(
    printf '%s\n' '6 goto 2' '2 set integrator forward-euler' '2 play' \
        '7 goto 5' '5 set timestep 0.001' >script
    run --segments 1 --steps 5 --script script --log both.csv
    run --segments 1 --steps 2 --log first.csv
    cut -d, -f1-11 first.csv >first
    cut -d, -f1-11 both.csv | cmp - first
    run --segments 1 --steps 5 --script script --log both.npz
    run --segments 1 --steps 2 --log first.npz
    [ $(wc -c <both.npz) = $(wc -c <first.npz) ] || echo 'arrays have more'
)"

# ---- what others read ----------------------------------------------------------
# A run with CSV and the same one with arrays and steps for ParaView: each number
# is the same to the last bit, the time that an iteration took apart.
write_both() { # LINE
    run "$@" --states s.csv --log l.csv --energies e.csv --springs p.csv
    run "$@" --states s.npz --log l.NPZ --energies e.npz --springs p.npz \
        --vtk steps
}
# CSV FILE: a column by its name, [step, place] where SHAPE says so
python=$(command -v python3)
[ ! -x /usr/bin/python3 ] || python=/usr/bin/python3 # Debian's has its packages
read_csv='
import csv, sys
import numpy as np
def table(name):
    rows = list(csv.reader(open(name)))
    return {n: np.array(c) for n, c in zip(rows[0], zip(*rows[1:]))}
def bad(what):
    print(what)
'
compare_arrays() {
    "$python" -c "$read_csv"'
for c, z in (("s.csv", "s.npz"), ("l.csv", "l.NPZ"), ("e.csv", "e.npz"), ("p.csv", "p.npz")):
    text, arrays = table(c), np.load(z)
    list(text) == arrays.files or bad(z + ": " + " ".join(arrays.files))
    steps = len(set(text["step"]))
    for name, column in text.items():
        a = arrays[name]
        if c != "l.csv":
            column = column.reshape(steps, -1)
            if name in ("step", "time"): column = column[:, 0]
            elif name in ("node", "run", "spring", "i", "j", "pane"): column = column[0]
        if name == "iteration": column = np.where(column == "", "-1", column)
        a.shape == column.shape or bad(f"{z}: {name} is {a.shape}")
        if name != "seconds" and not (a == column.astype(a.dtype)).all():
            bad(f"{z}: other numbers in {name}")
' 2>&1
}
verdict_of() { # NAME MODULE COMMAND
    if "$python" -c "import numpy, $2" 2>/dev/null; then
        verdict "$1" "$($3)"
    else
        echo "skipped $1: no python3 with numpy${2#numpy}"
    fi
}
arrays() {
    write_both --steps 6 tear && compare_arrays
    write_both --steps 3 --segments 2 --stiffness 1e5,2e5 --yield 0.05 &&
        compare_arrays
    [ "$(head -n 1 s.csv)" = step,time,node,x,y,vx,vy,pane ] || head -n 1 s.csv
    printf '%s\n' '4 goto 2' '2 set gravity 9' '2 play' '3 restart' '0 play' \
        '3 goto 1' '1 set gravity 1' '1 play' >back
    write_both --steps 5 --script back && compare_arrays # steps are taken back
    rm -f [sl].*
    run landscape --steps 3 --states s.csv --log l.csv
    run landscape --steps 3 --states s.npz --log l.NPZ && compare_arrays
}
verdict_of numpy_reads_the_same_numbers numpy arrays

# Arrays of other shapes or kinds are no start.
starts() {
    "$python" -c '
import numpy as np
x = np.repeat(np.arange(5.0), 5)
y, v, three = np.tile(np.arange(5.0), 5), 0 * x, np.array([x, x, x])
def save(name, save=np.savez, **other):
    save(name + ".npz", **{**dict(x=x, y=y, vx=v, vy=v), **other})
save("good")
save("short", y=y[:9])
save("deep", x=x.reshape(1, 25, 1))
save("steps", step=np.arange(3), x=three, y=three[:2], vx=three, vy=three)
save("packed", np.savez_compressed)
save("single", x=x.astype("f4"))'
    run --steps 0 --state good.npz
    for name in short deep packed single; do
        refused '' 'must be arrays of one shape' $name.npz
    done
    refused '--state-step 1' 'must be arrays of one shape' steps.npz
}
verdict_of numpy_starts_have_one_shape numpy starts

# Each step by VTK: points, velocities, springs that are whole, their strain.
grids() {
    write_both --steps 6 tear
    "$python" -c "$read_csv"'
import vtk, xml.etree.ElementTree as xml
from vtk.util.numpy_support import vtk_to_numpy as numbers
s, p = table("s.csv"), table("p.csv")
sets = xml.parse("steps/steps.pvd").getroot()[0]
len(sets) == 7 or bad(f"{len(sets)} steps")
for k, one in enumerate(sets):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName("steps/" + one.get("file"))
    reader.Update()
    data = reader.GetOutput()
    at, now = s["step"] == str(k), p["step"] == str(k)
    whole = now & (p["whole"] == "1")
    types = numbers(data.GetCellTypesArray())
    lines = (types == vtk.VTK_LINE).sum()
    nodes = numbers(data.GetCells().GetConnectivityArray())
    springs, corners = nodes[:2 * lines].reshape(-1, 2), nodes[2 * lines:].reshape(-1, 3)
    strain = numbers(data.GetCellData().GetArray("strain"))
    velocity = numbers(data.GetPointData().GetArray("velocity"))
    def same(what, ours, text):
        text = np.array(text, float).T
        ours.shape == text.shape and (ours == text).all() or bad(f"step {k}: {what}")
    same("x", numbers(data.GetPoints().GetData())[:, :2], [s["x"][at], s["y"][at]])
    same("v", velocity[:, :2], [s["vx"][at], s["vy"][at]])
    same("springs", springs, [p["i"][whole], p["j"][whole]])
    same("strain", strain[:lines], p["strain"][whole])
    sides = {frozenset(spring) for spring in springs}
    all(frozenset(t[[a, a - 1]]) in sides for t in corners for a in range(3)) or bad("a triangle of broken springs")
    float(one.get("timestep")) == float(s["time"][at][0]) or bad("time")
    x = numbers(data.GetPoints().GetData())
    e, f = x[corners[:, 1]] - x[corners[:, 0]], x[corners[:, 2]] - x[corners[:, 0]]
    grown = (e[:, 0] * f[:, 1] - e[:, 1] * f[:, 0]) * 24 * 24 - 1
    len(corners) > 1000 and (types[lines:] == vtk.VTK_TRIANGLE).all() and abs(grown - strain[lines:]).max() < 1e-12 or bad("areas")
' 2>&1
}
verdict_of vtk_reads_the_same_numbers vtk grids

exit $failed
