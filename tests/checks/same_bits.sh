#!/bin/sh
# The same run gives the same bits: 200 default steps with 16 segments, by
# every compiler at hand, with and without optimisation, with one and two
# threads, in a window and without.  `make same-bits` runs it.
set -u
elasto=$(realpath "${ELASTO:-build/elasto}")
single=$(realpath build/elasto_single.c)
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
first=
failed=0
builds=0

# compare NAME FILE: its hash against the first.
compare() {
    hash=$(sha256sum <"$2" | cut -c 1-16)
    [ -n "$first" ] || first=$hash
    builds=$((builds + 1))
    printf '%-32s %s\n' "$1" "$hash"
    [ "$hash" = "$first" ] && [ -s "$2" ] || failed=1
}

run() { # program
    "$1" --headless --segments 16 --steps 200 --quiet --states - >states
}

for threads in 1 2; do
    OPENBLAS_NUM_THREADS=$threads OMP_NUM_THREADS=$threads run "$elasto"
    compare "build/elasto, threads: $threads" states
done
for compiler in gcc clang; do
    for level in -O0 -O2 -O3; do
        if ! command -v "$compiler" >/dev/null; then
            echo "$compiler is not installed: skipped"
            continue
        fi
        # shellcheck disable=SC2086
        "$compiler" -std=c11 -ffp-contract=off $level "$single" -o program \
            ${DEP_CFLAGS:-} ${DEP_LIBS:--lm} -w || failed=1
        run ./program
        compare "$compiler $level" states
    done
done
if command -v xvfb-run >/dev/null; then
    xvfb-run -a timeout 120 "$elasto" --segments 16 --steps 200 --quiet \
        --states - >states
    compare 'in a window' states
else
    echo 'xvfb-run is not installed: the window is skipped'
fi
if [ "$failed" -eq 0 ]; then
    echo "$builds ways, one hash"
else
    echo 'the bits differ'
fi
exit "$failed"
