#!/bin/sh
# What other tools find in our sources: `make analyse`.  A tool that is not
# installed is named and left out.
set -u
failed=0
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

missing() { # tool
    command -v "$1" >/dev/null && return 1
    echo "$1 is not installed: skipped"
}

# result TOOL FILE: what it found.
result() {
    if [ -s "$2" ]; then
        head -n 60 "$2"
        echo "$1: findings"
        failed=1
    else
        echo "$1: nothing found"
    fi
}

if ! missing gcc; then
    for file in src/*.c src/*/*.c; do
        # shellcheck disable=SC2086
        gcc -std=c11 -D_GNU_SOURCE -Iinclude -Isrc ${DEP_CFLAGS:-} -O2 -fanalyzer \
            -Wall -Wextra -Wshadow -Wstrict-prototypes -Wmissing-prototypes \
            -Wundef -Wvla -c "$file" -o "$work/o" 2>>"$work/gcc"
    done
    result 'gcc -fanalyzer' "$work/gcc"
fi
if ! missing cppcheck; then
    cppcheck --quiet --std=c11 --enable=warning,performance,portability \
        --inline-suppr --error-exitcode=1 -Iinclude -Isrc src 2>"$work/cppcheck"
    result cppcheck "$work/cppcheck"
fi
if ! missing clang-tidy; then
    # one file at a time: in a row it loses track of va_start
    for file in src/*.c src/*/*.c; do
        # shellcheck disable=SC2086
        clang-tidy --quiet "$file" -- -std=c11 -D_GNU_SOURCE -Iinclude -Isrc \
            ${DEP_CFLAGS:-} >>"$work/tidy" 2>/dev/null
    done
    result clang-tidy "$work/tidy"
fi
if ! missing valgrind; then
    # not test_line_search: valgrind's long double has the digits of a double
    for suite in newton sparse cholesky derivatives psd; do
        [ -x "build/release/tests/unit/test_$suite" ] || continue
        valgrind --quiet --error-exitcode=9 --leak-check=full \
            "build/release/tests/unit/test_$suite" >"$work/out" 2>"$work/err" ||
            { echo "test_$suite:" && cat "$work/err"; } >>"$work/valgrind"
    done
    for scene in square circle overshoot landscape; do
        valgrind --quiet --error-exitcode=9 --leak-check=full \
            --errors-for-leak-kinds=definite "${ELASTO:-build/elasto}" \
            "$scene" --headless --steps 2 --quiet --log "$work/l.csv" \
            --frames "$work/frames" >"$work/out" 2>"$work/err" ||
            [ $? = 3 ] || # not converged, as the scene means to show
            { echo "$scene:" && cat "$work/err"; } >>"$work/valgrind"
    done
    touch "$work/valgrind"
    result valgrind "$work/valgrind"
fi
exit $failed
