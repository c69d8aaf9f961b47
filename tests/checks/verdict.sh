# What the shell checks share: they source it, and end with `exit $failed`.
set -u
failed=0
here=$(realpath "$(dirname "$0")")
root=$(realpath "$here/../..")

# verdict NAME REASONS: one line for a test; reasons empty: it passed.
verdict() {
    if [ -z "$2" ]; then
        echo "ok $1"
    else
        echo "not ok $1: $(printf '%s' "$2" | tr '\n' ';')"
        failed=1
    fi
}

# until_there FILE: waits until it has something in it, ten seconds at most.
until_there() {
    tries=0
    until [ -s "$1" ] || [ $tries -gt 1000 ]; do
        sleep 0.01
        tries=$((tries + 1))
    done
}

# A folder of its own, without a screen; it goes at the end.
work_apart() {
    elasto=$(realpath "${ELASTO:-build/elasto}")
    work=$(mktemp -d) && cd "$work" || exit 1
    trap 'cd / && rm -rf "$work"' EXIT
    trap 'exit 1' INT TERM HUP
    unset DISPLAY WAYLAND_DISPLAY SDL_VIDEODRIVER
}
