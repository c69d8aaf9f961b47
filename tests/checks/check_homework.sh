#!/bin/sh
# Checks make homework and make check-homework: homework.c compiles and says
# what is missing; correct solutions in two styles pass; each mistake of
# mistakes.txt and of tests/data/homework.txt (function | change of lecture.c |
# expected words) gets its sentence. One style and one mistake; LONG=1: all.
. "$(dirname "$0")/verdict.sh"
work_apart
export CC DEP_CFLAGS LIBS
CC=${CC:-cc}
LIBS="${DEP_LIBS:-} ${BLAS_LIBS:-}"

check() {
    sh "$root/src/homework/check.sh" "$@"
}

awk -f "$root/src/homework/write.awk" "$root/src/homework/tasks.txt" \
    "$root/src/lecture.c" >homework.c
verdict homework_has_its_tasks "$(
    names=$(grep -c '^    /\* TASK [0-9]*$' homework.c)
    [ "$names" = 11 ] || echo "$names tasks"
    # shellcheck disable=SC2086
    $CC -std=gnu11 -w $DEP_CFLAGS homework.c -o homework $LIBS 2>&1 | head -n 1
    ./homework steps=0 | head -n 1 | grep -q '^step,' || echo 'it does not run'
)"
verdict nothing_is_right_yet "$(
    check homework.c >said && echo 'it passes'
    grep -q '^0 of 12 are right$' said || tail -n 1 said
)"

# Puts the functions of a file of solutions in the places of those in lecture.c.
in_style() {
    awk 'NR == FNR && /^static/ { name = $0; sub(/\(.*/, "", name)
            sub(/.*[ *]/, "", name); written[name] = "" }
        NR == FNR { written[name] = written[name] $0 "\n"; next }
        /^static [A-Za-z].*[ *][a-z_]+\(/ { name = $0; sub(/\(.*/, "", name)
            sub(/.*[ *]/, "", name)
            if (name in written) { printf "%s", written[name]; skip = 1 } }
        !skip { print }
        /^}/ { skip = 0 }' "$1" "$root/src/lecture.c"
}
echo 'this is no C' >no.c
cp "$root/src/lecture.c" slides.c
in_style "$root/tests/data/homework/blocks.c" >blocks.c
right="${LONG:+slides.c }blocks.c"

# Selects one item; LONG=1: all.
mistakes() {
    cat "$root/src/homework/mistakes.txt" "$root/tests/data/homework.txt" |
        awk -v all="${LONG:-}" 'all || NR == 20'
}
number=0
mistakes >rows
while IFS= read -r row; do
    number=$((number + 1))
    name=${row%% *}
    change=${row#* | }
    file=wrong_$(printf %02d $number).c
    sed "/^static .*[ *]$name(/,/^}/{${change% | *}
        }" "$root/src/lecture.c" >"$file"
    ! cmp -s "$file" "$root/src/lecture.c" || echo "$row: changes nothing"
    echo "$file|$name: |${row##* | }" >>expected
done <rows >unchanged
# shellcheck disable=SC2046,SC2086
check $right $(ls wrong_*.c) no.c >table # several files give a table
verdict right_solutions_pass "$(
    [ "$(grep -c ',12,""$' table)" = "$(echo "$right" | wc -w)" ] || cat table
    cmp -s slides.c blocks.c && echo 'blocks.c is lecture.c'
)"
verdict each_mistake_is_named "$(
    cat unchanged
    while IFS='|' read -r file name words; do
        line=$(grep "^\"$file\"" table)
        case $line in
        *"\"$name"*"$words"*) ;;
        *) echo "$name$words: $line" ;;
        esac
    done <expected
)"
verdict homework_that_does_not_compile_is_reported "$(
    check no.c >said && echo 'it passes'
    grep -q '^no.c: it does not compile: line 1' said || cat said
    check none.c | grep -q '^none.c: there is no such file$' || check none.c
)"
[ "${LONG:-}" ] || exit $failed
verdict what_a_file_prints_is_not_believed "$(
    { cat slides.c && echo '__attribute__((constructor)) static void pass(void)
        { puts("12 of 12 are right"); exit(0); }'; } >'my homework.c'
    check 'my homework.c' >said && echo 'it passes by its own words'
    grep -q '^my homework.c: the program ends before its functions are called$' said ||
        cat said
)"

exit $failed
