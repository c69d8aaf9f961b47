#!/bin/sh
# Checks promises about files: an old file stays until the new one is whole,
# also if a run fails or is stopped. (Refused lines: check_lines.sh.)
. "$(dirname "$0")/verdict.sh"
work_apart

# run CODE ARGUMENTS...: makes two quiet steps of nine nodes; complains unless
# they end with exit code and number of lines CODE, 0 or 1.
run() {
    expected=$1
    shift
    timeout 300 "$elasto" --headless --quiet --segments 2 --steps 2 "$@" \
        >out 2>error
    code=$?
    [ "$code-$(wc -l <error)" = "$expected-$expected" ] ||
        echo "$*: exit $code: $(cat error)"
}

# Checks that a file is a table of three times nine nodes.
whole() {
    [ "$(wc -l <"$1")" -eq 28 ] || echo "$1: $(wc -l <"$1") lines"
    [ "$(head -n 1 "$1")" = step,time,node,x,y,vx,vy ] || echo "$1: no header"
}
precious() {
    [ "$(cat "$1" 2>&1)" = precious ] || echo "$2: $1 is lost"
}
no_parts() {
    [ -z "$(find . -name '*.part*')" ] || echo "$1: $(find . -name '*.part*')"
}

# ---- kinds of names ----------------------------------------------------------
pipes_and_devices() {
    mkfifo pipe
    cat pipe >copy &
    run 0 --states pipe
    wait $!
    whole copy
    run 0 --states /dev/null --log /dev/null
    "$elasto" --headless --steps 2 --states /dev/null --log /dev/null \
        >/dev/null || echo 'standard output is the null device, too'
    [ -c /dev/null ] || echo '/dev/null is gone'
    run 1 --states far/
    rm -rf pipe copy
}
verdict pipes_and_devices_are_written "$(pipes_and_devices)"

standard_output() {
    for name in - /dev/stdout; do
        "$elasto" --headless --segments 2 --steps 2 --states $name \
            2>error | cat >out
        whole out
        grep -q '^steps ' error || echo "$name: no summary"
    done
}
verdict standard_output_has_two_names "$(standard_output)"

# ---- films -----------------------------------------------------------------------
# frames FILE: those that can be read
frames() {
    ffprobe -v error -count_frames -select_streams v -of csv=p=0 \
        -show_entries stream=nb_read_frames "$1" 2>&1
}
films() {
    "$elasto" --headless --steps 3 --size 97x64 --film a.mp4 >out ||
        echo "exit $?"
    [ "$(frames a.mp4)" = 4 ] || echo "$(frames a.mp4) frames"
    grep -q '^film  *4 frames, in a.mp4$' out || cat out
    run 0 --speed 0.25 --size 97x64 --film slow.gif # each four times
    [ "$(frames slow.gif)" = 12 ] || echo "slow: $(frames slow.gif) frames"
    printf '1 film\n3 film\n' >cut.script # each step four times
    run 0 --steps 4 --size 96x64 --frames cut --script cut.script
    [ "$(frames elasto_*.mp4)" = 8 ] || echo "cut: $(frames elasto_*.mp4) frames"
    run 1 --film a.gif --frames /dev/null/d
    for name in f.mp4 f.webm; do
        (
            ulimit -f 8
            run 1 --steps 60 --film $name
        )
        [ ! -e $name ] && grep -q "$name: ffmpeg.*disk may be full" error || echo "half of $name"
    done
    rm -f ./*.part
    no_parts films
    rm -rf ./*.gif ./*.mp4 cut
}
# Checks that a run which fails in one file keeps all old ones: it fails in a
# picture after step 2, after many steps, or at the end of a table.
failed_runs() {
    mkdir -p fr/frame_000003.png
    ln -s /dev/full full.csv
    while read -r last words line; do
        for name in s.csv e.csv f.gif; do
            echo precious >$name
        done
        # shellcheck disable=SC2086
        run 1 --size 97x64 --states s.csv --energies e.csv --film f.gif $line
        grep -q "^elasto: $words" error || cat error
        for name in s.csv e.csv f.gif; do
            precious $name "$line"
        done
        [ "$(tail -n 1 s.csv.part | cut -d, -f1,3)" = "$last,8" ] &&
            [ "$(tail -n 1 e.csv.part | cut -d, -f1)" = "$last" ] &&
            [ "$(frames f.gif.part)" = $((last + 1)) ] ||
            echo "$line: $(tail -n 1 s.csv.part) $(frames f.gif.part)"
        rm -f ./*.part
    done <<'END'
3 fr/frame_000003.png: --steps 9 --frames fr
5 step.6.failed: --steps 50 --integrator symplectic-euler --timestep 0.1
2 full.csv: --springs full.csv
END
    rm -rf fr full.csv s.csv e.csv f.gif
}
# Checks Ctrl+C, which reaches the whole process group with ffmpeg.
stopped_films() {
    for row in 'INT mp4' 'TERM gif'; do
        name=f.${row#* }
        setsid "$elasto" --headless --size 97x64 --steps 1000000 --film "$name" \
            >out 2>error &
        child=$!
        until_there "$name.part"
        kill -s "${row% *}" -- -$child
        wait $child || echo "$row: exit $?: $(cat error)"
        told=$(sed -n 's/^film *\([0-9]*\) frames.*/\1/p' out)
        [ "$(frames "$name")" = "$told" ] && [ "$told" -gt 0 ] ||
            echo "$row: $told frames were drawn, $(frames "$name") are there"
        rm -f "$name"
    done
    no_parts 'stopped films'
}
if command -v ffprobe >/dev/null; then
    verdict films_have_every_frame "$(films)"
    verdict failed_runs_leave_parts "$(failed_runs)"
    verdict stopped_films_play "$(stopped_films)"
