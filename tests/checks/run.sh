#!/bin/sh
# Runs the suites named on the command line and all tests/checks/check_*.sh.
# cmocka suites report themselves; shell checks print "ok NAME", "not ok NAME:
# reason" or, if a program is missing, "skipped NAME: reason". Outputs are shown
# one after the other; the last line counts passed, failed and skipped tests.
set -u
passed=0
failed=0
skipped=0
checks=${CHECKS:-tests/checks}
outputs=$(mktemp -d) || exit 1
trap 'rm -rf "$outputs"' EXIT

# Runs a suite or check; files with its name take output and exit code.
run() { # name command...
    name=$1
    shift
    "$@" >"$outputs/$name" 2>&1
    echo $? >"$outputs/$name.code"
}

# sum PATTERN FILE: prints the sum of the numbers in matching lines.
sum() {
    sed -n "s/$1/\\1/p" "$2" | awk '{ sum += $1 } END { print sum + 0 }'
}

report() { # name passed failed skipped
    output=$outputs/$1
    if [ "$(cat "$output.code")" != 0 ] && [ "$3" -eq 0 ]; then
        set -- "$1" "$2" 1 "$4" # a crash, or no counts
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

# Lists the checks: that of the benchmark only with LONG, that of the homework
# not with sanitizers, which cannot watch it.
all_checks() {
    for check in "$checks"/check_*.sh; do
        case ${LONG:+long}/${SANITIZE:+watched}/${check##*/} in
        /*/check_bench.sh | */watched/check_homework.sh) ;;
        *) echo "$check" ;;
        esac
    done
}

# The longest tests start first.  Checks wait for windows and signals, so there
# are two jobs more than processors, and checks make way (LONG: one, equal).
slow="test_session check_scripts check_window check_pages check_faults"
more=2 lower=nice
[ -z "${LONG:-}" ] || more=1 lower=
jobs=${JOBS:-$(($(nproc 2>/dev/null || echo 2) + more))}

# A worker runs all suites and checks that no other worker has taken.
work() { # suites...
    all=$(all_checks && printf '%s\n' "$@")
    { for name in $slow; do echo "$all" | grep "/$name"; done; echo "$all"; } |
        while IFS= read -r test; do
            name=$(basename "$test")
            take "$name" || continue
            case $name in
            *.sh) run "$name" $lower sh "$test" ;;
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
