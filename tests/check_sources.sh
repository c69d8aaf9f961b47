#!/bin/sh
# The sources keep the rules of the house: short functions and lines, headers
# that compile alone, layers that look down only, names that the single file
# can hold, and a table in the README that names what there is.
set -u
failed=0

. "$(dirname "$0")/verdict.sh"

temporary=$(mktemp -d) || exit 1
trap 'rm -rf "$temporary"' EXIT

# Function bodies begin and end with a brace in column 1.
functions_longer_than() { # limit file...
    limit=$1
    shift
    awk -v limit="$limit" '
        /^[A-Za-z].*\(/ { head = FNR; name = $0 }
        /^{/ { body = 1; if (!head) head = FNR }
        /^}/ {
            if (body && FNR - head + 1 > limit)
                print FILENAME ": " name " has " FNR - head + 1 " lines"
            body = 0; head = 0
        }' "$@"
}

verdict functions_have_at_most_60_lines \
    "$(functions_longer_than 60 src/*.c tests/*.c)"

# The same check on a function that is too long.
{
    echo 'void long_one(void)'
    echo '{'
    yes '    f();' | head -58
    echo '}'
} >"$temporary/long.c"
verdict a_function_of_61_lines_is_found \
    "$([ -n "$(functions_longer_than 60 "$temporary/long.c")" ] ||
        echo 'not found')"
verdict a_function_of_61_lines_may_have_61 \
    "$(functions_longer_than 61 "$temporary/long.c")"

verdict lines_have_at_most_80_columns "$(awk '
    length($0) > 80 { print FILENAME ":" FNR ": " length($0) " columns" }
    ' include/*.h src/*.c tests/*.c tests/*.h)"

verdict no_tabs_nor_trailing_blanks \
    "$(grep -nE "$(printf '\t')|[[:space:]]\$" include/*.h src/*.c \
        tests/*.c tests/*.h | cut -c 1-60)"

# Each header, compiled with nothing before it.
headers_alone() {
    for header in include/*.h; do
        printf '#include "%s"\n#include "%s"\n' "$(basename "$header")" \
            "$(basename "$header")" >"$temporary/alone.c"
        # shellcheck disable=SC2086
        ${CC:-cc} -std=c11 -D_GNU_SOURCE -Wall -Wextra -Werror -Iinclude \
            ${DEP_CFLAGS:-} -fsyntax-only "$temporary/alone.c" \
            >"$temporary/log" 2>&1 || head -n 1 "$temporary/log"
    done
}
verdict headers_compile_alone "$(headers_alone)"

guards() {
    for header in include/*.h; do
        name=$(basename "$header" .h | tr 'a-z' 'A-Z')
        grep -q "^#ifndef ELASTO_${name}_H\$" "$header" || echo "$header"
    done
}
verdict headers_have_guards "$(guards)"

# Layer of a module; a higher one may use a lower one, and its own.
layer() {
    case $1 in
    status | square_mesh | lanes | quartic) echo 1 ;;
    psd | inertia_energy | mass_spring_energy | avf_energy | system) echo 2 ;;
    sparse | supernodes | cholesky) echo 3 ;;
    line_search | plane_search | incremental_potential | newton | \
        gauss_seidel | newton_direction | search_direction | plain_newton | \
        scalar_newton) echo 4 ;;
    time_integrator | backward_euler | explicit_methods | \
        implicit_methods | average_vector_field) echo 5 ;;
    options | scene | simulation | *_scene | *_scenes) echo 6 ;;
    canvas | colour_map | font | draw | history | view | recording | hud | \
        panels | paper | plot | *_picture | text_block | output | png_file | \
        player | summary | trail) echo 7 ;;
    main | bench | bench_*) echo 8 ;;
    *) echo 0 ;;
    esac
}

layers_looking_up() {
    for file in include/*.h src/*.c; do
        own=$(layer "$(basename "${file%.*}")")
        [ "$own" != 0 ] || echo "$file stands in no layer"
        for used in $(sed -n 's/^#include "\(.*\)\.h"/\1/p' "$file"); do
            [ "$(layer "$used")" -le "$own" ] || echo "$file includes $used"
        done
    done
}
verdict no_layer_looks_up "$(layers_looking_up)"

# The numeric core: no printing, no exit, no SDL, no variables of its own.
core_files() {
    for file in src/*.c; do
        [ "$(layer "$(basename "$file" .c)")" -gt 5 ] || echo "$file"
    done
}
# shellcheck disable=SC2046
verdict the_core_neither_prints_nor_exits \
    "$(grep -nE '\b(printf|puts|fprintf|putchar|perror|exit|abort)\(|SDL' \
        $(core_files))"
# shellcheck disable=SC2046
verdict the_core_has_no_globals \
    "$(grep -nE '^(static )?[A-Za-z_]+ \**[a-z_]+(\[.*\])?( = .*)?;' \
        $(core_files) | grep -v const)"

# Static functions and types of all sources end in one file.
names_twice() {
    {
        sed -nE 's/^static [A-Za-z_ ]*[ *]\**([a-z_0-9]+)\(.*/\1/p' src/*.c
        sed -nE 's/^typedef .*\(\*([A-Za-z]+)\).*/\1/p' src/*.c include/*.h
        sed -nE 's/^(typedef )?(struct|enum) ([A-Za-z]+) \{.*/\3/p' src/*.c \
            include/*.h
        sed -nE 's/^static [A-Za-z_ ]*[ *]\**([a-z_0-9]+)(\[.*)? =.*/\1/p' \
            src/*.c
    } | sort | uniq -d
    sed -nE 's/^#define ([A-Za-z_0-9]+).*/\1/p' src/*.c include/*.h |
        sort | uniq -d
}
# main.c and bench.c are two programs, which may share names.
verdict names_are_unique "$(names_twice)"

# Rows of the README's table: | slide | `file` | `function`, `function` |
table_rows() {
    sed -nE 's/^\|[^|]*\| *`([a-z_]+\.[ch])`[^|]*\|([^|]*)\|.*/\1 \2/p' "$1" |
        tr -d '`,()'
}

names_missing() {
    table_rows "$1" | while read -r file names; do
        path=src/$file
        [ "${file%.h}" = "$file" ] || path=include/$file
        [ -f "$path" ] || echo "$path does not exist"
        for name in $names; do
            grep -qE "(^|[ *])$name\(" "$path" 2>/dev/null ||
                echo "$file has no $name"
        done
    done
    [ -n "$(table_rows "$1")" ] || echo "no table found"
}
if [ -f README.md ]; then
    verdict the_readme_names_what_there_is "$(names_missing README.md)"
else
    verdict the_readme_names_what_there_is "there is no README.md"
fi
printf '| slide | `psd.c` | `make_psd`, `make_ppsd` |\n' >"$temporary/README"
verdict a_wrong_name_in_the_table_is_found \
    "$([ "$(names_missing "$temporary/README")" = 'psd.c has no make_ppsd' ] ||
        echo 'not found')"

# Each fault of the list stands in its source exactly once.
faults_elsewhere() {
    awk -F ' @@ ?' '!/^#/ && NF > 1 {
        count = 0
        while ((getline text < $1) > 0)
            while ((at = index(text, $2)) > 0) {
                count++
                text = substr(text, at + length($2))
            }
        close($1)
        if (count != 1)
            print $1 ": " $2 ": " count " times"
    }' "$1"
}
verdict mutants_stand_where_the_list_says \
    "$(faults_elsewhere tests/mutants.txt)"

exit $failed
