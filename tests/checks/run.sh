#!/bin/sh
# Runs every suite named on the command line and every tests/checks/check_*.sh, and
# ends with one line of counts.  Suites written with cmocka report themselves;
# shell checks print "ok NAME" or "not ok NAME: reason", a line per test, or
# "skipped NAME: reason" where something is missing that the test needs.
#
# The two checks that mostly wait (for windows, for signals) run beside the
# rest; what each printed is shown in one piece afterwards.
set -u
passed=0
failed=0
outputs=$(mktemp -d) || exit 1
trap 'rm -rf "$outputs"' EXIT

# Runs it; output and exit code go to files named after it.
run() { # name command...
    name=$1
    shift
    "$@" >"$outputs/$name" 2>&1
    echo $? >"$outputs/$name.code"
}

# sum PATTERN FILE: the numbers in the lines that match, added up
sum() {
    sed -n "s/$1/\\1/p" "$2" | awk '{ sum += $1 } END { print sum + 0 }'
}

report() { # name passed failed
    output=$outputs/$1
    if [ "$(cat "$output.code")" != 0 ] && [ "$3" -eq 0 ]; then
        set -- "$1" "$2" 1 # it crashed, or counted nothing
    fi
    grep '^skipped ' "$output"
    if [ "$2" -eq 0 ] && [ "$3" -eq 0 ] && ! grep -q '^skipped ' "$output"; then
        echo "$1 ran no test"
        set -- "$1" 0 1
    fi
    if [ "$3" -ne 0 ]; then
        cat "$output"
    fi
    printf '%-28s %4d passed, %d failed\n' "$1" "$2" "$3"
    passed=$((passed + $2))
    failed=$((failed + $3))
}

run check_faults.sh sh tests/checks/check_faults.sh &
faults=$!
run check_window.sh sh tests/checks/check_window.sh &
window=$!
for suite in "$@"; do
    run "$(basename "$suite")" "$suite"
done
for check in tests/checks/check_*.sh; do
    case $check in
    */check_faults.sh | */check_window.sh) ;;
    *) run "$(basename "$check")" sh "$check" ;;
    esac
done
wait $faults $window

for suite in "$@"; do
    name=$(basename "$suite")
    report "$name" "$(sum '^\[  PASSED  \] \([0-9]*\) test(s)\..*' \
        "$outputs/$name")" \
        "$(sum '^\[  FAILED  \] \([0-9]*\) test(s).*' "$outputs/$name")"
done
for check in tests/checks/check_*.sh; do
    name=$(basename "$check")
    report "$name" "$(grep -c '^ok ' "$outputs/$name")" \
        "$(grep -c '^not ok ' "$outputs/$name")"
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
