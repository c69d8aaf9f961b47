#!/bin/sh
# Checks that a run has one hash: each scene after 50 steps, compiled by gcc and
# clang with -O0 to -O3, in a window, after going back, and squares so large
# that sums are split. `make same-bits` runs it; missing programs are counted as
# skipped.
set -u
elasto=$(realpath "${ELASTO:-build/elasto}")
library=$(realpath build/release/libelasto.a)
main=$(realpath build/release/main.o)
sources=$PWD
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
ways=0
skipped=0
failed=0

"$elasto" --list | sed 's/^ *[0-9]* //; s/ .*/ --steps 50/' >scenes
cat scenes - >lines <<'END'
square --segments 16 --steps 12 --solver newton
square --segments 48 --steps 8
square --segments 48 --steps 6 --solver multigrid --stretch 0.7 --timestep 0.02
square --segments 40 --steps 2 --integrator midpoint
END

# hashes LINES PROGRAM [OPTION...]: prints a hash for each line.
hashes() {
    list=$1
    program=$2
    shift 2
    while read -r line; do
        # shellcheck disable=SC2086
        "$program" $line "$@" 2>/dev/null |
            sed -n 's/^state hash *//p' | grep . || echo none
    done <"$list"
}

# compare NAME FILE: compares hashes with those of the first program.
compare() {
    [ -s first ] || {
        paste -d ' ' "$2" lines
        ! grep -qx none "$2" || failed=1
        cp "$2" first
    }
    ways=$((ways + 1))
    paste -d ' ' "$2" first lines | head -n "$(wc -l <"$2")" | awk -v name="$1" '
        $1 != $2 { bad++; print }
        END { printf "%-22s %d of %d lines differ\n", name, bad, NR
              exit bad > 0 }' || failed=1
}

hashes lines "$elasto" --headless >table
compare headless table

# Goes back to known steps, and on from there.
awk 'BEGIN { srand(1); print "0 play"
    for (newest = 9; newest < 50; newest += 9) {
        print newest, "pause"; at = newest
        for (i = 0; i < 3; i++) { to = int(rand() * newest)
            print at, "goto", to; at = to }
        print at, "play" } }' >script
hashes scenes "$elasto" --headless --script script >table
compare 'back and on' table

if command -v xvfb-run >/dev/null; then
    # shellcheck disable=SC2016
    xvfb-run -a sh -c 'while read -r line; do
        timeout 120 "$0" $line --size 300x200 --speed 8 2>/dev/null |
            sed -n "s/^state hash *//p" | grep . || echo none
        done <lines' "$elasto" >table
    compare 'in a window' table
else
    echo 'skipped in a window: xvfb-run is not installed'
    skipped=$((skipped + 1))
fi

# build COMPILER LEVEL: compiles the numeric rooms with this compiler, and links
# them with the other objects.
build() {
    rm -rf program objects
    mkdir objects
    (cd "$sources" && ls src/base/*.c src/model/*.c src/solve/*.c src/step/*.c \
        src/simulation/*.c src/scenes/*.c) | xargs -P "$(nproc)" -I FILE sh -c '
        cd "$0" && $1 $2 -std=c11 -D_GNU_SOURCE -Iinclude -Isrc -Ibuild/release \
            -ffp-contract=off -w $3 -c FILE -o "$4/$(echo FILE | tr / _).o"' \
        "$sources" "$1" "$2" "$DEP_CFLAGS" "$work/objects"
    # shellcheck disable=SC2086
    "$1" objects/*.o "$main" "$library" -o program $DEP_LIBS -lm
}
for compiler in gcc clang; do
    for level in -O0 -O2 -O3; do
        if ! command -v "$compiler" >/dev/null; then
            echo "skipped $compiler $level: it is not installed"
            skipped=$((skipped + 1))
            continue
        fi
        build "$compiler" "$level"
        hashes lines ./program --headless >table
        compare "$compiler $level" table
    done
done
# Loops of multigrid take the widest registers; those of clang the narrowest
# (FAST in grid_loops.h).
if grep -qw avx2 /proc/cpuinfo; then
    build "${CC:-cc}" '-O2 -DFAST=__attribute__((target("avx2")))'
    hashes lines ./program --headless >table
    compare 'registers of avx2' table
fi
echo "$ways ways, $(wc -l <lines) lines, $([ $failed = 0 ] && echo one hash each ||
    echo different hashes); $skipped skipped"
exit "$failed"
