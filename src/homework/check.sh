#!/bin/sh
# Checks homework.
#   check.sh FILE       prints a line for each function: right, or its fault
#   check.sh FILE ...   writes a table: file, number of the twelve checks that are
#                       right, first fault
# CC, DEP_CFLAGS and LIBS come from make.
set -u
here=$(dirname "$0")
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
trap 'exit 1' INT TERM

# Uninitialised variables get an enormous value, so that most of them show.
pattern=-ftrivial-auto-var-init=pattern
echo 'int main(void) { return 0; }' >"$work/try.c"
${CC:-cc} $pattern "$work/try.c" -o "$work/try" 2>/dev/null || pattern=

functions=$(awk 'BEGIN { RS = "" } { printf "F(%s) ", $1 }' "$here/tasks.txt")

# Writes the functions of lecture.c with a mistake of mistakes.txt each, and the
# list of these functions.
write_mistakes() {
    number=0
    rows=
    while IFS= read -r row; do
        number=$((number + 1))
        name=${row%% *}
        change=${row#* | }
        sed -n "/^static .*[ *]$name(/,/^}/{${change% | *}
            s/$name(/${name}_$number(/
            p
            }" "$here/../lecture.c"
        rows="$rows{TASK_$name, (TaskFunction *)${name}_$number, \"${row##* | }\"},
"
    done <"$here/mistakes.txt"
    echo "static const Mistake mistakes[] = {${rows}{0, NULL, NULL}};"
}
write_mistakes >"$work/mistakes.h"
# shellcheck disable=SC2086
${CC:-cc} -std=gnu11 -w -O1 -I"$here/.." \
    -DMISTAKES="\"$work/mistakes.h\"" -DTASK_FUNCTIONS="$functions" $DEP_CFLAGS \
    -c "$here/check.c" -o "$work/check.o" || exit 1

# check FILE OBJECT [NAME]: checks one file; NAME: as a line of the table.  The
# output of the file itself is discarded.
check() {
    object=$work/$2
    name=$(realpath "$1" 2>/dev/null)
    # shellcheck disable=SC2086
    if [ ! -f "$1" ]; then
        problem='there is no such file'
    elif LC_ALL=C ${CC:-cc} -std=gnu11 -Wuninitialized -Wmaybe-uninitialized \
        -Werror=return-type -g1 -Og $pattern -DHOMEWORK="\"$name\"" \
        -DTASK_FUNCTIONS="$functions" \
        -fsanitize=address,undefined -fno-sanitize-recover=all $DEP_CFLAGS \
        -c "$here/student.c" -o "$object.o" 2>"$object.log" &&
        ${CC:-cc} -fsanitize=address,undefined "$work/check.o" "$object.o" \
            -o "$object" $LIBS 2>>"$object.log"; then
        note=$(awk -F "'" '/: In function / { name = $2 ": " }
            / warning: .*uninit/ { n = split($1, at, ":")
                print name "line " at[n - 3] ": " $2 \
                    " may be used before it has a value"; exit }' "$object.log")
        ASAN_OPTIONS=detect_leaks=0 "$object" "$note" ${3:+"$3"} \
            3>"$object.said" >/dev/null
        code=$?
        cat "$object.said"
        [ ! -s "$object.said" ] || return $code
        problem='the program ends before its functions are called'
    else
        problem="it does not compile: $(sed -n 's/^.*\.c:\([0-9]*\):.*error: /line \1: /p
            /undefined reference/p' "$object.log" | head -n 1 | tr '"' "'")"
    fi
    if [ "${3:-}" ]; then
        echo "\"$3\",0,\"$problem\""
    else
        echo "$1: $problem"
    fi
    return 1
}

if [ $# = 1 ]; then
    check "$1" homework
    exit
fi
echo file,right,first
jobs=$(nproc 2>/dev/null || echo 2)
part=0
while [ $part -lt "$jobs" ]; do
    (
        i=0
        for file in "$@"; do
            [ $((i % jobs)) != $part ] || check "$file" "$i" "$file"
            i=$((i + 1))
        done
    ) >"$work/part$part" &
    part=$((part + 1))
done
wait
cat "$work"/part* | sort
