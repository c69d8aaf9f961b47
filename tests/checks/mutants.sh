#!/bin/sh
# Tests of the tests: puts each fault of tests/data/mutants.txt into a copy of the
# sources, one at a time, and runs suites of `make test` until one fails.
# `make mutants ARGS=word` takes only the lines that contain the word.
set -u
make=${MAKE:-make}
tree=build/mutants
word=${1:-}
rm -rf "$tree"
mkdir -p "$tree"
cp -pR Makefile README.md include src tests "$tree/" || exit 1
cd "$tree" || exit 1
flags='-O1 -fno-strict-aliasing'

# The suites that know most about a source come first.
suites_for() { # source
    case $1 in
    src/model/psd.c | include/model/psd.h) first='psd derivatives' ;;
    src/model/inertia_energy.c | */mass_spring_energy.?) first=derivatives ;;
    src/model/avf_energy.c) first='averaged derivatives' ;;
    src/base/sparse.c) first=sparse ;;
    src/solve/cholesky.c) first=cholesky ;;
    src/solve/supernodes.c) first=supernodes ;;
    src/model/square_mesh.c) first=mesh ;;
    src/solve/gauss_seidel.c) first=gauss_seidel ;;
    src/solve/line_search.c | src/base/quartic.c | src/solve/plane_search.c)
        first=line_search ;;
    src/step/*_methods.c | src/step/average_vector_field.c | src/step/backward_euler.c | \
        src/step/time_integrator.c) first='integrators averaged' ;;
    *) first= ;;
    esac
    echo "$first newton derivatives line_search solvers averaged" \
        "integrators cholesky supernodes gauss_seidel sparse reference orders" \
        "stress"
}

# build NAME: the suite, with whatever is in src now.
build() {
    [ -f "tests/unit/test_$1.c" ] || return 9
    $make -s suites SUITES="build/release/tests/unit/test_$1" CC="${CC:-cc}" \
        CFLAGS="$flags" >log 2>&1
}

# The suites as they are must pass.
for name in $(suites_for none); do
    build "$name"
    code=$?
    [ $code -ne 9 ] || continue
    if [ $code -ne 0 ] ||
        ! timeout 300 "build/release/tests/unit/test_$name" >log 2>&1; then
        cat log
        echo "test_$name fails without any fault"
        exit 1
    fi
done

killed=0
total=0
justified=0
: >survivors.txt
grep -v '^#' tests/data/mutants.txt | grep -F -e "$word" >chosen.txt
while IFS= read -r line; do
    [ -n "$line" ] || continue
    file=$(printf '%s\n' "$line" | awk -F ' @@ ?' '{ print $1 }')
    reason=$(printf '%s\n' "$line" | awk -F ' @@ ?' '{ print $4 }')
    total=$((total + 1))
    cp -p "$file" original
    # the only place where the old text stands, replaced
    if ! printf '%s\n' "$line" | awk -F ' @@ ?' -v file="$file" '
        NR == 1 { old = $2; new = $3 }
        END {
            while ((getline text < file) > 0) {
                at = index(text, old)
                if (at) {
                    found++
                    rest = substr(text, at + length(old))
                    found += index(rest, old) > 0
                    text = substr(text, 1, at - 1) new rest
                }
                print text
            }
            exit found != 1
        }' >mutant; then
        echo "stale: $line"
        exit 1
    fi
    cp mutant "$file"
    by=
    for name in $(suites_for "$file"); do
        rm -f "build/release/tests/unit/test_$name"
        build "$name"
        code=$?
        [ $code -ne 9 ] || continue
        if [ $code -ne 0 ]; then
            by=compiler
            break
        fi
        if ! timeout 120 "build/release/tests/unit/test_$name" >log 2>&1; then
            by=test_$name
            break
        fi
    done
    cp -p original "$file"
    touch "$file"
    rm -f build/release/tests/unit/test_*[!.o]
    if [ "$by" = compiler ]; then
        echo "does not compile: $line"
        exit 1
    elif [ -n "$by" ]; then
        killed=$((killed + 1))
        echo "$total killed by $by: $line" | cut -c 1-110
    elif [ -n "$reason" ]; then
        justified=$((justified + 1))
        echo "$total no test can see it: $reason"
    else
        echo "$total SURVIVED: $line"
        echo "$line" >>survivors.txt
    fi
done <chosen.txt
echo "$killed of $total killed, $justified cannot be seen," \
    "$((total - killed - justified)) survived"
cat survivors.txt
[ ! -s survivors.txt ]
