#!/bin/sh
# The runner of all tests, run on suites and checks whose results are known:
# what fails, crashes, tests nothing or is skipped must show in its last line.
set -u
failed=0
here=$(dirname "$0")
. "$here/verdict.sh"
temporary=$(mktemp -d) || exit 1
trap 'rm -rf "$temporary"' EXIT
mkdir "$temporary/checks dir"

# made NAME LINES CODE: a suite or a check that prints this and ends so.
made() {
    printf '#!/bin/sh\nprintf "%s"\nexit %d\n' "$2" "$3" >"$temporary/$1"
    chmod +x "$temporary/$1"
}
# counts NAME LAST CODE SUITES...: what the runner's last line says.
counts() {
    name=$1 last=$2 code=$3
    shift 3
    CHECKS="$temporary/checks dir" sh "$here/run.sh" "$@" >"$temporary/out" 2>&1
    got=$?
    verdict "$name" "$(
        [ "$(tail -n 1 "$temporary/out")" = "$last" ] ||
            tail -n 1 "$temporary/out"
        [ $got -eq "$code" ] || echo "exit $got"
    )"
}

made 'checks dir/check_a.sh' 'ok one\nok two\n' 0
made good '[  PASSED  ] 3 test(s).\n' 0
counts what_passes_is_counted '5 passed, 0 failed, 0 skipped' 0 \
    "$temporary/good"
made 'checks dir/check_b.sh' 'skipped three: no screen\nok four\n' 0
made partly '[  PASSED  ] 1 test(s).\n[  SKIPPED ] 2 test(s), listed\n' 0
counts what_is_skipped_is_counted '7 passed, 0 failed, 3 skipped' 0 \
    "$temporary/good" "$temporary/partly"
made crashes '[  PASSED  ] 3 test(s).\n' 139
counts a_crash_is_a_failure '6 passed, 1 failed, 1 skipped' 1 \
    "$temporary/crashes"
made nothing '' 0
counts no_test_is_a_failure '3 passed, 1 failed, 1 skipped' 1 \
    "$temporary/nothing"
made bad '[  PASSED  ] 1 test(s).\n[  FAILED  ] 2 test(s), listed below:\n' 1
counts failures_are_counted '4 passed, 2 failed, 1 skipped' 1 "$temporary/bad"
made 'checks dir/check_window.sh' 'not ok five: why\n' 1
counts checks_that_run_beside_count '6 passed, 1 failed, 1 skipped' 1 \
    "$temporary/good"

exit $failed
