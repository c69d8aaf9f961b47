#!/bin/sh
# Runs every suite named on the command line and every tests/checks/check_*.sh, and
# ends with one line of counts.  Suites written with cmocka report themselves;
# shell checks print "ok NAME" or "not ok NAME: reason", a line per test, or
# "skipped NAME: reason" where something is missing that the test needs.
#
# What each printed is shown in one piece afterwards.  The last line counts what
# passed, failed and was skipped.
set -u
passed=0
failed=0
skipped=0
checks=${CHECKS:-tests/checks}
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

report() { # name passed failed skipped
    output=$outputs/$1
    if [ "$(cat "$output.code")" != 0 ] && [ "$3" -eq 0 ]; then
        set -- "$1" "$2" 1 "$4" # it crashed, or counted nothing
    fi
    grep '^skipped ' "$output"
    if [ "$2" -eq 0 ] && [ "$3" -eq 0 ] && [ "$4" -eq 0 ]; then
        echo "$1 ran no test"
        set -- "$1" 0 1 0
    fi
    if [ "$3" -ne 0 ]; then
        cat "$output"
    fi
    printf '%-28s %4d passed, %d failed' "$1" "$2" "$3"
    [ "$4" -eq 0 ] || printf ', %d skipped' "$4"
    echo
    passed=$((passed + $2))
    failed=$((failed + $3))
    skipped=$((skipped + $4))
}

# All checks; that of the benchmark with LONG alone.  The homework's runs no
# program that sanitizers watch.
all_checks() {
    for check in "$checks"/check_*.sh; do
        case ${LONG:+long}/${SANITIZE:+watched}/${check##*/} in
        /*/check_bench.sh | */watched/check_homework.sh) ;;
        *) echo "$check" ;;
        esac
    done
}

# The longest begin first; some of them wait most of the time, for windows and
# signals, so that two jobs more than there are processors run; one with LONG,
# where windows have more to do.
slow="test_session check_scripts check_window check_pages check_faults"
more=2
[ -z "${LONG:-}" ] || more=1
jobs=${JOBS:-$(($(nproc 2>/dev/null || echo 2) + more))}

# A worker goes through all of them and runs those that no other has taken.
work() { # suites...
    all=$(all_checks && printf '%s\n' "$@")
    { for name in $slow; do echo "$all" | grep "/$name"; done; echo "$all"; } |
        while IFS= read -r test; do
            name=$(basename "$test")
            take "$name" || continue
            case $name in
            *.sh) run "$name" sh "$test" ;;
            *) run "$name" "$test" ;;
            esac </dev/null
        done
}
take() { # name
    mkdir "$outputs/$1.taken" 2>/dev/null
}
for job in $(seq "$jobs"); do
    work "$@" &
done
wait

for suite in "$@"; do
    name=$(basename "$suite")
    report "$name" "$(sum '^\[  PASSED  \] \([0-9]*\) test(s)\..*' \
        "$outputs/$name")" \
        "$(sum '^\[  FAILED  \] \([0-9]*\) test(s).*' "$outputs/$name")" \
        "$(sum '^\[  SKIPPED \] \([0-9]*\) test(s).*' "$outputs/$name")"
done
all_checks >"$outputs/checks"
while IFS= read -r check; do
    name=$(basename "$check")
    report "$name" "$(grep -c '^ok ' "$outputs/$name")" \
        "$(grep -c '^not ok ' "$outputs/$name")" \
        "$(grep -c '^skipped ' "$outputs/$name")"
done <"$outputs/checks"
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
