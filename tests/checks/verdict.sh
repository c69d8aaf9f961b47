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
