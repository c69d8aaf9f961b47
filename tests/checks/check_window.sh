#!/bin/sh
# The window, driven by real keys and clicks on a virtual screen: each key does
# on each scene what the list of keys says.  What a key did is seen in
# screenshots (their name tells the step), recorded frames, tables and exit
# codes.  Nothing waits for a fixed time: only for what shall happen, or until
# a time-out.
set -u
failed=0

. "$(dirname "$0")/verdict.sh"

elasto=$(realpath "${ELASTO:-build/elasto}")
sources=$(realpath "$(dirname "$0")")
folder=$(mktemp -d) || exit 1
cd "$folder" || exit 1
. "$sources/screen.sh"

missing=$(missing_program Xvfb xdotool)
if [ "$missing" ]; then
    echo "skipped window_keys: no $missing"
    exit 0
fi
start_screen 1000x1000

# A window first looks whether an OpenGL serves it, which takes it 0.2 s here:
# most of the tests go without (LONG: none).
look_for_opengl() {
    unset SDL_RENDER_DRIVER SDL_FRAMEBUFFER_ACCELERATION
}
without_opengl() {
    [ -z "${LONG:-}" ] || return
    export SDL_RENDER_DRIVER=software SDL_FRAMEBUFFER_ACCELERATION=0
}

has_title() {
    xdotool search --name "^elasto: $1 " 2>/dev/null
}
find_window() {
    window=$(has_title "$1" | tail -n 1)
    [ -n "$window" ]
}

# A run of few steps may have closed its window before it was seen.
has_begun() {
    find_window "$1" || has_ended "$pid"
}

