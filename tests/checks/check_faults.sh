#!/bin/sh
# What can go wrong around a run goes wrong: memory, files, signals, streams,
# locales, screens, command lines.  Each must end as documented: the right exit
# code, one line that says why, no half file under a final name.  A selection of
# the slow ones, LONG=1 a larger one, FAULTS=all everything (some minutes).
set -u
failed=0
elasto=$(realpath "${ELASTO:-build/elasto}")
all=${FAULTS:-}
long=${LONG:-}$all
here=$(realpath "$(dirname "$0")")

# verdict NAME TRIED REASONS: one line for a test; reasons empty: it passed.
verdict() {
    if [ -z "$3" ]; then
        echo "ok $1 ($2 tried)"
    else
        echo "not ok $1: $(printf '%s' "$3" | head -n 5 | tr '\n' ';')"
        failed=1
    fi
}

work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
trap 'exit 1' INT TERM
cd "$work" || exit 1
unset DISPLAY WAYLAND_DISPLAY SDL_VIDEODRIVER

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

# run_faulty KIND NUMBER ALL ARGUMENTS...: code in $code, lines in "error".
run_faulty() {
    kind=$1 at=$2 every=$3
    shift 3
    if [ -n "$every" ]; then
        FAULT_ALL=1
        export FAULT_ALL
    else
        unset FAULT_ALL
    fi
    timeout 60 env FAULT="$kind" FAULT_AT="$at" FAULT_FILE="$work/count" \
        LD_PRELOAD="$preload" "$faulty" "$@" >out 2>error
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

begin_files() {
    rm -rf frames s.csv.part l.csv.part
    echo old >s.csv
    echo old >l.csv
}

# Failure NUMBER of KIND: exit 1 and one line; and if what failed was not
# needed, exit 0 and silence.
check_fault() { # kind number all words arguments...
    what="$1 $2${3:+ and on}"
    words=$4
    begin_files
    kind=$1 number=$2 every=$3
    shift 4
    run_faulty "$kind" "$number" "$every" --headless --steps 2 --segments 2 \
        --quiet --states s.csv --log l.csv "$@"
    if [ "$code" -eq 1 ] && grep -q '^libgomp: Out of memory' error; then
        : # its own line
    elif [ "$code" -eq 1 ]; then
        [ "$(wc -l <error)" -eq 1 ] ||
            echo "$what: $(wc -l <error) lines: $(head -n 2 error)"
        grep -qE "^elasto: .*($words)" error ||
            echo "$what: $(head -n 1 error)"
    elif [ "$code" -ne 0 ] || [ -s error ]; then
        echo "$what: exit $code: $(tail -n 1 error)"
    fi
    check_files | sed "s|^|$what: |"
}

# Each call of a kind in turn; of many, some 12 (LONG: 150) spread over all of
# them, for fonts alone make thousands of allocations (FAULTS=all: each).  words:
# what the one line must say.
faults_of() { # name kind all words step arguments...
    name=$1 kind=$2 every=$3 words=$4 stride=$5
    shift 5
    if [ -z "$preload" ] && [ -z "${SANITIZE:-}" ]; then
        verdict "$name" 0 'the library of faults was not built'
        return
    fi
    begin_files
    run_faulty "$kind" 0 '' --headless --steps 2 --segments 2 --quiet \
        --states s.csv --log l.csv "$@"
    total=$(cat count)
    most=12
    [ -z "$long" ] || most=150
    [ "$total" -le $((most * stride)) ] || stride=$((total / most + 1))
    [ -z "$all" ] || stride=1
    at=1 tried=0 ended=0
    : >reasons
    while [ "$at" -le "$total" ]; do
        check_fault "$kind" "$at" "$every" "$words" "$@" >>reasons
        [ "$code" -eq 0 ] || ended=$((ended + 1))
        at=$((at + stride))
        tried=$((tried + 1))
    done
    [ "$ended" -gt 0 ] || echo "none of $total $kind faults was noticed" \
        >>reasons
    verdict "$name" "$tried" "$(cat reasons)"
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

# ---- signals ----------------------------------------------------------------
# Processor time, so that a busy machine changes nothing: in ms, into $spent, of
# all children that have ended; and of one that runs.
ended_milliseconds() {
    times >clock
    spent=$(awk 'NR == 2 { gsub(/[ms]/, " ")
        print int(1000 * ($1 * 60 + $2 + $3 * 60 + $4)) }' clock)
}
running_milliseconds() { # process
    awk -v hertz="$(getconf CLK_TCK)" \
        '{ print int(1000 * ($14 + $15) / hertz) }' "/proc/$1/stat"
}

# A pause of 0.1 ... LIMIT/1000 s, another one each time.
random_pause() {
    pauses=$((${pauses:-0} + 1))
    sleep "$(awk -v seed="$((pauses * 7919 + $$))" -v limit="$1" \
        'BEGIN { srand(seed); printf "%.3f", 0.1 + rand() * limit / 1000 }')"
}

# What the slowest end at 128 segments took goes to "ends".
signals() {
    : >ends
    for round in $(seq "$1"); do
        for name in INT TERM; do
            rm -f s.csv l.csv
            "$elasto" --headless --segments 128 --solver multigrid --quiet \
                --steps 100000 --log l.csv 2>error &
            child=$!
            random_pause "$pause"
            used=$(running_milliseconds "$child")
            ended_milliseconds
            before=$spent
            kill -s "$name" "$child"
            wait "$child"
            code=$?
            ended_milliseconds
            echo $((spent - before - used)) >>ends
            [ "$code" -eq 0 ] || echo "$name: exit $code: $(cat error)"
            [ ! -s error ] || echo "$name: $(cat error)"
            check_table l.csv step,iteration 0
            [ -f l.csv ] || echo "$name, round $round: no log"
        done
    done
    sort -n ends | awk -v limit="$2" '{ t[NR] = $1 }
        END { if (t[int((NR + 1) / 2)] > limit)
                  print "half of all ends take " t[int((NR + 1) / 2)] " ms" }'
}
rounds=1 limit=300 pause=300
[ -z "$long" ] || rounds=2 pause=1500
[ -z "$all" ] || rounds=25
[ -z "${SANITIZE:-}" ] || limit=3000
if [ -r /proc/self/stat ]; then
    verdict signals_end_the_run $((2 * rounds)) "$(signals "$rounds" "$limit")"
    echo "# slowest end: $(sort -n ends | tail -n 1) ms of processor time"
else
    echo 'skipped signals_end_the_run: no /proc'
fi

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
        tries=0
        while [ $((round % 2)) = 0 ] && [ ! -s s.csv.part ] &&
            [ $tries -lt 500 ]; do
            sleep 0.01 # every second one is killed when it has written
            tries=$((tries + 1))
        done
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
verdict kills_leave_no_half_file "$rounds" "$(kills "$rounds" 2>/dev/null)"

# ---- streams and locales ----------------------------------------------------
closed_streams() {
    run() {
        "$elasto" --headless --steps 2 --segments 2 "$@"
    }
    run --quiet <&- >&- 2>&- || echo "all closed, quiet: $?"
    run --quiet --states s.csv >&- || echo "output closed, quiet: $?"
    check_table s.csv step,time 9
    run >&- 2>error
    [ $? -eq 1 ] || echo "output closed: not 1"
    grep -q '^elasto: cannot write the summary: ' error ||
        echo "closed: $(cat error)"
    rm -f s.csv
    run --states s.csv >&- 2>error # the table must not become the output
    [ $? -eq 1 ] || echo "output closed, with a table: not 1"
    check_table s.csv step,time 9
    run --states - >&- 2>error
    [ $? -eq 1 ] || echo "states to a closed output: not 1"
    run --states s.csv 2>&- >out || echo "error closed: $?"
    check_table s.csv step,time 9
    run --states nowhere/s.csv 2>&- >out
    [ $? -eq 1 ] || echo "failure with error closed: not 1"
}
verdict streams_may_be_closed 7 "$(closed_streams)"

# A parent may have left SIGPIPE ignored.
reset_pipe=
! env --default-signal=PIPE true 2>/dev/null ||
    reset_pipe='env --default-signal=PIPE'
broken_pipes() {
    {
        $reset_pipe "$elasto" --headless --steps 100000 --states - 2>error ||
            echo $? >code
    } | head -n 1 >/dev/null
    [ "$(cat code)" = 1 ] || echo "exit $(cat code)"
    [ "$(cat error)" = 'elasto: standard output: Broken pipe' ] || cat error
}
verdict broken_pipes_end_the_run 1 "$(broken_pipes)"

# Locales with a decimal comma; made here, because a bare system has none.
mkdir locales
for name in de_DE fr_FR; do
    localedef -i $name -f UTF-8 "locales/$name.UTF-8" >/dev/null 2>&1 &&
        [ -z "$long" ] && break
done
has_comma() {
    [ "$(LOCPATH=$work/locales LC_ALL=$1 env printf %.1f 1.5 2>/dev/null)" = \
        1,5 ]
}
locales() {
    line='--headless --steps 3 --quiet --stiffness 1.5e5 --states -'
    # shellcheck disable=SC2086
    expected=$("$elasto" $line | cksum)
    for name in de_DE.UTF-8 fr_FR.UTF-8 C.UTF-8 nonsense; do
        # shellcheck disable=SC2086
        got=$(LOCPATH=$work/locales LC_ALL=$name LANG=$name "$elasto" $line |
            cksum)
        [ "$got" = "$expected" ] || echo "$name: other numbers"
    done
}
if has_comma de_DE.UTF-8 || has_comma fr_FR.UTF-8; then
    verdict locales_change_nothing 4 "$(locales)"
else
    echo 'skipped locales_change_nothing: no locale with a decimal comma'
fi

# ---- command lines ----------------------------------------------------------
lines=0
given=0
: >reasons
# One of three; LONG: all.
bad_line() { # words: each must be in the one line; then -- arguments...
    given=$((given + 1))
    [ "$long" ] || [ $((given % 3)) = 0 ] || return 0
    words=
    while [ "$1" != -- ]; do
        words="$words$1
"
        shift
    done
    shift
    lines=$((lines + 1))
    "$elasto" "$@" >out 2>error
    code=$?
    [ "$code" -eq 2 ] || echo "$*: exit $code" >>reasons
    { read -r error && ! read -r rest; } <error ||
        echo "$*: $(wc -l <error) lines" >>reasons
    [ ! -s out ] || echo "$*: something on standard output" >>reasons
    while [ -n "$words" ]; do
        word=${words%%
*}
        words=${words#*
}
        case $error in
        *"$word"*) ;;
        *) echo "$*: no '$word' in: $error" >>reasons ;;
        esac
    done
}
# Which values a number refuses is the same for all of them.
numbers=timestep
[ -z "$long" ] || numbers='side density stiffness timestep'

