#!/bin/sh
# The one-file demo: one compiler line, and the same trajectories to the last
# bit as the program made of modules.
set -u
temporary=$(mktemp -d) || exit 1
trap 'rm -rf "$temporary"' EXIT
program=${ELASTO:-build/elasto}
failed=0

verdict() { # name reason
    if [ -z "$2" ]; then
        echo "ok $1"
    else
        echo "not ok $1: $2"
        failed=1
    fi
}

# shellcheck disable=SC2086
${CC:-cc} -std=c11 -O2 -ffp-contract=off build/elasto_single.c \
    -o "$temporary/single" ${DEP_CFLAGS:-} ${DEP_LIBS:-} \
    >"$temporary/log" 2>&1
verdict one_line_compiles "$(head -n 1 "$temporary/log")"

same() { # options
    for exe in "$program" "$temporary/single"; do
        # shellcheck disable=SC2086
        "$exe" --headless --quiet --states - $1 >"$temporary/out" 2>&1 ||
            echo "$exe $1 failed"
        cksum <"$temporary/out"
        grep -c , "$temporary/out"
    done | sort -u | wc -l | grep -qx 2 || echo "not the same: $1"
}
verdict default_run_is_the_same "$(same '--steps 50')"
verdict large_run_is_the_same "$(same '--segments 20 --steps 5')"
verdict lagged_run_is_the_same \
    "$(same '--segments 20 --steps 5 --solver lagged')"
verdict other_methods_are_the_same "$(
    for method in symplectic-euler bdf2 sdirk2 avf4; do
        same "--integrator $method --steps 20"
    done
)"
verdict other_scenes_are_the_same "$(
    same 'circle --steps 20'
    same 'landscape --steps 20'
)"

exit $failed
