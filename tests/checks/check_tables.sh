#!/bin/sh
# Checks tables: the ledger adds up and agrees with the states, and a run that
# starts from a table continues like the run that wrote it.
. "$(dirname "$0")/verdict.sh"
work_apart

run() {
    "$elasto" --headless --quiet "$@" 2>error
    code=$?
    [ $code = 0 ] || [ $code = 3 ] || echo "$*: exit $code: $(cat error)"
}

# ledger MASS GRAVITY LINE: total is the sum of stored energies; total and
# losses are the total of the start and the work; kinetic energy and gravity
# agree with the states. Tolerance: rounding, 1e-12 of the largest number or of
# the sum over heights.
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

# Times are exact products: that of step 60 is 60 h to the last bit.
verdict times_are_steps_times_h "$(
    run --segments 2 --steps 60 --timestep 0.002 --energies energies
    awk -F, 'NR > 1 && $2 != $1 * 0.002 { print "step " $1 ": " $2 }' energies
)"

# goes_on STEPS LINE: makes STEPS steps, then as many from the written table.
goes_on() {
    steps=$1
    shift
    run "$@" --steps "$steps" --states first
    run "$@" --steps "$steps" --states second --state first
    run "$@" --steps $((2 * steps)) --states both
    tail -n 20 both | cut -d, -f3- >end
    tail -n 20 second | cut -d, -f3- | cmp - end
}
# Continues runs with broken springs, plastic springs and a falling ball.
springs_go_on() { # STEPS LINE
    steps=$1
    shift
    run "$@" --steps "$steps" --states first --springs whole
    run "$@" --steps "$steps" --states second --state first \
        --state-springs whole --springs later
    run "$@" --steps $((2 * steps)) --states both --springs all
    for pair in 'second both 25' 'later all 50'; do
        # shellcheck disable=SC2086
        set -- $pair
        tail -n "$3" "$1" | cut -d, -f3- >end
        tail -n "$3" "$2" | cut -d, -f3- | cmp - end
    done
    awk -F, 'NR > 1 && ($6 == 0 || $10 > 0) { n++ }
        END { if (!n) print "nothing has become of the springs" }' whole
}
verdict springs_go_on_from_their_tables "$(
    springs_go_on 40 tear
    springs_go_on 60 dent
    springs_go_on 60 bend
    springs_go_on 20 slope --yield 0.01
    # springs that broke in undone steps are unbroken
    printf '%s\n' '60 goto 20' '20 set timestep 0.001' '20 play' >back
    echo '20 set timestep 0.001' >straight
    for name in back straight; do
        run tear --steps 60 --script $name --states states --springs springs
        run tear --steps 1 --state states --state-springs springs \
            --states $name.csv
    done
    cmp back.csv straight.csv
    awk -F, '$6 == 0 { n[$1]++ } END { if (n[60] <= n[20]) print "none" }' springs
)"
verdict what_a_table_does_not_know_is_said "$(
    for line in tear dent '--yield 0.1' squeeze '--ceiling 9,-1,8'; do
        # shellcheck disable=SC2086
        run $line --steps 1 --states first --springs whole
        # shellcheck disable=SC2086
        refuses 0 '^--state: the ' "$elasto" $line --headless --steps 1 \
            --state first
    done
    run drop --steps 1 --states first
    run drop --steps 1 --state first
    cat error
)"

verdict runs_go_on_from_their_tables "$(
    goes_on 20 hang --segments 5
    goes_on 30 drop
    goes_on 15 slope
    # from a step in between
    run hang --segments 4 --steps 9 --states both
    run hang --segments 4 --steps 5 --states more --state both --state-step 4
    tail -n 25 more | cut -d, -f3- >end
    tail -n 25 both | cut -d, -f3- | cmp - end
    run hang --segments 4 --steps 1 --states more --state both
    sed -n 2,26p more | cut -d, -f3- | cmp - end
    # from the first of two panes
    run --steps 3 --timestep 0.004,0.01 --states both
    run --steps 1 --states more --state both
    awk -F, '$1 == 3 && $8 == 1' both | cut -d, -f4-7 >end
    sed -n 2,26p more | cut -d, -f4-7 | cmp - end
)"

refused() { # LINE WORDS
    # shellcheck disable=SC2086
    refuses 2 "$2" "$elasto" --headless --state table $1
}
# A cell with one corner pressed in: both triangles of a solid are valid, one of
# the four of springs is not.
verdict solids_begin_where_their_triangles_are_well "$(
    printf '%s\n' step,time,node,x,y,vx,vy 0,0,0,-0.5,-0.5,0,0 \
        0,0,1,-0.5,0.5,0,0 0,0,2,0.5,-0.5,0,0 0,0,3,-0.1,-0.1,0,0 >pressed
    run --segments 1 --steps 1 --state pressed --material neo-hookean
    "$elasto" --headless --segments 1 --steps 1 --state pressed --cells on \
        2>error && echo 'cells begin turned over'
)"