for value in 0 -1 4097 1e4 1.5 x '' ' 3' '3 ' 0x10 nan inf 3a + - \
    99999999999999999999; do
    bad_line --segments "'$value'" 'from 1 to 4096' -- --segments "$value"
done
for option in $numbers; do
    for value in 0 -1 -0 nan -nan inf -inf x '' ' 1' '1 ' 1e999 -1e999 1e-999 \
        1..5 1e 1e5x 1m -- 0x 0x1p3 1_000 NaN INFINITY 1e-31 1e31 1e-320 \
        1e308; do
        bad_line "--$option" "'$value'" 'a number from 1e-30 to 1e30' -- \
            "--$option=$value"
    done
done
for value in nan inf -inf x '' ' 1' '1 ' 1e999 1e '1.4 m' 1e201; do
    bad_line --stretch "'$value'" 'a number from -1e200 to 1e200' -- \
        "--stretch=$value"
done
for value in 0 -1 nan 1e-301 1e301 '1e-2 m/s'; do
    bad_line --tolerance "'$value'" 'a number from 1e-300 to 1e300' -- \
        "--tolerance=$value"
done
for value in -1 1.5 x '' 1e-3 ' 1' '1 ' nan 99999999999999999999; do
    bad_line --steps "'$value'" 'a whole number from 0 to 1e18' -- \
        "--steps=$value"
