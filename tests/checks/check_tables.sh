#!/bin/sh
# Tables that are read again: the ledger adds up and is that of the states, and
# a run that begins in a table goes on as the one that wrote it.
set -u
failed=0
elasto=$(realpath "${ELASTO:-build/elasto}")
. "$(dirname "$0")/verdict.sh"
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

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
              $at["contact"] + $at["hand"]
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
    for file in second both; do
        awk -F, -v last="$([ $file = second ] || echo "$steps")" \
            '$1 == last + n { print $3, $4, $5, $6, $7 }' n="$steps" \
            $file >$file.end
    done
    [ -s both.end ] && cmp both.end second.end
}
verdict runs_go_on_from_their_tables "$(
    goes_on 20 hang --segments 5
    goes_on 30 drop
    goes_on 15 slope
)"

# refused LINE: exit 2 and a line with these words.
refused() {
    "$elasto" --headless --state table $1 2>error >out
    [ $? = 2 ] && [ "$(wc -l <error)" = 1 ] && grep -q -- "$2" error ||
        echo "$1: $(cat error)"
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
    refused '--segments 5' 'last step has 25 nodes, the body 36'
    refused '--ground 0,1,0,0' 'would begin at a distance of'
    refused '--states table' 'are one file'
    refused 'circle' 'circle'
    sed 's/^2,\(.*\),[^,]*$/2,\1,nan/' table >other && mv other table
    refused '' 'line 52 is not one that --states writes'
    run --stretch -1 --steps 1 --states table
    refused '--cells on' 'cell 0 begins turned over'
)"

exit $failed
