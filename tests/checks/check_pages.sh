#!/bin/sh
# The lecture without a screen: its list, its pages one by one, and the handout.
. "$(dirname "$0")/verdict.sh"
work_apart

"$elasto" --lecture --list >list
pages=$(awk 'END { print NR }' list)

# The last page first: a page needs none of those before it.
verdict every_page_opens_by_number_and_by_name "$(
    awk '{ print $2 }' list >names
    while read -r name; do
        timeout 300 "$elasto" --lecture "$name" --headless --quiet --steps 1 \
            --size 480x300 --frames "frames_$name" 2>error
        code=$?
        [ $code = 0 ] || [ $code = 3 ] || echo "$name: exit $code: $(cat error)"
        [ -s "frames_$name/frame_000000.png" ] || echo "$name: no picture"
    done <names
    timeout 300 "$elasto" --lecture "$pages" --headless --quiet --steps 0 \
        --size 480x300 --frames last
    last=$(tail -n 1 names)
    cmp last/frame_000000.png "frames_$last/frame_000000.png" 2>&1
)"

# Touched, left and entered again it is what it was at first: every third page,
# LONG=1 every page.
walk() { # FOLDER LINES...: a picture of the page that the commands end at
    mkdir "$1"
    (
        cd "$1" || exit 1
        shift
        printf '0 %s\n' pause "$@" shot quit >script
        "$elasto" --lecture --headless --quiet --size 480x300 \
            --script script 2>error ||
            grep -v 'this is the \(first\|last\) page' error
        mv elasto_*.png shot.png
    )
}
verdict a_page_is_the_same_when_it_is_entered_again "$(
    for name in $(awk -v stride="$([ -z "${LONG:-}" ] && echo 3 || echo 1)" \
        '$2 !~ /race/ && NR % stride == 0 { print $2 }' list); do
        walk "once_$name" "page $name"
        walk "again_$name" "page $name" next next page-back page-on page-on \
            "page $name"
        cmp "once_$name/shot.png" "again_$name/shot.png" 2>&1
    done
)"

# ---- the handout ---------------------------------------------------------

# Ends while it writes: what stood there before still does.
verdict an_interrupted_handout_leaves_nothing "$(
    echo before >other.html
    "$elasto" --handout other.html 2>error &
    pid=$!
    until_there other.html.part
    kill -TERM $pid
    wait $pid
    code=$?
    [ $code = 1 ] || echo "exit $code"
    [ "$(cat other.html)" = before ] || echo 'it was overwritten'
    for rest in other.html.*; do
        [ ! -e "$rest" ] || echo "$rest is left"
    done
)"

# All of it takes as long as everything else here: make long-test.
if [ -z "${LONG:-}" ]; then
    exit $failed
fi

timeout 1200 "$elasto" --handout handout.html >output 2>error
code=$?
verdict the_handout_is_written "$(
    [ $code = 0 ] || echo "exit $code: $(cat error)"
    [ -s handout.html ] || echo 'no file'
    for rest in handout.html.*; do
        [ ! -e "$rest" ] || echo "$rest is left"
    done
    size=$(wc -c <handout.html)
    [ "$size" -lt 4000000 ] || echo "$size bytes"
    tail -n 1 handout.html | grep -q '</html>' || echo 'it is not whole'
)"

verdict it_asks_nobody_and_runs_nothing "$(
    grep -n -i -e '<script' -e 'http:' -e 'https:' -e '<link' -e '@import' \
        -e 'url(' handout.html | head -n 3
)"

# Every picture on its own: a line with data in base 64 up to the quote.
verdict every_picture_is_whole "$(
    awk '/src="data:image\/png;base64,/ { n++; open = 1; next }
        open && /^">/ { open = 0; close("picture_" n); next }
        open { print >("picture_" n) }
        END { print n >"count" }' handout.html
    [ "$(cat count)" = "$pages" ] || echo "$(cat count) pictures"
    i=1
    while read -r name; do
        base64 -d "picture_$i" >picture.png 2>/dev/null || echo "$name: base 64"
        head -c 8 picture.png | od -An -tx1 | tr -d ' \n' |
            grep -q 89504e470d0a1a0a || echo "$name: no PNG"
        tail -c 8 picture.png | head -c 4 | grep -q IEND ||
            echo "$name: cut off"
        grep -q "id=\"$name\"" handout.html || echo "$name is not there"
        i=$((i + 1))
    done <names
)"

exit $failed
