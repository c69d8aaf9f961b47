#!/bin/sh
# Checks elasto-bench: a quick run writes whole tables of finite numbers; a
# wrong command line gives one line of explanation.
program=$(realpath "${BENCH:-build/elasto-bench}")
. "$(dirname "$0")/verdict.sh"
work_apart

# table NAME COLUMN: checks that a table has a comment, the names of its
# columns, and complete rows of finite numbers.
table() {
    awk -F , -v column="$2" '
        NR == 1 && !/^# elasto .*SuiteSparse .*SDL .*flags / {
            print "line 1 does not say where it comes from"
        }
        NR > 1 && /^#/ { next }
        NR == 2 { count = NF; if ($0 !~ column) print "columns are " $0 }
        NR > 2 && NF != count { print "line " NR " has " NF " columns" }
        NR > 2 {
            for (i = 1; i <= NF; i++)
                if (tolower($i) ~ /^[-+]?(nan|inf|infinity)?$/)
                    print "line " NR " column " i ": " $i
        }
        END { if (NR < 3) print "no rows" }' "$1.csv" 2>&1
}

verdict quick_runs_end_well "$(for table in work steps; do
    "$program" $table --quick >"$table.csv" || echo "$table ends badly"
done 2>&1)"
verdict tables_are_whole "$(
    table work error_m
    table steps median_ms
)"
verdict the_table_says_where_implicit_loses \
    "$(grep -q 'implicit loses' work.csv || echo 'it does not')"

# Checks numbers that hold even in a quick run.
methods='backward-euler forward-euler symplectic-euler verlet bdf2 midpoint
    sdirk2'
verdict all_methods_were_measured "$(for name in $methods; do
    [ "$(grep -c ",$name," work.csv)" -ge 3 ] ||
        echo "$name has too few runs"
done)"
verdict failures_are_marked "$(awk -F , '
    $1 == "spinning" && $3 == "forward-euler" && $10 == 0 {
        print "forward Euler did not fail with " $6 " steps"
    }' work.csv)"
verdict solvers_end_with_the_same_energy "$(awk -F , 'NR > 2 && !/^#/ {
        if (first[$1] == "") first[$1] = $8
        else if (!($8 - first[$1] < 0.01 && first[$1] - $8 < 0.01))
            print $1, $2, $8, "not", first[$1]
    }' steps.csv)"
verdict readme_figure_has_all_methods "$(for name in $methods; do
    grep -q "$name, " "$root/tests/data/work_precision.svg" || echo "$name is missing"
done)"

# Checks that a failing `make` keeps the old table.
unmeasured() { # make's arguments...
    mkdir -p "$root/build/bench"
    [ -e "$root/build/bench/steps.csv" ] || cp steps.csv "$root/build/bench"
    cksum "$root"/build/bench/* >before
    ! "${MAKE:-make}" -s -C "$root" bench "$@" >out 2>&1 || echo "$* is taken"
    grep -q 'tables: work' out || cat out
    cksum "$root"/build/bench/* | diff before -
}
verdict what_fails_leaves_the_table "$(
    unmeasured TABLES=steps ARGS=--foo
    unmeasured TABLES=foo
)"

verdict bad_usage_is_one_line "$(
    refuses 2 . "$program"
    refuses 2 . "$program" solvers
    refuses 2 . "$program" work --fast
    refuses 2 . "$program" steps --quick work
)"

exit $failed
