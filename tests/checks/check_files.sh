#!/bin/sh
# What is promised about files, for every kind that a name can stand for: what
# existed stays whole until what replaces it is whole, and what cannot be kept
# whole is refused before anything is opened.  Limits and signals included.
set -u
failed=0
elasto=$(realpath "${ELASTO:-build/elasto}")
here=$(realpath "$(dirname "$0")")
. "$here/verdict.sh"

work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
trap 'exit 1' INT TERM
cd "$work" || exit 1
unset DISPLAY WAYLAND_DISPLAY SDL_VIDEODRIVER

# run CODE ARGUMENTS...: two quiet steps of nine nodes; complains about another
# exit code and about more than one line.
run() {
    expected=$1
    shift
    timeout 60 "$elasto" --headless --quiet --segments 2 --steps 2 "$@" \
        >out 2>error
    code=$?
    [ "$code" -eq "$expected" ] || echo "$*: exit $code: $(head -n 1 error)"
    if [ "$expected" -eq 0 ] || [ "$expected" -eq 3 ]; then
        [ ! -s error ] || echo "$*: $(head -n 1 error)"
    else
        [ "$(wc -l <error)" -eq 1 ] || echo "$*: $(wc -l <error) lines"
    fi
}

# A table of three times nine nodes.
whole() {
    [ "$(wc -l <"$1")" -eq 28 ] || echo "$1: $(wc -l <"$1") lines"
    [ "$(head -n 1 "$1")" = step,time,node,x,y,vx,vy ] || echo "$1: no header"
}
precious() {
    [ "$(cat "$1" 2>&1)" = precious ] || echo "$2: $1 is lost"
}
no_parts() {
    for part in ./*.part*; do
        [ ! -e "$part" ] || echo "$1: $part is left"
    done
}

# ---- kinds -------------------------------------------------------------------
links() {
    mkdir -p far
    echo precious >far/target
    ln -sf far/target link
    ln -sf link chain
    run 2 --states chain --side 0
    run 2 --states chain --density 1e-320
    run 1 --states chain --log nowhere/l.csv
    run 1 --states chain --stretch 1e160 # fails in its first step
    rm -f far/target.part
    precious far/target 'failed runs'
    run 0 --states chain
    [ -L chain ] && [ -L link ] || echo 'the link is gone'
    [ ! -L far/target ] || echo 'the target became a link'
    whole far/target
    ln -sf far/new dangling
    run 0 --states dangling
    [ -L dangling ] && whole far/new
    ln -s round-b round-a
    ln -s round-a round-b
    run 1 --states round-a
    [ "$(find . far -name '*.part*')" = '' ] || echo 'parts are left'
    rm -rf far link chain dangling round-?
}
verdict links_stay_and_their_targets_too "$(links)"

modes() {
    for mode in 600 640 644 666 755; do
        echo old >s.csv
        chmod $mode s.csv
        run 0 --states s.csv
        [ "$(stat -c %a s.csv)" = $mode ] ||
            echo "$mode becomes $(stat -c %a s.csv)"
        whole s.csv
        rm -f s.csv
    done
    (umask 027 && run 0 --states s.csv)
    [ "$(stat -c %a s.csv)" = 640 ] || echo "umask: $(stat -c %a s.csv)"
    rm -f s.csv
    if [ "$(id -u)" != 0 ]; then
        echo precious >s.csv
        chmod 444 s.csv
        run 1 --states s.csv
        precious s.csv 'read only'
        rm -f s.csv
    fi
}
verdict modes_are_kept "$(modes)"

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
    run 1 --states .
    run 1 --states far/
    rm -f pipe copy
}
verdict pipes_and_devices_are_written "$(pipes_and_devices)"

if mknod block b 7 250 2>/dev/null; then
    verdict block_devices_are_refused "$(
        run 1 --states block
        grep -q 'only regular files' error || cat error
        rm -f block
    )"
else
    echo 'skipped block_devices_are_refused: none can be made here'
fi

# A file that happens to be called NAME.part is somebody's.
others_parts() {
    echo precious >s.csv.part
    run 0 --states s.csv
    precious s.csv.part 'a part of somebody'
    whole s.csv
    rm -f s.csv
    run 1 --states s.csv --stretch 1e160
    precious s.csv.part 'a part of somebody, failing'
    rm -f s.csv*
}
verdict what_is_called_part_stays "$(others_parts)"

# ---- two names for one file ----------------------------------------------------
refused_pair() { # frames-or-states arguments...
    echo precious >k.csv
    run 2 "$@"
    precious k.csv "$*"
    [ ! -s out ] || echo "$*: something on standard output"
    no_parts "$*"
    rm -f k.csv
}
twice() {
    mkdir -p d
    refused_pair --states k.csv --log k.csv
    refused_pair --states k.csv --log ./k.csv
    refused_pair --states k.csv --log "$work/d/../k.csv"
    refused_pair --states k.csv --log k.csv.part
    refused_pair --states k.csv.part --log k.csv
    refused_pair --states k.csv.part7 --log k.csv
    refused_pair --states new --log new
    refused_pair --states new.part --log new
    ln -s k.csv link
    refused_pair --states link --log k.csv
    refused_pair --states k.csv --log link.part --log link
    ln -s nothing dangling
    refused_pair --states dangling --log nothing
    echo precious >k.csv
    ln k.csv hard
    refused_pair --states k.csv --log k.csv
    rm -f hard link dangling
    refused_pair --states - --log -
    refused_pair --states - --log /dev/stdout
    refused_pair --states /dev/fd/1 --log /proc/self/fd/1
    refused_pair --frames d --states d/frame_000000.png
    refused_pair --frames d/ --log ./d/frame_000001.png
    refused_pair --frames new-folder --log new-folder/frame_000001.png.part
    [ ! -e new-folder ] || echo 'a folder was made'
    rm -rf d
    run 0 --states a.csv --log a.csv.partly
    rm -f a.csv*
}
verdict one_file_twice_is_refused "$(twice)"

standard_output() {
    for name in - /dev/stdout /dev/fd/1 /proc/self/fd/1; do
        "$elasto" --headless --segments 2 --steps 2 --states $name \
            >out 2>error || echo "$name: exit $?"
        whole out
        grep -q '^steps ' error || echo "$name: no summary"
        "$elasto" --headless --segments 2 --steps 2 --states $name 2>error |
            cat >out
        whole out
        grep -q '^steps ' error || echo "$name, piped: no summary"
    done
    "$elasto" --headless --segments 2 --steps 2 --states same >same 2>error
    whole same
    rm -f same
}
verdict standard_output_has_many_names "$(standard_output)"

# Runs of different lengths: what stands there is one of them, whole.
at_once() {
    for i in 1 2 3 4; do
        "$elasto" --headless --quiet --segments 2 --steps $((100 * i)) \
            --states s.csv --log l.csv 2>error$i &
    done
    wait
    cat error?
    case $(wc -l <s.csv) in
    910 | 1810 | 2710 | 3610) ;;
    *) echo "s.csv: $(wc -l <s.csv) lines" ;;
    esac
    awk -F, 'NR > 1 && $3 != (NR - 2) % 9 { bad = 1 } NF != 7 { bad = 1 }
        END { if (bad) print "s.csv: mixed" }' s.csv
    awk -F, 'NR == 1 { n = NF } NF != n { bad = 1 } NR > 2 && $1 < last { bad = 1 }
        NR > 1 { last = $1 + 0 }
        END { if (bad) print "l.csv: mixed" }' l.csv
    no_parts 'at once'
    rm -f s.csv l.csv error?
}
verdict runs_at_once_do_not_mix "$(at_once)"

# ---- nothing is replaced before a step was made --------------------------------
no_step() {
    for options in '--density 1e-320' '--side 1e-160' '--side 1e160' \
        '--stiffness 1e308' '--timestep 1e308' '--segments 5000' --nonsense; do
        for name in k.csv l.csv; do
            echo precious >$name
        done
        # shellcheck disable=SC2086
        run 2 --states k.csv --log l.csv $options
        precious k.csv "$options"
        precious l.csv "$options"
        no_parts "$options"
    done
    run 1 --states k.csv --log l.csv --stretch 1e160
    precious k.csv 'no step'
    precious l.csv 'no step'
    rm -f ./*.csv ./*.part
    run 1 --states k.csv --stretch 1e160 # nothing was there: it appears
    [ "$(wc -l <k.csv)" -eq 10 ] || echo 'the start is lost'
    rm -f ./*.csv
}
verdict without_a_step_nothing_is_replaced "$(no_step)"

# ---- limits ----------------------------------------------------------------------
# The size of a file: with the signal as it comes, and ignored by a parent.
sizes() {
    for size in 0 1 2 4 8; do
        for ignored in '' yes; do
            echo precious >k.csv
            (
                [ -z "$ignored" ] || trap '' XFSZ
                ulimit -f "$size"
                "$elasto" --headless --steps 40 --segments 2 --quiet \
                    --states k.csv
                echo $?
            ) 2>&1 | cat >error
            [ "$(tail -n 1 error)" = 1 ] && [ "$(wc -l <error)" -eq 2 ] ||
                echo "limit $size: $(cat error)"
            grep -q '^elasto: k.csv: File too large$' error ||
                echo "limit $size: $(cat error)"
            precious k.csv "limit $size"
            rm -f k.csv*
        done
    done
}
# The address space: the run ends, well or with one line.
spaces() {
    for space in 100000 130000 160000 200000 250000 300000 330000 400000; do
        (
            ulimit -v $space
            timeout -s KILL 20 "$elasto" --headless --steps 1 --quiet \
                >out 2>error
            echo $? >code
        )
        case $(cat code) in
        0) [ ! -s error ] || echo "$space: $(head -n 1 error)" ;;
        1)
            [ "$(wc -l <error)" -eq 1 ] || echo "$space: $(cat error)"
            grep -q '^elasto: not enough memory' error ||
                echo "$space: $(cat error)"
            ;;
        *) echo "$space: exit $(cat code): $(head -n 1 error)" ;;
        esac
    done
    [ "$(cat code)" = 0 ] || echo 'not even 400000 is enough'
}
if [ -z "${SANITIZE:-}" ]; then
    verdict file_sizes_may_be_limited "$(sizes)"
    verdict address_spaces_may_be_limited "$(spaces)"
fi

# ---- texts -----------------------------------------------------------------------
names() {
    odd=$(printf 'no\nwhere\033[31m')
    run 1 --states "$odd/s.csv"
    run 1 --log "$odd/l.csv"
    run 1 --frames "$odd/frames"
    run 2 --states "$odd" --log "$odd"
    run 2 "$odd"
    run 2 "--$odd"
    run 2 "--side=$odd"
    run 2 --steps "$odd"
    if grep -q "$(printf '\033')" error; then
        echo 'an escape gets through'
    fi
    run 0 --states "$odd"
    whole "$odd"
    rm -f "$odd"
    long=$(printf '%0500d' 0)
    for option in segments side density stiffness stretch timestep tolerance \
        steps; do
        run 2 "--$option" "x$long"
        grep -q ' from .* to ' error || echo "--$option: no range: $(cat error)"
    done
    "$elasto" --headless --segments 2 --steps 0 --frames "$odd" >out
    [ "$(wc -l <out)" -eq "$("$elasto" --headless --segments 2 --steps 0 |
        wc -l)" ] || echo "the summary has $(wc -l <out) lines"
    rm -rf "$odd"
}
verdict messages_are_one_line "$(names)"

infinities() {
    "$elasto" --headless --steps 0 --stretch 1e120 >out || echo "exit $?"
    "$elasto" --headless --steps 3 --timestep 1e30 --states - >>out 2>&1
    "$elasto" circle --headless --steps 2 --timestep 1e30 \
        --integrator backward-euler --states - >>out 2>&1
    grep -niE '\b(inf|nan)\b' out | head -n 3
}
verdict no_number_is_infinite "$(infinities)"

# ---- signals ---------------------------------------------------------------------
# A run under nohup ignores SIGHUP, and so would the program that it starts.
reset_hup=
! env --default-signal=HUP true 2>/dev/null || reset_hup='env --default-signal=HUP'

# signalled NAME: sent when rows have arrived; the code goes to $code.
signalled() {
    rm -f s.csv s.csv.part
    # shellcheck disable=SC2086
    $reset_hup "$elasto" --headless --quiet --segments 2 --steps 100000000 \
        --states s.csv 2>error &
    child=$!
    tries=0
    until [ -s s.csv.part ] || [ $tries -gt 1000 ]; do
        sleep 0.01
        tries=$((tries + 1))
    done
    kill -s "$1" $child
    wait $child
    code=$?
}
endings() {
    for name in INT TERM HUP; do
        signalled $name
        [ "$code" -eq 0 ] || echo "$name: exit $code"
        rows=$(($(wc -l <s.csv) - 1))
        [ $rows -ge 9 ] && [ $((rows % 9)) -eq 0 ] || echo "$name: $rows rows"
        no_parts $name
    done
    rm -f s.csv
}
verdict signals_lose_no_row "$(endings)"

# A run that hangs where it cannot look: the first signal changes nothing, the
# second ends it at once.
second_signal() {
    "${CC:-cc}" -std=c11 -D_GNU_SOURCE -O1 -shared -fPIC "$here/faults.c" \
        -o faults.so -ldl || return
    for name in INT TERM; do
        echo precious >k.csv
        FAULT=hang FAULT_AT=1 FAULT_FILE=/dev/null LD_PRELOAD=./faults.so \
            "$elasto" --headless --quiet --segments 2 --steps 2 \
            --states k.csv 2>error &
        child=$!
        tries=0
        until [ -s k.csv.part ] || [ $tries -gt 1000 ]; do
            sleep 0.01
            tries=$((tries + 1))
        done
        sleep 0.1
        kill -s $name $child
        sleep 0.2
        kill -s 0 $child 2>/dev/null || echo "$name: the first ends it"
        kill -s $name $child 2>/dev/null
        tries=0
        while kill -s 0 $child 2>/dev/null && [ $tries -lt 300 ]; do
            sleep 0.01
            tries=$((tries + 1))
        done
        kill -s KILL $child 2>/dev/null && echo "$name: the second does not"
        wait $child 2>/dev/null
        precious k.csv "$name twice"
        rm -f k.csv*
    done
}
if [ -z "${SANITIZE:-}" ]; then
    verdict a_second_signal_ends_at_once "$(second_signal)"
fi

exit $failed
