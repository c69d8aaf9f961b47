#!/bin/sh
# elasto-bench: a quick run of all parts writes whole tables of finite numbers,
# in seconds; and what is wrong on its command line is told in one line.
set -u
temporary=$(mktemp -d) || exit 1
trap 'rm -rf "$temporary"' EXIT
program=${BENCH:-build/elasto-bench}
failed=0

verdict() { # name reason
    if [ -z "$2" ]; then
        echo "ok $1"
    else
        echo "not ok $1: $(printf '%s' "$2" | tr '\n' ';')"
        failed=1
    fi
}

# table FILE COLUMNS: a comment, the names of the columns, and rows that have
# all of them, each number finite.
table() {
    [ -f "$1" ] || { echo "$1 is missing"; return; }
    awk -F , -v columns="$2" '
        function finite(text) {
            return tolower(text) !~ /^[-+]?(nan|inf|infinity)$/ && text != ""
        }
        NR == 1 && !/^# elasto .*SuiteSparse .*SDL .*flags .*threads/ {
            print "line 1 does not say where it comes from"
        }
        NR == 2 && $0 != columns { print "columns are " $0 }
        NR == 2 { count = NF }
        NR > 2 && NF != count { print "line " NR " has " NF " columns" }
        NR > 2 {
            for (i = 1; i <= NF; i++)
                if (!finite($i)) print "line " NR " column " i ": " $i
        }
        END { if (NR < 3) print "no rows" }' "$1"
}

# Processor time, so that a busy machine changes nothing.
children_seconds() { # into $spent: of all that has ended
    times >"$temporary/times"
    spent=$(awk 'NR == 2 { gsub(/[ms]/, " ")
        print int($1 * 60 + $2 + $3 * 60 + $4) }' "$temporary/times")
}
children_seconds
start=$spent
"$program" --quick --output "$temporary/deep/csv" >"$temporary/out" \
    2>"$temporary/err"
code=$?
children_seconds
seconds=$((spent - start))
verdict quick_run_ends_well \
    "$([ $code -eq 0 ] || echo "exit $code"; head -n 3 "$temporary/err")"
limit=20
[ -z "${SANITIZE:-}" ] || limit=200
verdict quick_run_takes_seconds \
    "$([ $seconds -lt $limit ] || echo "$seconds s, $limit are allowed")"

check() { # part columns
    verdict "$1_csv_is_whole" "$(table "$temporary/deep/csv/$1.csv" "$2")"
}
work=case,segments,integrator,solver,order,steps,timestep_s,tolerance_m_s
work=$work,run_time_s,error_m,energy_drift,iterations,factorisations
check work_precision "$work,unconverged,failed"
solver=solver,segments,steps,total_ms,assembly_ms,analysis_ms,factor_ms
solver=$solver,solve_ms,search_ms,multigrid_ms,rest_ms,bare_ms,iterations
solver=$solver,factorisations
check solver "$solver,solves,unconverged,energy_start_J,energy_end_J"
starts=solver,segments,starts,median_ms,least_ms,most_ms,iterations
starts=$starts,smooth_ns_per_node,buckling_ms,energy_end_percent
check starts "$starts,unconverged"
saddles=solver,segments,steps,buckling,saddles,buckling_saddles
check saddles "$saddles,equal,lower,higher"
tolerance=segments,solver,tolerance_m_s,steps,step_ms,iterations
tolerance=$tolerance,factorisations,median_distance_m,worst_distance_m
check tolerance "$tolerance,elsewhere,unconverged"
filters=filter,timestep_s,stretch,steps,iterations,factorisations
check filters "$filters,projected,unconverged,failed,ms"
check drawing segments,springs_drawn,springs_left_out,frames,bare_ms,full_ms
memory=segments,unknowns,setup_s,step_s,iterations,factorisations
memory=$memory,unconverged,factor_entries,cholmod_peak_bytes
check memory "$memory,process_peak_bytes"
check claims claim,segments,measured,sense,limit,met

# What the numbers must be even in a quick run.
work_rows() { # integrator
    grep -c ",$1," "$temporary/deep/csv/work_precision.csv"
}
missing() {
    for name in backward-euler forward-euler symplectic-euler verlet bdf2 \
        midpoint sdirk2 avf avf4; do
        [ "$(work_rows $name)" -ge 3 ] || echo "$name has too few runs"
    done
}
verdict all_methods_were_measured "$(missing)"
verdict errors_fall_with_the_time_step "$(awk -F , '
    $1 == "soft" && $3 == "verlet" && $15 == 0 {
        if (last && !($10 < last / 3)) print "error " $10 " after " last
        last = $10
    }
    END { if (!last) print "no runs" }' \
    "$temporary/deep/csv/work_precision.csv")"
verdict failures_are_marked "$(awk -F , '
    $1 == "spinning" && $3 == "forward-euler" && $15 == 0 {
        print "forward Euler did not fail with " $6 " steps"
    }' "$temporary/deep/csv/work_precision.csv")"
verdict nothing_unfinished_stays \
    "$(find "$temporary/deep" -name '*.part')"
verdict the_terminal_says_where_implicit_loses \
    "$(grep -q 'implicit loses' "$temporary/out" || echo 'it does not')"

# The figure of the README, if it is there: a full run of all methods.
figure() {
    [ -f tests/data/work_precision.svg ] || return
    for name in backward-euler forward-euler symplectic-euler verlet bdf2 \
        midpoint sdirk2 avf avf4; do
        grep -q "$name, " tests/data/work_precision.svg || echo "$name is missing"
    done
    grep -q 'full run' tests/data/work_precision.svg || echo 'no full run'
}
verdict readme_figure_is_of_a_full_run "$(figure)"

# Bad usage: exit 2 and one line on standard error.
misuse() { # options
    "$program" "$@" >"$temporary/out" 2>"$temporary/err" </dev/null
    code=$?
    [ $code -eq 2 ] || echo "exit $code"
    [ "$(wc -l <"$temporary/err")" -eq 1 ] || echo "not one line"
    [ ! -s "$temporary/out" ] || echo "it printed something"
}
verdict unknown_option_is_refused "$(misuse --fast)"
verdict unknown_part_is_refused "$(misuse --only solvers)"
verdict missing_value_is_refused "$(misuse --output)"
verdict empty_folder_is_refused "$(misuse --output '')"
verdict argument_is_refused "$(misuse solver)"

# What cannot be written: exit 1 and one line.
cannot_write() {
    touch "$temporary/file"
    "$program" --quick --only drawing --output "$temporary/file/csv" \
        >/dev/null 2>"$temporary/err"
    code=$?
    [ $code -eq 1 ] || echo "exit $code"
    [ "$(wc -l <"$temporary/err")" -eq 1 ] || echo "not one line"
}
verdict unwritable_folder_is_reported "$(cannot_write)"

one_part() {
    "$program" --quick --only drawing --output "$temporary/one" >/dev/null
    ls "$temporary/one" | grep -vx drawing.csv
    [ -f "$temporary/one/drawing.csv" ] || echo "no drawing.csv"
}
verdict one_part_is_one_part "$(one_part)"
verdict help_is_short "$("$program" --help >"$temporary/out" || echo 'failed'
    awk 'length > 80 { print "line " NR " is long" }
        END { if (NR < 5 || NR > 24) print NR " lines" }' "$temporary/out")"

exit $failed
