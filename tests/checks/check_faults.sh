#!/bin/sh
# What can go wrong around a run goes wrong: memory, files, kills, streams,
# locales, screens.  Each must end as documented: the right exit
# code, one line that says why, no half file under a final name.  A selection of
# the slow ones, LONG=1 a larger one, FAULTS=all everything (some minutes).
. "$(dirname "$0")/verdict.sh"
work_apart
all=${FAULTS:-}
long=${LONG:-}$all

# With sanitizers the faults are linked in, and leaks show; else they are
# preloaded, and reach into the libraries.
if [ -n "${SANITIZE:-}" ]; then
    faulty=$elasto-faults
    preload=
else
    faulty=$elasto
    preload=$work/faults.so
    "${CC:-cc}" -std=c11 -D_GNU_SOURCE -O1 -shared -fPIC "$here/faults.c" \
        -o "$preload" -ldl || preload=
fi

begin_files() {
    rm -rf frames s.csv.part l.csv.part
    echo old >s.csv
    echo old >l.csv
}

# run_faulty KIND NUMBER ALL ARGUMENTS...: code in $code, lines in "error".
run_faulty() {
    kind=$1 at=$2 every=$3
    shift 3
    begin_files
    timeout 300 env ${every:+FAULT_ALL=1} FAULT="$kind" FAULT_AT="$at" \
        FAULT_FILE="$work/count" LD_PRELOAD="$preload" "$faulty" --headless \
        --steps 2 --segments 2 --quiet --states s.csv --log l.csv "$@" \
        >out 2>error
    code=$?
}

# The tables under their final names: what was there before, or whole ones of
# so many nodes.
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

# Failure NUMBER of KIND: exit 1 and one line; and if what failed was not
# needed, exit 0 and silence.
check_fault() { # kind number all words arguments...
    what="$1 $2${3:+ and on}" words=$4
    kind=$1 number=$2 every=$3
    shift 4
    run_faulty "$kind" "$number" "$every" "$@"
    case $code-$(wc -l <error) in
    0-0) ;;
    1-1) grep -qE "^elasto: .*($words)|^libgomp: Out of memory" error ||
        echo "$what: $(cat error)" ;;
    *) grep -q '^libgomp: Out of memory' error || # its own lines
        echo "$what: exit $code: $(head -n 2 error)" ;;
    esac
    check_files | sed "s|^|$what: |"
}

# Each call of a kind in turn; of many, some 12 (LONG: 150) spread over all of
# them, for fonts alone make thousands of allocations (FAULTS=all: each).  words:
# what the one line must say.
faults_of() { # name kind all words step arguments...
    name=$1 kind=$2 every=$3 words=$4 stride=$5
    shift 5
    if [ -z "$preload" ] && [ -z "${SANITIZE:-}" ]; then
        verdict "$name" 'the library of faults was not built'
        return
    fi
    run_faulty "$kind" 0 '' "$@"
    total=$(cat count)
    most=12
    [ -z "$long" ] || most=150
    [ "$total" -le $((most * stride)) ] || stride=$((total / most + 1))
    [ -z "$all" ] || stride=1
    at=1 ended=0
    : >reasons
    while [ "$at" -le "$total" ]; do
        check_fault "$kind" "$at" "$every" "$words" "$@" >>reasons
        [ "$code" -eq 0 ] || ended=$((ended + 1))
        at=$((at + stride))
    done
    [ "$ended" -gt 0 ] || echo "none of $total $kind faults was noticed" \
        >>reasons
    verdict "$name" "$(head -n 5 reasons)"
}

# SDL reports every failure in the same way; OpenMP ends the program itself.
memory='not enough memory|Cannot allocate memory|drawing failed'
space='(s.csv|l.csv|frames/frame_00000..png): (No space left|Input/output)'
slow=1
[ -z "${SANITIZE:-}" ] || slow=7
frames='--frames frames --size 160x120'
larger='--frames frames --size 400x300'
# shellcheck disable=SC2086
{
    faults_of memory_fails_once memory '' "$memory" $slow $frames
    faults_of memory_fails_for_good memory 1 "$memory" $slow
    faults_of multigrid_memory_fails memory '' "$memory" $((5 * slow)) \
        --segments 20 --solver multigrid
    faults_of files_do_not_open open '' \
        '(s.csv|l.csv|frame_00000..png): Too many' 1 $frames
    faults_of writes_fail_once write '' "$space" 1 $larger
    faults_of writes_fail_for_good write 1 "$space" $slow $larger
    faults_of closes_fail close '' "$space" 1 $frames
    faults_of renames_fail rename '' "$space" 1 $frames
    faults_of folders_cannot_be_made folder '' 'frames: No space left' 1 $frames
}

# ---- kills ------------------------------------------------------------------
# Whatever is killed: what stands under a final name is whole.  Half of all
# victims at least must have been caught while they wrote.
kills() {
    caught=0
    for round in $(seq "$1"); do
        begin_files
        "$elasto" --headless --segments 2 --quiet --steps 100000 \
            --states s.csv --log l.csv --frames frames --size 160x120 \
            >out 2>&1 &
        child=$!
        [ $((round % 2)) = 1 ] || until_there s.csv.part # when it has written
        sleep "0.0$((round * 7 % 90 + 10))"
        kill -s KILL "$child"
        wait "$child" 2>/dev/null
        [ ! -s s.csv.part ] || caught=$((caught + 1))
        check_files
    done
    [ $((2 * caught)) -ge "$1" ] || echo "only $caught of $1 had written"
}
rounds=4
[ -z "$long" ] || rounds=50
[ -z "$all" ] || rounds=500
verdict kills_leave_no_half_file "$(kills "$rounds" 2>/dev/null)"

# ---- streams and locales ----------------------------------------------------
# A table must not become the output.
closed_streams() { # code, then what closes, arguments
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
0|>&-|--quiet --states s.csv
1|>&-|
1|>&-|--states s.csv
1|>&-|--states -
0|2>&-|--states s.csv
1|2>&-|--states nowhere/s.csv
END
}
verdict streams_may_be_closed "$(closed_streams)"

# A parent may have left SIGPIPE ignored.
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

# Numbers have a point in any locale: nobody asks for the user's.
verdict locales_change_nothing "$(grep -rn setlocale "$root/src")"

# ---- screens ----------------------------------------------------------------
# Libraries below SDL leak when it looks for a screen.
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
}
verdict screens_may_be_missing "$(screens)"

exit $failed