done
for option in integrator solver filter line-search; do
    for value in x '' NEWTON 'clamp ' 0; do
        bad_line "--$option" "'$value'" 'none of: ' -- "--$option=$value"
    done
done
for value in x '' 1 '1,' ',1' 1,2,3 nan,1 1,inf '1, 2' '1;2'; do
    bad_line --start "'$value'" 'X,Y' -- landscape "--start=$value"
done
for option in segments side density stiffness timestep stretch tolerance \
    integrator solver filter line-search steps frames states log; do
    bad_line "--$option" missing -- "--$option"
done
for option in frames states log; do
    bad_line "--$option" empty -- "--$option="
done
for line in --nonsense -y --=3 ---; do
    bad_line "no option ${line%%=*}" --help -- "$line"
done
bad_line --segment5 'did you mean --segments?' -- --segment5
bad_line --SEGMENTS 'did you mean --segments?' -- --SEGMENTS
bad_line --no-headless 'did you mean --headless?' -- --no-headless
for scene in nowhere SQUARE square2 ''; do
    bad_line "'$scene'" --list -- "$scene"
done
bad_line "'circle'" 'one scene' -- square circle
bad_line --segments "'circle'" 'no square' -- circle --segments 3
bad_line --filter "'circle'" 'no springs' -- circle --filter none
bad_line --solver "'overshoot'" 'no springs' -- overshoot --solver multigrid
bad_line --tolerance "'circle'" 'no minimum' -- circle --tolerance 1
bad_line --line-search "'circle'" 'no minimum' -- circle --line-search none
bad_line --timestep "'overshoot'" 'no time' -- overshoot --timestep 1
bad_line --integrator "'landscape'" 'no time' -- landscape --integrator avf
bad_line --start "'square'" 'no start' -- square --start 1,1
bad_line --integrator "'overshoot'" 'no time' -- overshoot --integrator bdf2
bad_line --start "'square'" 'no start' -- --start 1,2
verdict bad_lines_are_refused "$lines" "$(cat reasons)"

# ---- screens ----------------------------------------------------------------
no_screen() { # what variable=value...
    what=$1
    shift
    rm -rf frames
    # Libraries below SDL leak when it looks for a screen.
    env ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0" "$@" \
        timeout 60 "$elasto" --steps 2 --quiet --size 160x120 >out 2>error
    code=$?
    [ "$code" -eq 0 ] || echo "$what: exit $code"
    [ "$(grep -c '^no screen: .*frames/$' error)" -eq 1 ] ||
        echo "$what: $(cat error)"
    [ "$(wc -l <error)" -eq 1 ] || echo "$what: $(cat error)"
    [ "$(find frames -name '*.png' | wc -l)" -eq 3 ] || echo "$what: frames"
    check_pictures
}
screens() {
    no_screen 'no DISPLAY' A=1
    no_screen 'dead DISPLAY' DISPLAY=:77
    no_screen 'nonsense DISPLAY' DISPLAY=nonsense
    no_screen dummy SDL_VIDEODRIVER=dummy
    no_screen offscreen SDL_VIDEODRIVER=offscreen
    no_screen 'nonsense driver' SDL_VIDEODRIVER=nonsense
}
verdict screens_may_be_missing 6 "$(screens)"

exit $failed
