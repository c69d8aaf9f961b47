# Functions of all shell checks, which source it and end with `exit $failed`
set -u
failed=0
here=$(realpath "$(dirname "$0")")
root=$(realpath "$here/../..")

# verdict NAME REASONS: prints the line of a test, which passes without reasons.
verdict() {
    if [ -z "$2" ]; then
        echo "ok $1"
    else
        echo "not ok $1: $(printf '%s' "$2" | tr '\n' ';')"
        failed=1
    fi
}

timeout=60 # s, limit of each wait

# until_true COMMAND...: waits until the command succeeds; fails after the
# time-out, which is shorter from then on.
until_true() {
    end=$(($(date +%s) + timeout))
    until "$@" >/dev/null 2>&1; do
        [ "$(date +%s)" -lt $end ] || {
            timeout=2
            return 1
        }
        sleep 0.02
    done
}

until_there() { # FILE
    until_true test -s "$1"
}

# has_ended PID: succeeds if the process is over.
has_ended() {
    ! kill -0 "$1" || grep -q '^State:.Z' "/proc/$1/status"
}

# refuses CODE WORDS COMMAND...: checks that the command ends with this code and
# one line with these words.
refuses() {
    expected=$1 words=$2
    shift 2
    "$@" >out 2>error </dev/null
    code=$?
    [ $code = "$expected" ] && [ "$(wc -l <error)" -eq 1 ] &&
        grep -q -e "$words" error || echo "$*: exit $code: $(cat error)"
}

# Changes to a temporary folder, without a screen; the exit removes it.
work_apart() {
    elasto=$(realpath "${ELASTO:-build/elasto}")
    work=$(mktemp -d) && cd "$work" || exit 1
    trap 'cd / && rm -rf "$work"' EXIT
    trap 'exit 1' INT TERM HUP
    unset DISPLAY WAYLAND_DISPLAY SDL_VIDEODRIVER
}
