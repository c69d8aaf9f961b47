#!/bin/sh
# Runs every suite named on the command line and every tests/check_*.sh, and
# ends with one line of counts.  Suites written with cmocka report themselves;
# shell checks print "ok NAME" or "not ok NAME: reason", a line per test.
set -u
passed=0
failed=0
output=$(mktemp) || exit 1
trap 'rm -f "$output"' EXIT

# count PATTERN: sum of the numbers in the lines that match
count() {
    sed -n "s/$1/\\1/p" "$output" | awk '{ sum += $1 } END { print sum + 0 }'
}

report() { # name passed failed exit-code
    if [ "$4" -ne 0 ] && [ "$3" -eq 0 ]; then
        set -- "$1" "$2" 1 "$4" # it crashed, or counted nothing
    fi
    if [ "$2" -eq 0 ] && [ "$3" -eq 0 ]; then
        echo "$1 ran no test"
        set -- "$1" 0 1 "$4"
    fi
    if [ "$3" -ne 0 ]; then
        cat "$output"
    fi
    printf '%-28s %4d passed, %d failed\n' "$1" "$2" "$3"
    passed=$((passed + $2))
    failed=$((failed + $3))
}

for suite in "$@"; do
    "$suite" >"$output" 2>&1
    code=$?
    report "$(basename "$suite")" \
        "$(count '^\[  PASSED  \] \([0-9]*\) test(s)\..*')" \
        "$(count '^\[  FAILED  \] \([0-9]*\) test(s).*')" $code
done
for check in tests/check_*.sh; do
    [ -f "$check" ] || continue
    sh "$check" >"$output" 2>&1
    code=$?
    report "$(basename "$check")" "$(grep -c '^ok ' "$output")" \
        "$(grep -c '^not ok ' "$output")" $code
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
