#!/bin/sh
# The same run gives the same bits, by every compiler at hand, with and without
# optimisation, with one and two BLAS threads asked for, in a window and
# without.  The squares have 48 segments, so that their fronts are large enough
# for BLAS to use threads and for sums to be taken in pieces.  `make same-bits`
# runs it; what is not installed is counted as skipped.
set -u
unset MAKEFLAGS MFLAGS MAKELEVEL # what is made below counts its own jobs
elasto=$(realpath "${ELASTO:-build/elasto}")
sources=$PWD
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failed=0
builds=0
skipped=0

# states PROGRAM: what it writes of three runs.
states() {
    "$1" --headless --quiet --segments 16 --steps 12 --solver newton \
        --states - &&
        "$1" --headless --quiet --segments 48 --steps 8 --states - &&
        "$1" --headless --quiet --segments 48 --steps 6 --solver multigrid \
            --stretch 0.7 --timestep 0.02 --states - &&
        "$1" --headless --quiet --segments 40 --steps 2 --integrator avf4 \
            --states -
}

# compare NAME FILE: its hash against that of the first of this kind.
compare() {
    hash=$(sha256sum <"$2" | cut -c 1-16)
    builds=$((builds + 1))
    printf '%-36s %s\n' "$1" "$hash"
    [ -s "$2" ] && [ "$(grep -c , "$2")" -gt 20000 ] || failed=1
    [ -n "$first" ] || first=$hash
    [ "$hash" = "$first" ] || failed=1
}

# A copy of the sources to build in, with the libraries that were found.
mkdir -p tree/build
for part in Makefile include src tests; do
    cp -R "$sources/$part" tree || exit 1
done
cp -p "$sources"/build/config.mk tree/build

# build COMPILER LEVEL [MACROS]: tree/build/elasto
build() {
    rm -f tree/build/elasto
    "${MAKE:-make}" -s -C tree build/elasto CC="$1" CFLAGS="$2 -w" \
        CPPFLAGS="${3:-}" \
        >log 2>&1 || tail -n 3 log
}

first=
for threads in 1 2; do
    ELASTO_THREADS=$threads states "$elasto" >table
    compare "build/elasto, threads: $threads" table
done
# Multigrid's loops for each width of registers: FAST, see grid_loops.h.
if grep -qw avx2 /proc/cpuinfo; then
    for width in '' '__attribute__((target(\"avx2\")))'; do
        build "${CC:-cc}" -O2 "-DFAST=\"$width\""
        [ ! -x tree/build/elasto ] || states tree/build/elasto >table
        compare "FAST=$width" table
    done
fi
for compiler in gcc clang; do
    for level in -O0 -O2 -O3; do
        if ! command -v "$compiler" >/dev/null; then
            echo "skipped $compiler $level: it is not installed"
            skipped=$((skipped + 1))
            continue
        fi
        build "$compiler" $level
        states tree/build/elasto >table
        compare "$compiler $level" table
    done
done

# A shorter run, because each step is drawn.
first=
if command -v xvfb-run >/dev/null; then
    "$elasto" --headless --segments 48 --steps 40 --quiet --states table
    compare 'without a window' table
    xvfb-run -a timeout 120 "$elasto" --segments 48 --steps 40 --quiet \
        --states table
    compare 'in a window' table
else
    echo 'skipped in a window: xvfb-run is not installed'
    skipped=$((skipped + 1))
fi
if [ "$failed" -eq 0 ]; then
    echo "$builds ways, one hash; $skipped skipped"
else
    echo 'the bits differ'
fi
exit "$failed"