else
    echo 'skipped films_have_every_frame: no ffmpeg'
    echo 'skipped stopped_films_play: no ffmpeg'
fi
verdict without_ffmpeg_one_line_says_so "$(
    PATH=/nonexistent "$elasto" --headless --film a.gif 2>error
    code=$?
    [ $code = 2 ] && [ "$(wc -l <error)" -eq 1 ] &&
        grep -q "the program ffmpeg: apt-get" error || echo "$code: $(cat error)"
    no_parts 'no ffmpeg'
)"

# ---- limits ----------------------------------------------------------------------
# Limits the size of files, with SIGXFSZ or with it ignored by a parent. Written
# rows stay, and the next run overwrites them.
sizes() {
    for row in '2 ' '8 XFSZ'; do
        echo precious >k.csv
        (
            [ "${row#* }" = '' ] || trap '' XFSZ
            ulimit -f "${row% *}"
            "$elasto" --headless --steps 40 --segments 2 --quiet --states k.csv
            echo $?
        ) 2>&1 | cat >error
        [ "$(cat error)" = "elasto: k.csv: File too large
1" ] || echo "limit $row: $(cat error)"
        precious k.csv "limit $row"
        [ "$(echo k.csv.*)" = k.csv.part ] || echo k.csv.*
    done
    run 0 --states k.csv
    whole k.csv
    no_parts 'after failures'
    rm -f k.csv
}
if [ -z "${SANITIZE:-}" ]; then
    verdict file_sizes_may_be_limited "$(sizes)"
fi

# ---- signals ---------------------------------------------------------------------
# Sent when rows have arrived, and in the midst of a large square, which ends
# before its processor time does.
signals() {
    while read -r name rows line; do
        # shellcheck disable=SC2086,SC3045
        (
            ulimit -t $timeout
            exec "$elasto" --headless --quiet --steps 100000000 $line
        ) 2>error &
        child=$!
        until_there t.csv.part
        sleep 0.2
        kill -s "$name" $child
        wait $child || echo "$name: exit $?"
        [ ! -s error ] || echo "$name: $(cat error)"
        awk -F, -v rows="$rows" 'NR == 1 { n = NF } NF != n { half = 1 }
            END { if (half || NR < 2 || (NR - 1) % rows) print "half a table" }
            ' t.csv
        no_parts "$name"
        rm -f t.csv
    done <<'END'
INT 9 --segments 2 --states t.csv
TERM 9 --segments 2 --states t.csv
INT 1 --segments 128 --solver multigrid --log t.csv
END
}
verdict signals_lose_no_row "$(signals)"

# A run that hangs in rename ignores the first signal; the second ends it at
# once.
second_signal() {
    for name in INT TERM; do
        echo precious >k.csv
        FAULT=hang FAULT_AT=1 FAULT_FILE=/dev/null LD_PRELOAD=./faults.so \
            "$elasto" --headless --quiet --segments 2 --steps 2 \
            --states k.csv 2>error &
        child=$!
        until_there k.csv.part
        kill -s $name $child
        sleep 0.2 # earlier signals count as the first
        has_ended $child 2>/dev/null && echo "$name: the first ends it"
        until_true ends_by $name || echo "$name: the second does not"
        kill -s KILL $child 2>/dev/null
        wait $child 2>/dev/null
        precious k.csv "$name twice"
        rm -f k.csv*
    done
}
ends_by() { # SIGNAL: sends it again, as two may merge into one
    kill -s "$1" $child
    sleep 0.2
    has_ended $child
}

if [ -z "${SANITIZE:-}" ]; then
    # shellcheck disable=SC2086 # CC may be two words
    ${CC:-cc} -std=c11 -D_GNU_SOURCE -O1 -shared -fPIC "$here/faults.c" \
        -o faults.so -ldl
    verdict a_second_signal_ends_at_once "$(second_signal)"
fi

exit $failed
