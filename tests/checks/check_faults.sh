#!/bin/sh
# Runs the program with faults in memory, files, kills, streams, locales and
# screens. Each run must end with the documented exit code, one line that says
# why, and no half file under a final name. LONG=1 tries more faults.
. "$(dirname "$0")/verdict.sh"
work_apart

preload=$work/faults.so
# shellcheck disable=SC2086 # CC may be two words
${CC:-cc} -std=c11 -D_GNU_SOURCE -O1 -shared -fPIC "$here/faults.c" \
    -o "$preload" -ldl || exit 1

begin_files() {
    rm -rf frames s.csv.part l.csv.part
    echo old >s.csv
    echo old >l.csv
}

# run_faulty KIND NUMBER: runs with a fault; sets $code, and `error` has the
# lines.
run_faulty() {
    begin_files
    # shellcheck disable=SC2086
    timeout 300 env FAULT="$1" FAULT_AT="$2" FAULT_FILE="$work/count" \
        LD_PRELOAD="$preload" "$elasto" --headless --steps 2 --segments 2 \
        --quiet --states s.csv --log l.csv --frames frames --size 160x120 \
        >out 2>error
    code=$?
}

# Checks that tables are either the old ones, or whole ones of so many nodes.
check_table() { # name first-line nodes-or-0
    [ -f "$1" ] || return 0
    [ "$(cat "$1")" != old ] || return 0
    [ "$(head -n 1 "$1" | cut -d, -f1-2)" = "$2" ] || echo "$1: first line"
    [ "$(tail -c 1 "$1" | od -An -c | tr -d ' ')" = '\n' ] ||
        echo "$1: ends within a line"
    awk -F, -v name="$1" -v nodes="$3" 'NR == 1 { n = NF }
        NF != n { bad = 1 }
        END { if (bad || (nodes && (NR - 1) % nodes))
                  print name ": half a table" }' "$1"
}

printf '\211PNG\r\n\032\n' >png_begin
printf 'IEND\256B`\202' >png_end
check_pictures() {
    for picture in frames/*.png; do
        [ -f "$picture" ] || continue
        { head -c 8 "$picture" | cmp -s - png_begin &&
            tail -c 8 "$picture" | cmp -s - png_end; } ||
            echo "$picture: half a picture"
    done
}

check_files() {
    check_table s.csv step,time 9
    check_table l.csv step,iteration 0
    check_pictures
}

# Checks failure NUMBER of KIND: exit 1 and one line with these words, or exit 0
# and silence if the failed call was not needed.
check_fault() { # kind number words
    run_faulty "$1" "$2"
    case $code-$(wc -l <error) in
    0-0) ;;
    1-1) grep -qE "^elasto: .*($3)|^libgomp: Out of memory" error ||
        echo "$1 $2: $(cat error)" ;;
    *) grep -q '^libgomp: Out of memory' error || # libgomp has its own lines
        echo "$1 $2: exit $code: $(head -n 2 error)" ;;
    esac
    check_files | sed "s|^|$1 $2: |"
}

# Lets calls of a kind fail one by one: about 12 (LONG: 150) of all calls, since
# fonts alone make thousands of allocations.
faults_of() { # name kind words
    run_faulty "$2" 0
    total=$(cat count)
    most=12
    [ -z "${LONG:-}" ] || most=150
    stride=$((total / most + 1))
    at=1 ended=0
    : >reasons
    while [ "$at" -le "$total" ]; do
        check_fault "$2" "$at" "$3" >>reasons
        [ "$code" -eq 0 ] || ended=$((ended + 1))
        at=$((at + stride))
    done
    [ "$ended" -gt 0 ] || echo "none of $total $2 faults was noticed" >>reasons
    verdict "$1" "$(head -n 5 reasons)"
}

# SDL reports every failure in the same way; OpenMP ends the program itself.
if [ -z "${SANITIZE:-}" ]; then # a sanitizer replaces malloc
    faults_of memory_fails_once memory \
        'not enough memory|Cannot allocate memory|drawing failed'
    faults_of renames_fail rename \
        '(s.csv|l.csv|frames/frame_00000..png): Input/output'
fi

# ---- kills ------------------------------------------------------------------
# Checks that killed runs leave only whole files under final names.
kills() {
    for delay in 0.02 0.05 0.1 0.2; do
        begin_files
        "$elasto" --headless --segments 2 --quiet --steps 100000 \
            --states s.csv --log l.csv --frames frames --size 160x120 \
            >out 2>&1 &
        child=$!
        until_there s.csv.part
        sleep $delay
        kill -s KILL "$child"
        wait "$child" 2>/dev/null
        check_files
    done
}
verdict kills_leave_no_half_file "$(kills 2>/dev/null)"

# ---- streams and locales ----------------------------------------------------
# Checks that a file does not take the number of a closed stream.
closed_streams() { # rows of: exit code, redirection, arguments
    while IFS='|' read -r expected closed arguments; do
        rm -f s.csv
        : >error
        eval "\"\$elasto\" --headless --steps 2 --segments 2 $arguments \
            >out 2>error <&- $closed"
        code=$?
        [ $code = "$expected" ] || echo "$closed, $arguments: exit $code"
        check_table s.csv step,time 9
        case $closed$code in
        '>&-1') grep -q '^elasto: .*: Bad file descriptor' error || cat error ;;
        esac
    done <<'END'
0|>&- 2>&-|--quiet
1|>&-|
1|>&-|--states -
1|2>&-|--states nowhere/s.csv
END
}
verdict streams_may_be_closed "$(closed_streams)"

# The shell may have inherited an ignored SIGPIPE.
reset_pipe=
! env --default-signal=PIPE true 2>/dev/null ||
    reset_pipe='env --default-signal=PIPE'
verdict broken_pipes_end_the_run "$(
    {
        $reset_pipe "$elasto" --headless --steps 100000 --states - 2>error ||
            echo $? >code
    } | head -n 1 >/dev/null
    [ "$(cat code)" = 1 ] || echo "exit $(cat code)"
    [ "$(cat error)" = 'elasto: standard output: Broken pipe' ] || cat error
)"

# The program never calls setlocale, so numbers have a point in any locale.
verdict locales_change_nothing "$(grep -rn setlocale "$root/src")"

# ---- screens ----------------------------------------------------------------
# Runs without a usable screen; libraries below SDL leak while they look for
# one.
screens() {
    for setting in A=1 DISPLAY=:9977 SDL_VIDEODRIVER=dummy \
        SDL_VIDEODRIVER=nonsense; do
        rm -rf frames
        env ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0" \
            "$setting" timeout 300 "$elasto" --steps 2 --quiet --size 160x120 \
            >out 2>error || echo "$setting: exit $?"
        [ "$(wc -l <error)" -eq 1 ] && grep -q '^no screen: .*frames/$' error ||
            echo "$setting: $(cat error)"
        [ "$(find frames -name '*.png' | wc -l)" -eq 3 ] ||
            echo "$setting: frames"
        check_pictures
    done
    rm -r frames
    "$elasto" --steps 2 --quiet --film a.apng 2>error
    [ ! -e frames ] || echo 'a film has pictures, too'
}
verdict screens_may_be_missing "$(screens)"

exit $failed
