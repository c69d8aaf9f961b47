#!/bin/sh
# Tests of the tests: puts each fault of tests/data/mutants.txt into a copy of
# the sources, one at a time; the suite or check that the list names must fail.
# `make mutants ARGS=word` takes only the lines that contain the word;
# ARGS=--check only looks whether each fault stands where the list says.
# JOBS faults are tried at once, each job in a copy of its own.
set -u
unset MAKEFLAGS MFLAGS MAKELEVEL # what is made below counts its own jobs
make=${MAKE:-make}
jobs=${JOBS:-2}
word=${1:-}
perl tests/checks/mutate.pl check tests/data/mutants.txt || exit 1
[ "$word" != --check ] || exit 0

build() { # targets...
    "$make" -s "$@" CFLAGS='-O1 -fno-strict-aliasing' >log 2>&1 </dev/null
}

# In the tree where it is called; 0: passes, 1: fails, 2: does not compile.
# Processor time is limited, so that a busy machine kills no fault.
run_killer() { # name
    case $1 in
    *.sh)
        build build/elasto || return 2
        set -- sh "tests/checks/$1"
        ;;
    *)
        needed=build/release/tests/unit/test_$1
        ! grep -q '"ELASTO"' "tests/unit/test_$1.c" || needed="$needed build/elasto"
        # shellcheck disable=SC2086
        build $needed || return 2
        set -- "build/release/tests/unit/test_$1"
        ;;
    esac
    passes "$@" || { [ "$1" = sh ] && passes "$@"; } # a check may by chance
}
passes() { # command...
    (
        # shellcheck disable=SC3045
        ulimit -S -t 30 && ulimit -c 0 # a check may set its own
        export ELASTO=build/elasto CMOCKA_TEST_ABORT=1
        timeout -k 5 300 "$@" >log 2>&1 </dev/null || exit 1
    ) 2>/dev/null
}

# One line about what became of the fault of this line of the list.  A compiled
# original comes back as it was.
try_fault() { # line
    text=$(sed -n "${1}p" ../list)
    file=$(perl tests/checks/mutate.pl put ../list "$1")
    object=build/release/$(echo "$file" | sed 's/^src\///; s/\.[a-z]*$/.o/')
    [ ! -f "$object" ] || mv "$object" object
    run_killer "${text##* @@ by }"
    case $? in
    0) echo "SURVIVED: $text" ;;
    1) echo "killed: $text" ;;
    *) echo "does not compile: $text" ;;
    esac
    cp -p "../original/$file" "$file"
    if [ -f object ]; then
        mv object "$object"
    else
        touch "$file" # others include it
    fi
    # The listings in the program may have been made of the file with the fault.
    rm -f build/release/libelasto.a build/release/texts.[co]
}

# A tree of its own: another run may be under way.
tree=$PWD/build/mutants.$$
trap 'rm -rf "$tree"' EXIT
trap 'exit 1' HUP INT TERM
mkdir -p "$tree/original" "$tree/taken"
cp -pR Makefile README.md include src tests "$tree/original" || exit 1
cd "$tree" || exit 1
cp original/tests/data/mutants.txt list
grep -an ' @@ ' list | grep -aF -e "$word" | grep -av '^[0-9]*:#' >chosen
[ -s chosen ] || {
    echo "no fault contains '$word'"
    exit 1
}
sed 's/.* @@ by //' chosen | sort -u >named

# Without any fault everything passes.
cp -pR original 1
while read -r killer; do
    (cd 1 && run_killer "$killer") || {
        tail -n 20 1/log
        echo "$killer fails, or does not compile, without any fault"
        exit 1
    }
done <named
for job in $(seq 2 "$jobs"); do
    cp -pR 1 "$job"
done

# Each job takes the next line that nobody has.
for job in $(seq "$jobs"); do
    (
        cd "$job" || exit 1
        while IFS=: read -r line _; do
            mkdir "../taken/$line" 2>/dev/null || continue
            try_fault "$line" | tee -a ../results
        done <../chosen
    ) &
done
wait
echo "$(grep -c ^killed results) of $(wc -l <chosen) killed"
! grep -v '^killed:' results
