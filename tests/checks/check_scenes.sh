#!/bin/sh
# What the scenes leave in files and say at their end, without a screen.
set -u
failed=0

. "$(dirname "$0")/verdict.sh"

elasto=$(realpath "${ELASTO:-build/elasto}")
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
unset DISPLAY WAYLAND_DISPLAY

# run CODE LINE...: runs without a screen; complains about another exit code.
run() {
    expected=$1
    shift
    rm -rf states log frames
    timeout 60 "$elasto" "$@" --headless --states states --log log \
        >summary 2>error
    code=$?
    [ $code = "$expected" ] || echo "$* ends with $code, not $expected"
}

# table COLUMNS ROWS FILE: complains about the shape of a CSV file.
table() {
    awk -F, -v columns="$1" -v rows="$2" '
        NF != columns { print FILENAME ":" NR ": " NF " columns" }
        END { if (NR != rows + 1) print FILENAME " has " NR - 1 " rows" }
        ' "$3"
}

verdict circle_states_are_three_nodes "$(
    run 0 circle --steps 20
    table 7 63 states
    awk -F, 'NR > 1 && $3 != (NR - 2) % 3 { print "row " NR ": node " $3 }
        NR > 61 { r[$3] = sqrt($4 * $4 + $5 * $5) }
        END { if (!(r[0] > 1.1 && r[1] > 0.95 && r[1] < 1.05 && r[2] < 0.9))
            print "radii " r[0] ", " r[1] ", " r[2] }' states
    run 0 circle --steps 20 --integrator verlet
    table 7 21 states
)"

verdict overshoot_shows_the_step_that_diverges "$(
    run 3 overshoot --frames frames
    table 7 3 states
    table 18 2 log
    awk -F, 'NR == 3 && $4 > -11.6449585 { print "first update to " $4 }
        NR == 4 && !($4 > 3.2e9 && $4 < 3.3e9) { print "second to " $4 }
        NR > 1 && $2 != 0 { print "time passes" }' states
    awk -F, 'NR == 2 && ($13 != 2 || $15 > -11.64) { print "log: " $0 }' log
    [ "$(ls frames | wc -l)" = 3 ] || echo 'not 3 frames'
    grep -q 'not converged 1' summary || echo 'summary is silent'
)"

verdict overshoot_converges_with_a_line_search "$(
    run 0 overshoot --line-search backtrack
    awk -F, 'NR > 1 && $7 >= 0 { print "f rises in row " NR }' log
    tail -n 1 states | awk -F, '!($4 < 1e-9 && $4 > -1e-9) { print "at " $4 }'
)"

verdict landscape_goes_uphill_only_unprojected "$(
    run 3 landscape --filter none
    awk -F, 'NR > 1 && !($6 > 0 && $4 == 0) { print "slope " $6 }' log
    table 7 6 states
    run 0 landscape
    awk -F, 'NR > 1 && !($6 < 0) { print "slope " $6 }' log
    run 3 landscape --filter none --line-search none # E rises: diverged
    run 0 landscape --start 1,1
    sed -n 2p states | grep -q '^0,0,0,1,1,0,0$' || sed -n 2p states
)"

verdict unprojected_needs_the_projection "$(
    run 3 unprojected --steps 5
    awk -F, '$4 == 0 && $6 > 0 { any = 1 }
        END { if (!any) print "no direction uphill in the log" }' log
    table 7 150 states
    run 0 unprojected --steps 30 --filter clamp
    run 0 unprojected --steps 30 --line-search none
)"

verdict explicit_methods_count_no_matrix "$(
    for method in forward-euler symplectic-euler verlet; do
        run 0 square --steps 5 --timestep 0.001 --integrator $method
        grep -qE '^(Newton|factorisations|solves|matrix)' summary &&
            echo "$method: $(grep -E '^(Newton|fact|solves|matrix)' summary)"
        table 14 0 log
    done
    run 0 square --steps 5
    for what in 'Newton iterations' factorisations solves 'matrix entries'; do
        grep -q "^$what  *[1-9]" summary || echo "square has no $what"
    done
    run 0 square --steps 2 --segments 33
    grep -q '^V-cycles  *[1-9]' summary || echo 'multigrid has no cycles'
    grep -E '^(factorisations|solves|matrix)' summary
)"

# Newton leaves them without any V-cycle, and only where a minimum is asked for.
verdict saddles_left_are_counted "$(
    run 0 square --segments 16 --minimum --steps 14
    grep -q '^saddles left  *[1-9]' summary || echo 'none was left'
    grep '^V-cycles' summary
    run 0 square --segments 16 --steps 14
    grep '^saddles left' summary
)"

verdict list_has_a_sentence_each "$(
    "$elasto" --list | awk '
        NF < 4 { print "no sentence: " $0 }
        length($0) > 80 { print "too long: " $0 }
        { names = names " " $1 }
        END {
            if (index(names, " square circle overshoot landscape unprojected"))
                exit
            print names
        }'
)"

exit $failed
