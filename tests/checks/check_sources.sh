#!/bin/sh
# Checks rules of the sources that no linter knows: headers compile alone, rooms
# include only lower rooms, the core has no globals, and the table in the README
# names existing functions. (make analyse: layout and length of functions.)
# Rooms from the ground up; a room uses itself and those before it.
rooms='base model solve step simulation scenes lesson picture play bench web homework'
headers=$(echo include/*/*.h src/*/*.h)

. "$(dirname "$0")/verdict.sh"

temporary=$(mktemp -d) || exit 1
trap 'rm -rf "$temporary"' EXIT

# Compiles each header twice with nothing before it.
headers_alone() {
    for header in $headers; do
        printf '#include "%s"\n#include "%s"\n' "${header#*/}" "${header#*/}" \
            >"$temporary/alone.c"
        # shellcheck disable=SC2086
        ${CC:-cc} -std=c11 -D_GNU_SOURCE -Wall -Wextra -Werror -Iinclude -Isrc \
            ${DEP_CFLAGS:-} -fsyntax-only "$temporary/alone.c" \
            >"$temporary/log" 2>&1 || head -n 1 "$temporary/log"
    done
}
verdict headers_compile_alone "$(headers_alone)"

# Flags that change NaN or the order of sums must stop the build with a message.
fast_math() {
    for flag in -ffast-math -Ofast -ffinite-math-only; do
        for source in src/base/mathematics.c src/lecture.c; do
            # shellcheck disable=SC2086
            ${CC:-cc} -std=c11 -D_GNU_SOURCE -O2 $flag -Iinclude -Isrc \
                ${DEP_CFLAGS:-} -fsyntax-only $source 2>"$temporary/log" &&
                echo "$source is compiled with $flag"
            grep -q 'error.*no -ffast-math' "$temporary/log" ||
                head -n 1 "$temporary/log"
        done
    done
}
verdict fast_math_is_refused "$(fast_math)"

# The first line of a source says what the file is for.
sources_without_heading() {
    for source in src/*.c src/*/*.c; do
        head -n 1 "$source" | grep -q '^/\*' || echo "$source"
    done
}
verdict sources_begin_with_what_they_are_for "$(sources_without_heading)"

# Sets $number to the floor of a file: the index of its room, or 13 for
# programs.
floor() { # room/file, or file
    number=0
    for room in $rooms; do
        number=$((number + 1))
        case $1 in
        "$room"/*) return ;;
        esac
    done
    case $1 in
    */*) number=0 ;;
    *) number=13 ;;
    esac
}

includes_looking_up() {
    for file in $headers src/*.c src/*/*.c; do
        floor "${file#*/}"
        [ "$number" != 0 ] || echo "$file stands in no room"
    done
    grep '^#include "' $headers src/*.c src/*/*.c |
        while IFS=: read -r file used; do
            used=${used#*\"}
            used=${used%\"*}
            floor "${file#*/}"
            own=$number
            case $used in
            */*) ;;
            lecture.c) # compiled into the benchmark and the homework's check
                case $file in
                src/bench/bench.c | src/homework/check.c) continue ;;
                esac
                echo "$file includes $used" ;;
            *) echo "$file includes $used without its room" ;;
            esac
            floor "$used"
            [ "$number" -le "$own" ] || echo "$file includes $used"
        done
}
verdict no_room_looks_up "$(includes_looking_up)"

# Checks that files do not call each other in a circle: tsort orders the arrows
# "caller called" between objects.
arrows() {
    for source in src/*/*.c; do
        name=${source#src/}
        object=build/release/${name%.c}.o
        [ ! -f "$object" ] || nm -g "$object" | sed "s,^,$name ,"
    done | awk '
        NF == 4 && $3 ~ /[TDRB]/ { home[$4] = $1 }
        NF == 3 && $2 == "U" { used[$1 " " $3] }
        END {
            for (pair in used) {
                split(pair, part, " ")
                if (part[2] in home && home[part[2]] != part[1])
                    print part[1], home[part[2]]
            }
        }'
}
verdict files_call_in_no_circle \
    "$(arrows | tsort 2>&1 >/dev/null | sort -u)"

# Checks that include/ has only headers that other rooms use.
verdict headers_of_one_room_stay_in_it "$(
    for header in include/*/*.h; do
        name=${header#include/}
        grep -lF "#include \"$name\"" $headers src/*.c src/*/*.c |
            grep -qvE "^src/${name%%/*}/" || echo "$header"
    done)"

# Checks the numeric core: no printing, no exit, no SDL, no global variables.
core_files() {
    for room in base model solve step; do
        echo src/"$room"/*.c
    done
}
# shellcheck disable=SC2046
verdict the_core_neither_prints_nor_exits \
    "$(grep -nE '\b(printf|puts|fprintf|putchar|perror|exit|abort)\(|SDL' \
        $(core_files))"
# Libraries round these functions differently; base/mathematics.h replaces them.
# shellcheck disable=SC2046
verdict the_core_calls_its_own_mathematics \
    "$(grep -nE '(^|[^_a-z])(hypot|log|log1p|exp|pow|sin|cos)\(' \
        include/base/*.h include/model/*.h include/solve/*.h include/step/*.h \
        $(core_files) | grep -vE ':[0-9]+: (\*|/\*)|/\*.*(hypot|log|log1p|exp|pow|sin|cos)\(')"
# shellcheck disable=SC2046
verdict the_core_has_no_globals \
    "$(grep -nE '^(static )?[A-Za-z_]+ \**[a-z_]+(\[.*\])?( = .*)?;' \
        $(core_files) | grep -v const)"

# Prints the slide table of the README, | slide | functions of lecture.c |
# `file`: `function`, ... |, as lines "file function".
table_rows() {
    awk -F '|' '/^\|/ && $4 ~ /`[a-z_]+\.[ch]`/ {
        row = "`lecture.c` " $3 " " $4
        file = ""
        while (match(row, /`[^`]+`/)) {
            word = substr(row, RSTART + 1, RLENGTH - 2)
            row = substr(row, RSTART + RLENGTH)
            if (word ~ /\.[ch]$/)
                file = word
            else
                print file, word
        }
    }' "$1"
}

names_missing() {
    table_rows "$1" | while read -r file name; do
        path=$(find src include -name "$file")
        [ -f "$path" ] || echo "$file does not exist, or twice"
        grep -qE "(^|[ *])$name\(" "$path" 2>/dev/null ||
            echo "$file has no $name"
    done
    [ -n "$(table_rows "$1")" ] || echo "no table found"
}
verdict the_readme_names_what_there_is "$(names_missing README.md)"

# The limits are the lowest counts so far; `main` is the one twin.
if command -v perl >/dev/null; then
    verdict comments_stand_alone_and_names_are_of_one_file \
        "$(perl tests/checks/comments.pl 'leans=0 subject=18 twins=1' 2>&1)"
else
    echo 'skipped comments_stand_alone_and_names_are_of_one_file: no perl'
fi

# Checks that each fault of the list fits its source exactly once.
if command -v perl >/dev/null; then
    verdict mutants_stand_where_the_list_says \
        "$(perl tests/checks/mutants.pl --check 2>&1)"
else
    echo 'skipped mutants_stand_where_the_list_says: no perl'
fi

exit $failed
