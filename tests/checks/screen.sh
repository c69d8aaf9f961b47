# Functions of the checks with windows: a virtual screen, and waiting for
# events. Sourced after work_apart; `pid` is the program whose window is open.
screen=
pid=
# Drivers and libraries below SDL leak; the suites look for leaks of the
# program.
export ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0"

# Ends the started programs and removes $work.
finish() {
    [ -z "$pid" ] || kill -KILL "$pid" 2>/dev/null
    [ -z "$screen" ] || kill "$screen" 2>/dev/null
    wait 2>/dev/null
    cd / && rm -rf "$work"
}
trap finish EXIT

# missing_program PROGRAM...: prints the first program that is not installed
missing_program() {
    for program in "$@"; do
        command -v "$program" >/dev/null 2>&1 || {
            echo "$program"
            return
        }
    done
}

# new_screen FILE SIZE: starts a server in the background, whose number goes to
# FILE. Keys do not repeat, however late they are released.
new_screen() {
    rm -f "$1"
    Xvfb -displayfd 3 -screen 0 "$2x24" -nolisten tcp -noreset -r \
        3>"$1" >"$1.log" 2>&1 &
    server=$!
    until_true test -s "$1"
}

# start_screen SIZE: starts the screen for all windows of a check.
start_screen() {
    new_screen display "$1" || {
        verdict the_screen_starts "no: $(tail -n 1 display.log)"
        screen=$server
        exit 1
    }
    screen=$server
    DISPLAY=:$(cat display)
    export DISPLAY
}

# ends_with CODE: waits for the end of the program and checks its exit code.
ends_with() {
    until_true has_ended "$pid" || {
        echo 'does not end'
        kill -KILL "$pid"
    }
    wait "$pid"
    code=$?
    pid=
    [ $code = "$1" ] || echo "ends with $code, not $1: $(tail -n 1 error)"
}

# compile_close_window: compiles the program that closes a window like its
# cross; fails without Xlib.
compile_close_window() {
    x11=$(ls /usr/lib/*/libX11.so.6 /usr/lib*/libX11.so.6 2>/dev/null |
        head -n 1)
    [ "$x11" ] && ${CC:-cc} -std=c11 "$here/close_window.c" "$x11" \
        -o close_window >close_window.log 2>&1
}