# begin SCENE LINE...: a window with this scene, keys go to it.
side=500
begin() {
    rm -rf frames ./*.png ./*.script states log
    "$elasto" "$@" --size "${side}x$side" --quiet --frames frames --states states \
        --log log 2>error &
    pid=$!
    echo $pid >pid
    until_true has_begun "$1" || echo "$1: no window"
    until_true test -s frames/frame_000000.png || echo "$1: no frame"
    # Making the renderer, SDL may have made the window anew.
    found=$(has_title "$1" | tail -n 1)
    window=${found:-$window}
    timeout $timeout xdotool windowfocus --sync "$window" \
        mousemove --window "$window" $((side / 2)) $((side - 20)) 2>/dev/null
}

# end CODE: waits for the end of the program and complains about its code.
end() {
    last=$pid
    until_true has_ended "$last" || {
        echo 'does not end'
        kill -KILL "$last"
    }
    wait "$last"
    code=$?
    pid=
    [ $code = "$1" ] || echo "ends with $code, not $1: $(tail -n 1 error)"
    ls ./*.part 2>/dev/null
    [ -s states ] && [ -s log ] || echo 'no tables'
}
key() {
    xdotool key --delay 5 "$@"
}

# shot NAME: a screenshot as NAME.png; prints its step.  Commands are obeyed in
# their order, so it shows what the keys before it did.
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

# toggles KEY NAME: the key changes the picture, and pressed again changes it
# back.
toggles() {
    shot before >/dev/null
    key "$1"
    shot changed >/dev/null
    key "$1"
    shot back >/dev/null
    cmp -s before.png changed.png && echo "$1 does nothing"
    cmp -s before.png back.png || echo "$1 twice is not as before"
}

# without KEY: the key has nothing to do in this scene: only a note says so,
# which the screenshot leaves out.
without() {
    shot before >/dev/null
    key "$1"
    shot changed >/dev/null
    cmp -s before.png changed.png || echo "$1 does something"
}

# Clock ticks of processor time that the program has used.
ticks() {
    sed 's/.*) //' "/proc/$pid/stat" | awk '{ print $12 + $13 }'
}

# Keys of all scenes, in a scene that is paused: on, back, from one end to the
# other, restart, and what only the screen shows.
common_keys() {
    a=$(shot a)
    b=$(shot b)
    [ "$a" = "$b" ] || echo "paused at $a, then at $b"
    key n
    b=$(shot b)
    [ "$b" = $((a + 1)) ] || echo "N: from $a to $b"
    key Left
    b=$(shot back)
    [ "$b" = "$a" ] || echo "Left: back to $b, not $a"
    key Right
    b=$(shot on)
    [ "$b" = $((a + 1)) ] || echo "Right: on to $b"
    key Home
    [ "$(shot c)" = 0 ] || echo 'Home is not step 0'
    key End
    b=$(shot c)
    [ "$b" = $((a + 1)) ] || echo "End: $b"
    toggles h
    toggles question
    toggles F1
    key b
    shot c >/dev/null
    key Escape
    rm -f frames/*
    key r
    frame 0
    [ "$(shot c)" = 0 ] || echo 'R does not begin at 0, or not paused'
}

# Running: Space, and the speed that the texts tell.
square_keys() {
    begin square
    frame 5
    key space
    common_keys
    toggles c
    key space
    frame 9
    key space q
    end 0
}
verdict keys_work_in_square "$(square_keys)"

# The renderer that a graphics card has.
circle_keys() {
    export SDL_RENDER_DRIVER=opengl
    begin circle
    frame 3
    key space
    common_keys
    key Escape Escape
    end 0
    awk -F, 'NR > 1 && $3 > 2 { print "node " $3 }' states
}
verdict keys_work_in_circle "$(circle_keys)"
without_opengl

# Scenes that explain wait at step 0; switching the line search takes the last
# iteration again.
overshoot_keys() {
    begin overshoot
    [ "$(shot a)" = 0 ] || echo 'does not wait at 0'
    common_keys
    key n n l
    b=$(shot a)
    [ "$b" = 2 ] || echo "L leads from 2 to $b"
    key q
    end 0
    awk -F, 'NR > 1 && $5 > 0 { found = 1 }
        END { if (!found) print "no line search" }' log
}
verdict keys_work_in_overshoot "$(overshoot_keys)"

# The change of projection is a change of what the step did.
landscape_keys() {
    begin landscape
    [ "$(shot a)" = 0 ] || echo 'does not wait at 0'
    common_keys
    key n
    shot with >/dev/null
    key p
    b=$(shot without)
    [ "$b" = 1 ] || echo "P leads from 1 to $b"
    cmp -s with.png without.png && echo 'P changes nothing'
    key q
    end 3
}
verdict keys_work_in_landscape "$(landscape_keys)"

# A click is a start; further right is a larger x, further down a smaller y.
mouse_picks() {
    side=900
    old=
    for place in '250 350' '350 350' '250 450'; do
        begin landscape
        # shellcheck disable=SC2086
        xdotool mousemove --window "$window" $place click 1
        a=$(shot a)
        [ "$a" = 0 ] || echo "a click leaves it at step $a"
        key q
        end 0
        new=$(sed -n 2p states | cut -d, -f 4,5)
        echo "$old,$new" | awk -F, -v place="$place" '
            NF == 4 && place ~ /^3/ && !($3 > $1 + 0.1 && $4 == $2) { bad = 1 }
            NF == 4 && place ~ /250 450/ && !($3 == $1 && $4 < $2 - 0.1) {
                bad = 1 }
            bad { print "click at " place ": " $1 "," $2 " to " $3 "," $4 }'
        [ "$place" = '350 350' ] || old=$new
    done
}
verdict clicks_pick_starts "$(mouse_picks)"

# Y writes down what was done; that script leads to the same state, without a
# window.  Where steps do not converge, $ends is 3.
ends=0
same_again() {
    key y
    until_true is_written || echo 'Y leaves no script'
    mv elasto_*.script session
    key q
    end $ends
    tail -n 9 states >seen
    "$elasto" "$@" --headless --quiet --script session --states again \
        2>/dev/null
    code=$?
    [ $code = $ends ] || echo "the script ends with $code"
    tail -n 9 again | cmp -s - seen || echo 'the script leads elsewhere'
}
is_written() {
    test -s "$(echo elasto_*.script)"
}
point() { # X Y: at 900 x 900 the square is where it is, whatever it shows
    xdotool mousemove --window "$window" "$1" "$2"
    sleep 0.1
}

# A real hand: it pulls the middle while the square runs, lets go, pins a
# corner, sees the wheel zoom and 0 fit, and takes steps.
hands() {
    side=900
    begin square --segments 2 --stretch 1 --paused
    point 279 389
    xdotool mousedown 1
    key space
    for i in 1 2 3 4 5 6; do
        point $((279 + 12 * i)) $((389 - 20 * i))
    done
    frame 30
    xdotool mouseup 1
    key space Home
    point 524 634
    xdotool click 3 # at an old step a hand is asked first
    xdotool click 3
    shot before >/dev/null
    point 279 300
    shot plain >/dev/null
    xdotool click 4 click 4
    shot zoomed >/dev/null
    cmp -s plain.png zoomed.png && echo 'the wheel does nothing'
    key 0
    key n n
    same_again square --segments 2 --stretch 1
    for word in grab drag release pin; do
        grep -q " $word" session || echo "no $word"
    done
}
verdict hands_pull_and_pin "$(hands)"

# The first number of the row is typed.
typed() { # TEXT KEY...
    key Tab
    xdotool type --delay 5 "$1"
    shift
    key "$@"
}

# The edge of the paused square, a number that is dragged and taken back, Up;
# what is typed does nothing else.
numbers() {
    side=900
    begin square --segments 2 --stretch 1 --paused
    point 524 260
    xdotool mousedown 1
    point 535 260
    point 560 260
    xdotool mouseup 1
    point 60 757
    xdotool mousedown 1
    point 80 757
    point 110 757
    xdotool mouseup 1
    key Tab Up 5 0 0 0 0 Return
    typed 1/60 Return
    typed '4qsm?' Return Escape
    typed 4ms Return
    key n n
    same_again square --segments 2 --stretch 1
    grep -q ' set stretch 1\.' session || echo 'the edge sets no stretch'
    grep -q ' set timestep 0.0' session || echo 'h was not dragged'
    grep -q ' set stiffness 50000' session || echo 'k was not typed'
    grep -q ' set timestep 0.0166666666666666' session || echo '1/60 is not h'
    grep -q ' set timestep 0.004$' session || echo '4ms is not h'
    [ "$(cut -d' ' -f2 session | sort -u | xargs)" = 'next pause set' ] ||
        cat session
}
verdict edges_and_numbers_are_dragged "$(numbers)"

# Number keys, from each scene to the next and back; the options of the command
# line hold for their own scene.
number_keys() {
    begin square --segments 2
    number=1
    key space
    "$elasto" --list | sed -n 2,9p | while read -r scene rest; do
        number=$((number + 1))
        shot a >/dev/null # paused, so that no frame is being written
        rm -f frames/*
        key $number
        until_true has_title "$scene" || echo "$number is not $scene"
        frame 0
    done
    key 1
    until_true has_title square || echo '1 is not square'
    key q
    end 0
    awk -F, 'NR > 1 && $3 > 8 { print "not two segments: " $0; exit }' states
}
verdict number_keys_switch_scenes "$(number_keys)"

# Line by line through a whole update and back, Tab+M up to six panes, the time
# line dragged, the picture moved and fitted again: all by hand in one window.
session() {
    side=900
    begin square --segments 3 --paused
    key n i i n
    a=$(shot line0)
    [ "$a" = 2 ] || echo "the lines belong to step $a, not 2"
    for i in 1 2 3 4 5 6 7; do
        key n
        shot line$i >/dev/null
        cmp -s line$i.png line$((i - 1)).png && echo "N: line $i is the last"
    done
    for i in 6 5 4 3 2 1 0; do
        key Left
        shot back >/dev/null
        cmp -s back.png line$i.png || echo "Left does not lead to line $i"
    done
    key i n n n n n n n n
    a=$(shot ten)
    [ "$a" = 10 ] || echo "N leads to step $a, not 10"
    point $((11 + 878 * 9 / 60)) 850
    xdotool mousedown 1
    point $((11 + 878 * 7 / 120)) 850
    a=$(shot dragged)
    xdotool mouseup 1
    [ "$a" = 4 ] || echo "the time line was dragged to $a, not 4"
    key End
    point 450 760
    shot plain >/dev/null
    point 150 500
    xdotool mousedown 2
    point 260 560
    point 300 600
    xdotool mouseup 2
    point 450 760
    shot moved >/dev/null
    cmp -s plain.png moved.png && echo 'the middle button does nothing'
    point 60 660
    xdotool click --repeat 2 --delay 60 1
    point 450 760
    shot fitted >/dev/null
    cmp -s plain.png fitted.png || echo 'a double click does not fit'
    for i in 1 2 3 4 5 6; do
        xdotool keydown Tab
        key m
        xdotool keyup Tab
    done
    key n
    same_again square --segments 3
    [ "$(grep -c ' add-pane' session)" = 5 ] || echo 'Tab+M was not told'
    awk -F, 'NR > 1 && $3 > n { n = $3 }
        END { if (n != 6 * 16 - 1) print n + 1, "nodes, not of six panes" }' \
        states
}
verdict a_session_by_hand "$(session)"

# A cell of the map is opened by a click, Y tells how, Escape leads back.
map_cell() {
    side=900
    begin envelope --paused
    key n
    xdotool mousemove --window "$window" 300 500 sleep 0.03 click 1
    until_true has_title square || echo 'a click opens no square'
    key n
    key Escape
    until_true has_title envelope || echo 'Escape does not lead back'
    xdotool mousemove --window "$window" 300 500 sleep 0.03 click 1
    until_true has_title square || echo 'not once more'
    key n
    same_again envelope
    [ "$(grep -c ' scene ' session)" = 3 ] || echo 'Y does not tell of it'
    grep -q ' set stiffness' session || echo 'Y tells of no stiffness'
}
verdict a_cell_of_the_map_is_opened "$(map_cell)"

# Full screen and back: Escape leaves it first, then the program.
full_screen() {
    begin square --paused
    key F11
    sleep 0.3
    key Escape
    a=$(shot a)
    [ "$a" = 0 ] || echo 'Escape ends the program first'
    key Escape
    a=$(shot b)
    [ "$a" = 0 ] || echo 'Escape does not ask again'
    key Escape Escape
    end 0
}
verdict escape_leaves_full_screen_first "$(full_screen)"

# Ctrl+R films, until it is pressed again or the program ends.
films() {
    for last_key in ctrl+r q; do
        begin square --paused
        key ctrl+r
        for step in 1 2 3; do
            key n
            frame $step
        done
        [ $last_key = q ] || key $last_key
        key q
        end 0
        ffprobe -v error -count_frames -of csv=p=0 -show_entries \
            stream=nb_read_frames elasto_square_000000.mp4 >count 2>&1
        [ "$(cat count)" -ge 4 ] || echo "$last_key: $(cat count) frames"
        rm -f ./*.mp4
    done
}
if command -v ffprobe >/dev/null; then
    verdict ctrl_r_films "$(films)"
else
    echo 'skipped ctrl_r_films: no ffmpeg'
fi

# A paused window, once it has drawn itself, uses less than 5 % of a processor.
paused_window() {
    for scene in square landscape; do
        begin $scene
        key space
        shot a >/dev/null
        for second in 1 2 3; do
            used=$(ticks)
            sleep 1
            used=$(($(ticks) - used))
            [ $used -gt 5 ] || break
        done
        [ $used -le 5 ] ||
            echo "$scene: $used ticks in second $second of a pause"
        key q
        end 0
    done
}
verdict a_paused_window_is_idle "$(paused_window)"

# All ways to end, running and paused.
ends() {
    for way in TERM INT; do
        for scene in square circle; do
            begin $scene
            [ $scene = square ] || key space
            kill -$way $pid
            end 0
        done
    done
    begin circle --steps 5
    end 0
    frame 5
    begin circle --steps 5 --speed 8
    end 0
    [ "$(tail -n 1 states | cut -d, -f1)" = 5 ] || echo 'it ends beyond step 5'
    begin overshoot --steps 50
    end 3
    begin unprojected --steps 3
    end 3
}
verdict signals_and_steps_end_the_window "$(ends)"

if compile_close_window "$sources"; then
    verdict closing_the_window_ends_it "$(
        begin square
        ./close_window "$window"
        end 0
        begin landscape
        key space
        ./close_window "$window"
        end 0
    )"
else
    echo "skipped closing_the_window_ends_it: no libX11.so.6 to link with"
fi

# From one pixel to more than the screen, and back; it goes on in all of them.
any_size() {
    look_for_opengl
    begin square --segments 32
    last=0
    large=1500
    [ -z "${LONG:-}" ] || large=4000
    for size in '1 1' "$large $large" '4000 1' '300 200'; do
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

# A step of this square takes seconds; keys and signals end it between Newton
# iterations.
in_a_step() {
    for way in q TERM; do
        begin square --segments 180 --solver newton
        if [ $way = q ]; then key q; else kill -$way $pid; fi
        end 0
        [ "$(newest)" -lt 2 ] || echo "$way: after frame $(newest)"
    done
}
verdict a_window_ends_in_the_middle_of_a_step "$(in_a_step)"

# A q that is typed into a number while a step is made ends nothing.
typed_in_a_step() {
    side=900
    begin square --segments 90 --solver newton --paused
    key Tab n
    xdotool type --delay 5 1q
    key Escape
    a=$(shot a)
    [ "$a" = 1 ] || echo "it is at step $a, not 1"
    key q
    end 0
    side=500
}
verdict a_typed_q_ends_no_step "$(typed_in_a_step)"

# SDL takes another renderer, or the program says that there is none.
no_renderer() {
    look_for_opengl
    export SDL_RENDER_DRIVER=nonsense
    begin square
    frame 5
    key q
    end 0
    unset SDL_RENDER_DRIVER
}
verdict a_renderer_that_is_missing_is_replaced "$(no_renderer)"

# What was recorded is whole, and one line of ours says what happened.
screen_dies() {
    new_screen mortal 1000x1000 || echo 'no second screen'
    mortal=$server
    DISPLAY=:$(cat mortal)
    begin square --segments 16
    frame 10
    kill -KILL $mortal
    end 1
    [ "$(cat error)" = \
        'elasto: drawing failed: the server of the screen is gone' ] ||
        echo "it says $(cat error)"
    for file in frames/*.png; do
        tail -c 8 "$file" | od -An -tx1 | grep -q 'ae 42 60 82' ||
            echo "$file is not whole"
    done
    awk -F, 'NF != columns && columns { print "states: " $0 }
        { columns = NF }' states
}
verdict a_screen_that_dies_leaves_whole_files "$(screen_dies)"

# A server that answers nobody: one signal ends the program within two seconds,
# running, paused, and while the window opens.
screen_stops() {
    new_screen still 1000x1000 || echo 'no second screen'
    still=$server
    DISPLAY=:$(cat still)
    for state in --quiet --paused; do
        begin square $state
        [ $state = --paused ] || frame 5
        kill -STOP $still
        sleep 0.5
        kill -TERM $pid
        timeout=6
        end 0
        timeout=20
        kill -CONT $still
        [ ! -s error ] || echo "it says $(cat error)"
    done
    kill -STOP $still
    "$elasto" square --states states 2>error &
    pid=$!
    sleep 0.5
    kill -TERM $pid
    until_true has_ended $pid || echo 'it opens for ever'
    pid=
    kill -KILL $still
}
verdict a_screen_that_stops_holds_nobody "$(screen_stops)"

exit $failed
