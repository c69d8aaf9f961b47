#!/bin/sh
# Tests of the tests: puts each fault of tests/data/mutants.txt into a copy of
# the sources, one at a time, and runs suites and shell checks until one fails.
# `make mutants ARGS=word` takes only the lines that contain the word;
# ARGS=--check only looks whether each fault stands where the list says.
# JOBS faults are tried at once, each job in a copy of its own.
set -u
make=${MAKE:-make}
jobs=${JOBS:-2}
list=tests/data/mutants.txt
word=${1:-}
if [ "$word" = --check ]; then
    exec perl tests/checks/mutate.pl check "$list"
fi
perl tests/checks/mutate.pl check "$list" || exit 1

# What runs for a fault in this file, until something fails: the suite of the
# module's own name, then those that know most about its room.
numeric='newton derivatives line_search solvers averaged integrators cholesky
    supernodes sparse explicit reference orders scenes stress'
killers_for() { # file
    module=$(basename "${1%.*}")
    own=
    for name in "$module" "${module%_energy}" "${module#square_}"; do
        [ ! -f "tests/unit/test_$name.c" ] || own="$own $name"
    done
    case $1 in
    */model/*psd.[ch] | */model/*_energy.[ch])
        own="$own psd derivatives averaged body hand" ;;
    */model/*) own="$own derivatives body barrier mesh" ;;
    */solve/hand_over.c) own="$own solvers" ;;
    */solve/grid* | */solve/v_cycle* | */solve/tips.c | */solve/plane_*)
        own="$own multigrid solvers" ;;
    */base/quartic.[ch]) own="$own line_search solvers" ;;
    */step/*) own="$own integrators averaged explicit orders" ;;
    esac
    case $1 in
    */base/one_line.[ch]) echo options ;;
    */base/* | */model/* | */solve/* | */step/*) echo "$own $numeric" ;;
    */scenes/*option* | */scenes/nearest.[ch])
        echo "options command check_faults.sh" ;;
    */scenes/*) echo "$own scenes exhibits options command picture" \
        "check_scenes.sh check_window.sh stress" ;;
    */picture/*) echo "$own picture layout exhibits scenes check_window.sh" ;;
    */play/output.[ch] | */play/recording.[ch])
        echo "$own picture check_files.sh command check_faults.sh" \
            "check_window.sh" ;;
    */play/*) echo "$own picture layout command check_window.sh check_files.sh" \
        "check_scenes.sh check_faults.sh" ;;
    *) echo "command check_files.sh check_faults.sh check_window.sh" ;;
    esac
}

# run_killer NAME: in the tree where it is called; 0: it passes, 1: it fails,
# 2: it does not compile, 9: there is no such suite.
run_killer() {
    case $1 in
    *.sh)
        [ -f "tests/checks/$1" ] || return 9
        $make -s build/elasto CC="${CC:-cc}" CFLAGS="$flags" >log 2>&1 ||
            return 2
        ELASTO=build/elasto timeout 300 sh "tests/checks/$1" >log 2>&1 ||
            return 1
        ;;
    *)
        [ -f "tests/unit/test_$1.c" ] || return 9
        rm -f "build/release/tests/unit/test_$1"
        $make -s suites build/elasto \
            SUITES="build/release/tests/unit/test_$1" CC="${CC:-cc}" \
            CFLAGS="$flags" >log 2>&1 || return 2
        ELASTO=build/elasto timeout 120 "build/release/tests/unit/test_$1" \
            >log 2>&1 || return 1
        ;;
    esac
}
flags='-O1 -fno-strict-aliasing'

# try_fault LINE: one line about what became of it.
try_fault() {
    text=$(sed -n "${1}p" "$list")
    reason=$(printf '%s\n' "$text" | awk -F ' @@ ?' '{ print $5 }')
    file=$(perl tests/checks/mutate.pl put "$list" "$1")
    by=
    for killer in $(killers_for "$file"); do
        run_killer "$killer"
        case $? in
        1) by=$killer ;;
        2) by='the compiler' ;;
        *) continue ;;
        esac
        break
    done
    cp -p "../original/$file" "$file"
    touch "$file"
    if [ "$by" = 'the compiler' ]; then
        echo "does not compile: $text"
    elif [ -n "$by" ]; then
        echo "killed by $by: $text"
    elif [ -n "$reason" ]; then
        echo "cannot be seen: $text"
    else
        echo "SURVIVED: $text"
    fi
}

rm -rf build/mutants
mkdir -p build/mutants/original
cp -pR Makefile README.md include src tests build/mutants/original || exit 1
grep -nE '^[^#]' "$list" | grep -F -e "$word" | cut -d: -f1 \
    >build/mutants/chosen
[ -s build/mutants/chosen ] || {
    echo "no fault contains '$word'"
    exit 1
}
cd build/mutants || exit 1
for job in $(seq "$jobs"); do
    cp -pR original "$job"
done

# Without any fault everything passes that will be asked.
: >asked
while read -r line; do
    place=$(sed -n "${line}s/ @@.*//p" "original/$list")
    for file in $(ls "original/$place" "original/src/$place"/*.c \
        "original/include/$place"/*.h 2>/dev/null); do
        killers_for "${file#original/}"
    done
done <chosen | tr ' ' '\n' | sed '/^$/d' | sort -u >asked
(
    cd 1 || exit 1
    for killer in $(cat ../asked); do
        run_killer "$killer"
        case $? in
        0 | 9) ;;
        *)
            tail -n 20 log
            echo "$killer fails without any fault"
            exit 1
            ;;
        esac
    done
) || exit 1

# Each job takes every JOBS-th line.
for job in $(seq "$jobs"); do
    (
        cd "$job" || exit 1
        awk -v job="$job" -v jobs="$jobs" 'NR % jobs == job % jobs' ../chosen |
            while read -r line; do
                try_fault "$line" | tee -a ../results
            done
    ) &
done
wait
count() {
    grep -c "^$1" results
}
echo "$(count killed) of $(wc -l <chosen) killed," \
    "$(count 'cannot be seen') cannot be seen, $(count SURVIVED) survived," \
    "$(count 'does not compile') do not compile"
grep -E '^(SURVIVED|does not compile)' results
[ "$(($(count killed) + $(count 'cannot be seen')))" -eq "$(wc -l <chosen)" ]
