#!/bin/sh
# Checks the window on a virtual screen: real keys, mouse and letters arrive
# (tests/unit/test_session.c has their effects), any size is drawn, and each way
# to end works. Screenshots, whose names have the step, frames, tables and exit
# codes show the effects. Checks wait for events, not for fixed times.
. "$(dirname "$0")/verdict.sh"
work_apart
. "$here/screen.sh"

missing=$(missing_program Xvfb xdotool)
if [ "$missing" ]; then
    echo "skipped window_keys: no $missing"
    exit 0
fi
start_screen 1000x1000

has_title() {
    xdotool search --name "^elasto: $1 " 2>/dev/null
}
find_window() {
    window=$(has_title "$1" | tail -n 1)
    [ -n "$window" ]
}

# A short run may have closed its window before the check saw it.
has_begun() {
    find_window "$1" || has_ended "$pid"
}

# begin SCENE LINE...: opens a window with this scene and focuses it.
side=500
begin() {
    rm -rf frames ./*.png ./*.script states log
    "$elasto" "$@" --size "${side}x$side" --quiet --frames frames --states states \
        --log log 2>error &
    pid=$!
    echo $pid >pid
    until_true test -s frames/frame_000000.png || echo "$1: no frame"
    until_true has_begun "$1" || echo "$1: no window"
    timeout $timeout xdotool windowfocus --sync "$window" \
        mousemove --window "$window" $((side / 2)) $((side - 20)) 2>/dev/null
}

# end CODE: waits for the end of the program and checks its exit code.
end() {
    ends_with "$1"
    ls ./*.part 2>/dev/null
    [ -s states ] && [ -s log ] || echo 'no tables'
}
key() {
    xdotool key --delay 5 "$@"
}
at_once() { # XDOTOOL...: input arrives in one batch
    kill -STOP $pid
    xdotool "$@"
    kill -CONT $pid
}

# shot NAME: makes the screenshot NAME.png and prints its step. Commands are
# executed in order, so the screenshot shows the effects of earlier keys.
shot() {
    rm -f elasto_*.png
    key s
    until_true is_there || {
        echo none
        return
    }
    file=$(echo elasto_*.png)
    mv "$file" "$1.png"
    file=${file#elasto_*_}
    expr "${file%.png}" + 0
}
is_there() {
    test -s "$(echo elasto_*.png)"
}

# frame N: waits for the recorded frame of this step.
frame() {
    until_true test -s "frames/frame_$(printf %06d "$1").png" ||
        echo "step $1 is not reached"
}

# Prints the processor time that the program has used, in clock ticks.
ticks() {
    sed 's/.*) //' "/proc/$pid/stat" | awk '{ print $12 + $13 }'
}

# The square falls and starts running; otherwise it would soon rest.
keys_arrive() {
    begin square --segments 2 --gravity 1
    frame 5
    key space
    a=$(shot a)
    for row in "n $((a + 1))" "Left $a" "Right $((a + 1))" 'Home 0' \
        "End $((a + 1))"; do
        key "${row% *}"
        b=$(shot b)
        [ "$b" = "${row#* }" ] || echo "$row: it is at $b"
    done
    key h question F1 c p l b Escape i i n Left i Escape
    rm -f frames/frame_000000.png
    key r
    frame 0
    key 2
    until_true has_title circle || echo '2 is not circle'
    key 1
    until_true has_title square || echo '1 is not square'
    key Escape Escape Escape q q # q asks twice, as work would be lost
    end 0
    awk -F, 'NR > 1 && $3 > 8 { print "not two segments: " $0; exit }' states
}
verdict keys_arrive "$(keys_arrive)"

# Checks that the script of Y leads to the same state without a window.
same_again() {
    key y
    until_true is_written || echo 'Y leaves no script'
    mv elasto_*.script session
    key q q
    end 0
    tail -n 9 states >seen
    "$elasto" "$@" --headless --quiet --script session --states again \
        2>/dev/null
    code=$?
    [ $code = 0 ] || echo "the script ends with $code"
    tail -n 9 again | cmp -s - seen || echo 'the script leads elsewhere'
}
is_written() {
    test -s "$(echo elasto_*.script)"
}
point() { # X Y: at 900 x 900 the square has a fixed place
    xdotool mousemove --window "$window" "$1" "$2"
}
drag() { # BUTTON FROM BY: moves in two parts
    # shellcheck disable=SC2086
    point $2
    xdotool mousedown "$1"
    # shellcheck disable=SC2086
    set -- "$1" $2 $3
    point $(($2 + $4 / 2)) $(($3 + $5 / 2))
    sleep 0.1
    point $(($2 + $4)) $(($3 + $5))
    xdotool mouseup "$1"
}
typed() { # TEXT KEY...: types into the first number of the row
    key Tab
    xdotool type --delay 5 "$1"
    shift
    key "$@"
}

# Another window takes the focus during a drag: the hand lets go, and a
# returning mouse drags nothing.
focus_ends_a_drag() {
    side=500
    begin square --segments 2 --gravity 1
    frame 2
    point 155 215
    xdotool mousedown 1
    point 175 195
    frame 9
    timeout $timeout xdotool windowfocus \
        "$(xdotool search --maxdepth 0 --name '.*' | head -n 1)"
    timeout $timeout xdotool windowfocus --sync "$window"
    point 250 280
    point 260 290
    key space
    same_again square --segments 2 --gravity 1
    xdotool mouseup 1
    grep -q release session || echo 'the hand does not let go'
    sed -n '/release/,$p' session | grep drag
}
verdict focus_ends_a_drag "$(focus_ends_a_drag)"

# Checks that a small screen has room for the window with its frame.
the_window_fits() {
    for screen_size in 1280x800 1366x768 800x600; do
        new_screen small "$screen_size" || echo "no screen of $screen_size"
        DISPLAY=:$(cat small) "$elasto" hang --quiet --paused 2>error &
        pid=$!
        export DISPLAY=:"$(cat small)"
        until_true find_window hang || echo 'no window'
        xdotool getwindowgeometry --shell "$window" >geometry
        awk -F= -v size="$screen_size" '{ split(size, most, "x") }
            $1 == "WIDTH" && $2 > most[1] - 10 { print $2, "of", size }
            $1 == "HEIGHT" && $2 > most[2] - 40 { print $2, "of", size }' geometry
        kill $pid
        wait $pid
        pid=
        kill "$server"
    done
}
verdict the_window_fits_its_screen "$(the_window_fits)"

# Plays a session by mouse and keys: drags and types numbers, pulls the middle
# of the running square, pins a corner, zooms and moves the view, adds a pane.
hand_arrives() {
    side=900
    begin square --segments 2 --stretch 1 --paused
    drag 1 '60 757' '50 0'
    typed 1/60 Return
    typed '4qsm?' Return Escape
    point 279 389
    # a running square: at rest the node would be placed, not pulled
    at_once key space mousedown 1 mousemove_relative -- 12 -20
    frame 5
    point 339 289
    frame 20
    at_once mouseup 1 key space Home
    point 524 634
    xdotool click 3 # at an old step the first click asks
    xdotool click 3
    point 150 680
    shot plain >/dev/null
    xdotool click 4
    shot zoomed >/dev/null
    cmp -s plain.png zoomed.png && echo 'the wheel does nothing'
    drag 2 '150 500' '150 100'
    shot moved >/dev/null
    cmp -s zoomed.png moved.png && echo 'the middle button does nothing'
    point 60 660
    at_once click --repeat 2 1
    point 150 680
    shot fitted >/dev/null
    cmp -s plain.png fitted.png || echo 'a double click does not fit'
    # keys count as held when they were pressed, not when they are read
    at_once mousemove --window "$window" 160 757 click 4 keydown Tab key m keyup Tab
    key n
    same_again square --segments 2 --stretch 1
    for word in 'set timestep 0.0' 'set timestep 0.0166666666666666' grab drag \
        release pin 'set stiffness' add-pane; do
        grep -q " $word" session || echo "no $word"
    done
}
verdict a_hand_arrives "$(hand_arrives)"

# Escape leaves full screen first, and then the program.
full_screen() {
    begin square --paused
    key F11 Escape
    a=$(shot a)
    [ "$a" = 0 ] || echo 'Escape ends the program first'
    key Escape
    a=$(shot b)
    [ "$a" = 0 ] || echo 'Escape does not ask again'
    key Escape Escape
    end 0
}
verdict escape_leaves_full_screen_first "$(full_screen)"

# Checks that a paused window uses less than 5 % of a processor.
paused_window() {
    begin square
    key space
    shot a >/dev/null
    until_true is_idle || echo "$used ticks in a second of a pause"
    key q
    end 0
}
is_idle() {
    used=$(ticks)
    sleep 1
    used=$(($(ticks) - used))
    [ $used -le 5 ]
}
verdict a_paused_window_is_idle "$(paused_window)"

# Runs to the last step, and to a step that did not converge.
ends() {
    while read -r expected step line; do
        # shellcheck disable=SC2086
        begin $line
        end "$expected"
        a=$(tail -n 1 states | cut -d, -f1)
        [ "$a" = "$step" ] || echo "$line ends at step $a"
    done <<'END'
0 5 circle --steps 5 --speed 8
3 2 overshoot --steps 50
END
}
verdict the_last_step_ends_the_window "$(ends)"

if compile_close_window; then
    verdict closing_the_window_ends_it "$(
        begin square
        ./close_window "$window"
        end 0
    )"
else
    echo "skipped closing_the_window_ends_it: no libX11.so.6 to link with"
fi

# Resizes a running window from one pixel to more than the screen, and back.
any_size() {
    begin square --segments 32
    last=0
    for size in '1 1' '1500 1500' '4000 1' '300 200'; do
        # shellcheck disable=SC2086
        timeout $timeout xdotool windowsize $window $size || echo "no $size"
        until_true has_size $size || echo "$size is not its size"
        last=$(newest)
        frame $((last + 3))
    done
    key q
    end 0
}
has_size() { # WIDTH HEIGHT
    xdotool getwindowgeometry --shell "$window" |
        awk -F= -v w="$1" -v h="$2" '$1 == "WIDTH" { ok = $2 == w }
            $1 == "HEIGHT" { ok = ok && $2 == h } END { exit !ok }'
}
newest() {
    number=$(find frames -name '*.png' | sort | tail -n 1)
    number=${number#frames/frame_}
    expr "${number%.png}" + 0
}
verdict a_window_may_have_any_size "$(any_size)"

# Keys and signals end a step of several seconds between Newton iterations.
in_a_step() {
    for way in q TERM; do
        begin square --segments 180 --solver newton --paused
        key n
        enough=$(($(ticks) + 20))
        until_true is_at_work || echo 'no step begins'
        kill -STOP $pid
        before=$(newest)
        if [ $way = q ]; then key q; else kill -$way $pid; fi
        kill -CONT $pid
        end 0
        [ "$(newest)" = "$before" ] || echo "$way: after frame $(newest)"
    done
}
is_at_work() {
    [ "$(ticks)" -gt $enough ]
}
verdict a_window_ends_in_the_middle_of_a_step "$(in_a_step)"

exit $failed
