#!/bin/sh
# Which lines of our own code the suites run: `make coverage`.  Builds apart,
# in build/coverage, without optimisation.
set -u
unset MAKEFLAGS MFLAGS MAKELEVEL # what is made below counts its own jobs
make=${MAKE:-make}
limit=95
$make suites build/coverage/elasto VARIANT=coverage CC=gcc \
    CFLAGS='-O0 -g --coverage' V=0 >/dev/null || exit 1
find build/coverage -name '*.gcda' -exec rm -f {} +
for suite in build/coverage/tests/unit/test_*; do
    [ -x "$suite" ] || continue
    case $suite in *.*) continue ;; esac
    ELASTO=build/coverage/elasto BENCH=build/coverage/elasto-bench \
        timeout 600 "$suite" >build/coverage/log 2>&1 ||
        echo "$suite failed: see build/coverage/log"
done
for check in scenes faults window; do
    ELASTO=build/coverage/elasto sh tests/checks/check_$check.sh \
        >build/coverage/log 2>&1 || echo "check_$check.sh failed"
done

# gcov prints "File 'src/base/x.c'" and then "Lines executed:97.10% of 69".
mkdir -p build/coverage/gcov
rm -f build/coverage/gcov/*
gcov -r -s "$(pwd)" build/coverage/*.gcda build/coverage/*/*.gcda \
    >build/coverage/gcov/summary \
    2>/dev/null
mv ./*.gcov build/coverage/gcov/

# Pictures, files, programs and the benchmark are not the core.
shown='^src/(main.c|lecture.c|picture/|play/|bench/)'
awk -v limit=$limit -v shown="$shown" '
    /^File / { file = $2; gsub(/\047/, "", file) }
    /^Lines executed:/ && file ~ /^src\// {
        split($0, part, /[:% ]+/)
        lines = $NF; share = part[3]
        run = lines * share / 100
        printf "%-32s %6.1f %% of %4d lines\n", file, share, lines
        all += lines; ran += run
        if (file !~ shown) {
            core += lines; core_ran += run
        }
        file = ""
    }
    END {
        printf "all of src                       %6.1f %% of %4d lines\n",
            100 * ran / all, all
        printf "core and set-up                  %6.1f %% of %4d lines\n",
            100 * core_ran / core, core
        exit 100 * core_ran / core < limit
    }' build/coverage/gcov/summary
code=$?
echo 'lines that no suite runs:'
(cd build/coverage/gcov && grep -H '^ *#####:' ./*.c.gcov) |
    sed -E 's/^\.\/(.*)\.gcov: *#####: *([0-9]+):/  \1:\2:/' |
    cut -c 1-79
exit $code
