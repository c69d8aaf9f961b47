#!/bin/sh
# Tests of the tests: puts each fault of tests/data/mutants.txt into a copy of
# the sources, one at a time, and runs suites and shell checks until one fails.
# `make mutants ARGS=word` takes only the lines that contain the word;
# ARGS=--check only looks whether each fault stands where the list says.
# JOBS faults are tried at once, each job in a copy of its own.  LIST is another
# list than tests/data/mutants.txt.  build/mutants/learnt.txt is the list with
# what killed each fault this time.
set -u
unset MAKEFLAGS MFLAGS MAKELEVEL # what is made below counts its own jobs
make=${MAKE:-make}
jobs=${JOBS:-2}
list=${LIST:-tests/data/mutants.txt}
case $list in
/*) ;;
*) list=$PWD/$list ;;
esac
word=${1:-}
if [ "$word" = --check ]; then
    exec perl tests/checks/mutate.pl check "$list"
fi
perl tests/checks/mutate.pl check "$list" || exit 1

# Everything that may notice a fault, what does so most likely and soonest first:
# what the list names, the suite of the module's own name, those that know most
# about its room, the other suites, then the checks of the program from outside.
numeric='newton terms line_search cholesky supernodes sparse integrators explicit
    reference orders scenes'
slow='contact multigrid solvers pages picture show track stress command'
checks='check_log.sh check_scenes.sh check_files.sh check_scripts.sh
    check_faults.sh check_pages.sh check_numbers.sh check_window.sh'
killers_for() { # file, what the list names
    module=$(basename "${1%.*}")
    own=$2
    for name in "$module" "${module%_energy}" "${module%%_*}"; do
        [ ! -f "tests/unit/test_$name.c" ] || own="$own $name"
    done
    case $1 in
    */model/barrier* | */model/contact* | */model/friction* | */model/cell* | \
        */model/plast* | */model/fract* | */step/prescribed*)
        own="$own terms barrier contact contact_scenes" ;;
    */model/*psd.[ch] | */model/*_energy.[ch])
        own="$own terms body" ;;
    */model/*) own="$own terms body barrier mesh" ;;
    */solve/newton_multigrid.c) own="$own solvers" ;;
    */solve/*grid* | */solve/v_cycle* | */solve/tiles.c)
        own="$own multigrid solvers" ;;
    */base/quartic.[ch]) own="$own line_search solvers" ;;
    */step/*) own="$own integrators explicit orders" ;;
    esac
    case $1 in
    */scenes/one_line.[ch] | */scenes/*option*)
        near='options command check_files.sh check_faults.sh' ;;
    */base/* | */model/* | */solve/* | */step/*) near=$numeric ;;
    */scenes/*) near='scenes exhibits options pages body lecture hand' ;;
    */picture/*) near='layout show exhibits picture' ;;
    */play/output.[ch] | */play/recording.[ch])
        near='picture check_files.sh command check_log.sh check_faults.sh' ;;
    */play/film.[ch] | */play/png*) near='film picture' ;;
    */play/*) near='session deeds player track picture layout hand command check_scripts.sh' ;;
    *) near='command check_files.sh check_faults.sh check_window.sh' ;;
    esac
    rest=
    for test in tests/unit/test_*.c; do
        name=$(basename "${test%.c}")
        case " $slow " in
        *" ${name#test_} "*) ;;
        *) rest="$rest ${name#test_}" ;;
        esac
    done
    # shellcheck disable=SC2086
    echo $own $near $rest $slow $checks | tr ' ' '\n' | awk '!seen[$0]++'
}

build() { # targets...
    "$make" -s "$@" CC="${CC:-cc}" CFLAGS="$flags" >log 2>&1 </dev/null
}
flags='-O1 -fno-strict-aliasing'

# run_killer NAME: in the tree where it is called; 0: it passes, 1: it fails,
# 2: it does not compile, 9: there is no such suite, or it has nothing of the
# file with the fault, so that its program is the same as without.  A suite ends
# at its first failure.  Processor time is limited, so that a busy machine kills
# no fault.
run_killer() {
    case $1 in
    *.sh)
        [ -f "tests/checks/$1" ] || return 9
        build build/elasto build/release/tests/unit/texts || return 2
        check_passes "$1" || check_passes "$1" || return 1 # not by chance
        ;;
    *)
        [ -f "tests/unit/test_$1.c" ] || return 9
        suite=build/release/tests/unit/test_$1
        if grep -q '"ELASTO"' "tests/unit/test_$1.c"; then
            build "$suite" build/elasto || return 2
        else
            build "$suite" || return 2
            ! cmp -s "$suite" "../clean/test_$1" || return 9
        fi
        (
            # shellcheck disable=SC3045
            ulimit -t 15 -c 0
            export ELASTO=build/elasto CMOCKA_TEST_ABORT=1
            timeout 300 "$suite" >log 2>&1 </dev/null || exit 1
        ) 2>/dev/null || return 1
        ;;
    esac
}
check_passes() { # name
    ELASTO=build/elasto timeout 300 sh "tests/checks/$1" >log 2>&1 </dev/null
}

# The fault of this line of the list is put in and taken out again; a compiled
# original comes back as it was.
put_in() { # line; into $file
    file=$(perl tests/checks/mutate.pl put "$list" "$1")
    object=build/release/$(echo "$file" | sed 's/^src\///; s/\.c$/.o/')
    case $file in
    *.c) mv "$object" object ;;
    *) : >object ;;
    esac
}
take_out() {
    cp -p "../original/$file" "$file"
    case $file in
    *.c) mv object "$object" ;;
    *) touch "$file" ;;
    esac
    # The listings in the program may have been made of the file with the fault.
    rm -f build/release/libelasto.a build/release/listing_text.[co]
}

# try_fault LINE: one line about what became of it.
try_fault() {
    text=$(sed -n "${1}p" "$list")
    reason=$(printf '%s\n' "$text" | awk -F ' @@ ?' '{ print $5 }')
    known=
    case $reason in
    'by '*) known=${reason#by } reason= ;;
    esac
    put_in "$1"
    by=
    for killer in $(killers_for "$file" "$known"); do
        case $killer in
        *.sh) [ -z "$reason" ] || continue ;; # the suites are enough then
        esac
        run_killer "$killer"
        case $? in
        1) by=$killer ;;
        2) by='the compiler' ;;
        *) continue ;;
        esac
        break
    done
    take_out
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
mkdir -p build/mutants/original build/mutants/taken
cp -pR Makefile README.md include src tests build/mutants/original || exit 1
cp "$list" build/mutants/list.txt || exit 1 # what is edited meanwhile is not it
list=$PWD/build/mutants/list.txt
grep -nE '^[^#]' "$list" | grep -F -e "$word" | cut -d: -f1 \
    >build/mutants/chosen
[ -s build/mutants/chosen ] || {
    echo "no fault contains '$word'"
    exit 1
}
cd build/mutants || exit 1
: >results

# Without any fault everything passes.
cp -pR original 1
(
    cd 1 || exit 1
    build test build/elasto || {
        tail -n 20 log
        echo 'tests fail without any fault'
        exit 1
    }
    mkdir ../clean
    for test in tests/unit/test_*.c; do
        cp "build/release/${test%.c}" ../clean
    done
) || exit 1
for job in $(seq 2 "$jobs"); do
    cp -pR 1 "$job"
done

# Each job takes the next line that nobody has.
for job in $(seq "$jobs"); do
    (
        cd "$job" || exit 1
        while read -r line; do
            mkdir "../taken/$line" 2>/dev/null || continue
            try_fault "$line" >"../taken/$line/result"
            tee -a ../results <"../taken/$line/result"
        done <../chosen
    ) &
done
wait
count() {
    grep -c "^$1" results
}
echo "$(count killed) of $(wc -l <chosen) killed," \
    "$(count 'cannot be seen') cannot be seen, $(count SURVIVED) survived," \
    "$(count 'does not compile') do not compile"
perl ../../tests/checks/mutate.pl learn "$list" . >learnt.txt
grep -E '^(SURVIVED|does not compile)' results
[ "$(($(count killed) + $(count 'cannot be seen')))" -eq "$(wc -l <chosen)" ]