verdict other_tables_are_refused "$(
    run --body 0,0 --body 2,0 --steps 1 --states table
    refused '' 'last step has 50 nodes, the body 25'
    run --steps 2 --states table
    refused '--segments 5' 'last step has 25 nodes, the body 36'
    refused '--ground 0,1,0,0' 'the ground would overlap the square'
    refused '--states table' 'are one file'
    refused 'circle' 'circle'
    refused '--state-step 3' 'step 3 is not in it'
    sed 's/^2,\(.*\),[^,]*$/2,\1,nan/' table >other && mv other table
    refused '' "line 52: vy is 'nan', not a number"
    run --stretch -1 --steps 1 --states table
    refused '--cells on' 'would be turned over'
)"

# Numbers as other programs write them are read; a table that another program
# has changed is refused with a reason.
other_programs() {
    run --steps 2 --states plain --springs springs
    awk -F, '$1 == 0 { n[int(100 * $8 + 0.5)]++ }
        END { print n[0], n[48], n[96] }' springs >strains
    grep -qx '20 32 20' strains || echo "strains of 0, 48, 96 %: $(cat strains)"
    run --steps 3 --state plain --states wanted
    for change in 's/$/\r/' '1s/^/\xef\xbb\xbf/' '$!b;N' 's/,/ , /g' \
        '1s/[a-z]\{1,\}/"&"/g' '$G' 's/e-/E-/' 's/$/,1/;1s/,1$/,mine/'; do
        sed "$change" plain >table
        [ "$change" != '$!b;N' ] || printf %s "$(cat plain)" >table
        run --steps 3 --state table --states states
        cmp -s states wanted || echo "$change: other states"
    done
    awk -F, '{ print $7 "," $6 "," $5 "," $4 "," $3 "," $1 }' plain >table
    run --steps 3 --state table --states states
    cmp states wanted
    while IFS='|' read -r change words; do
        sed "$change" plain >table
        refused '' "^elasto: --state 'table': $words"
    done <<'END'
s/\./,/g|line 2 has 9 columns, the first line 7; a number has a point
20s/\./,/|line 20 has 8 columns, the first line 7; a number has a point
s/,/;/g|its first line, 'step;.* has no column 'step'
1d|its first line, .* has no column 'step'
9s/,[^,]*$//|line 9 has 6 columns, the first line 7
9d|line 9 has node 8 where node 7 is missing
3s/,-[0-9.]*/,-/|line 3: x is '-', not a number
d|it is empty
2,$d|it has no row below
END
    cp plain table
    refused '--state-springs plain' "springs 'plain': .* no column 'spring'"
    refused '--segments 4 --state-springs nowhere' 'nowhere.: No such file'
    run --segments 3 --steps 1 --states table --springs springs
    cp plain table
    refused '--state-springs springs' 'has 42 springs, the body 72'
    run tear --steps 60 --states table --springs springs
    refused 'tear --state-springs springs --state-step 99' 'step 99 is not'
    refused '--segments 24 --state-springs springs' 'is broken; --tear is missing'
}
verdict tables_are_read_or_the_line_is_named "$(other_programs)"

# Rows of repeated steps follow the old rows; a run that starts from such a step
# takes the last rows.
verdict rows_of_new_steps_follow "$(
    printf '%s\n' '4 goto 2' '2 set gravity 9' '2 play' >back
    echo '2 set gravity 9' >straight
    for name in back straight; do
        run hang --segments 2 --steps 4 --script $name --states $name.csv
        run hang --segments 2 --steps 0 --state $name.csv --state-step 3 \
            --states $name.start
        tail -n 18 $name.csv >$name.end
    done
    awk -F, '$3 == 0 { printf $1 }' back.csv | grep -qx 0123434 || cat back.csv
    cmp back.end straight.end
    cmp back.start straight.start
)"

# ---- what others read ----------------------------------------------------------
# Checks that numpy reads each table, as the README of play says: strains of
# springs agree with their nodes, and all tables have the same steps.
read_tables() {
    run tear --steps 6 --states s.csv --log l.csv --energies e.csv \
        --springs p.csv
    "$python" -c '
import numpy as np
s, l, e, p = (np.genfromtxt(f"{name}.csv", delimiter=",", names=True, dtype=None, encoding=None)
              for name in "slep")
x = np.stack([s["x"], s["y"]], -1).reshape(7, -1, 2)
d = x[p["step"], p["j"]] - x[p["step"], p["i"]]
off = abs((d ** 2).sum(-1) / p["rest"] ** 2 - 1 - p["strain"]).max()
if not off < 1e-13: print("strain is off by", off)
for table in s, p, e: # the log has no row for step 0
    times = table["time"].reshape(7, -1)
    if (times != e["time"][:, None]).any(): print("other times")
if set(l["step"]) != set(range(1, 7)) or set(l["kind"]) - {"value", "estimate", "bound"}:
    print("the log has other rows")
' 2>&1
}
# Debian's python3 has its packages.
python=$(command -v python3)
[ ! -x /usr/bin/python3 ] || python=/usr/bin/python3
if "$python" -c 'import numpy' 2>/dev/null; then
    verdict numpy_reads_the_tables "$(read_tables)"
else
    echo 'skipped numpy_reads_the_tables: no python3 with numpy'
fi

exit $failed
