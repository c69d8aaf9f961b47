# What the shell checks share; they begin with failed=0 and end with it.

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
