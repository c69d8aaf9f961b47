#!/bin/sh
# Checks build/lecture: one line compiles it, it is short, arguments and
# failures give the right exit codes, its tables agree with elasto's, it draws
# without a screen, and its window closes.
. "$(dirname "$0")/verdict.sh"
lecture=$(realpath "${LECTURE:-build/lecture}")
source=$root/src/lecture.c
work_apart
. "$here/screen.sh"

verdict lecture_is_under_600_lines "$(
    lines=$(wc -l <"$source")
    [ "$lines" -lt 600 ] || echo "it has $lines"
)"

verdict lecture_needs_no_header_of_ours "$(grep -n '#include "' "$source")"

# Compiles lecture.c by the line in its head, which wraps, with the set CC.
verdict one_line_compiles_it "$(
    line=$(sed -n '/^ \*   cc /{N;s/^ \*  *//;s/\\\n \*//p;}' "$source")
    [ "$line" ] || echo 'no such line'
    command -v sdl2-config >/dev/null || line=$(echo "$line" |
        sed 's/\$(sdl2-config[^)]*)/$(pkg-config --cflags --libs sdl2)/')
    cp "$source" . && eval "${CC:-cc} ${line#cc}" 2>&1 | head -n 1
    [ -x lecture ] && ./lecture steps=1 | grep -c . | grep -qx 3 ||
        echo 'what it made does not run'
)"

ends() { # CODE ARGUMENT...
    code=$1
    shift
    refuses "$code" '^lecture: ' "$lecture" "$@"
}
verdict bad_arguments_end_with_2 "$(
    for argument in --help foo k k= =1 k=1x 'k= ' k=nan k=inf rho=0 h=-1 \
        n_seg=1.5 n_seg=1e9 steps=0.5 method=3 K=1 states k=1=2 h=1/0 h=1/ \
        h=1/2/3 n_seg=5/2 h=0,02 h=20ms 'k=1 h=2' 1e5; do
        ends 2 steps=1 "$argument"
    done
)"
verdict the_line_names_value_and_range "$(
    ends 2 n_seg=0
    grep -q "n_seg=0.*from 1 to 1000" error || cat error
    ends 2 side=2
    grep -q "side=2.*side_len=1 rho=1000 k=1e5" error || cat error
)"
# The message for a wrong name lists the default values.
verdict the_line_names_what_stands_without "$(
    "$lecture" steps=3 states=plain >updates
    "$lecture" x 2>error
    given=$(grep -o '[a-z_]*=[0-9][0-9e.]*' error)
    [ "$(echo "$given" | wc -l)" = 8 ] || cat error
    # shellcheck disable=SC2086
    "$lecture" $given steps=3 states=given | cmp - updates && cmp given plain
)"
verdict a_fraction_is_a_number "$(
    "$lecture" steps=1 h=1/64 n_seg=8/4 states=fraction >updates
    "$lecture" steps=1 h=0.015625 n_seg=2 states=plain | cmp - updates
    cmp fraction plain
)"
verdict what_does_not_end_is_ended "$(
    ends 1 steps=1 n_seg=1 tol=1e-30
    ends 1 steps=1 k=1e30 rho=1e-30
    ends 1 steps=2000 method=2 h=0.1
)"

if [ -w /dev/full ]; then
    full() {
        "$lecture" steps=3 >/dev/full 2>error
        [ $? = 1 ] && grep -q 'standard output: No space' error || cat error
        ends 1 steps=3 states=/dev/full
        [ -c /dev/full ] && [ ! -e /dev/full.part ] || echo '/dev/full is gone'
    }
    verdict a_full_disk_is_a_failure "$(full)"
else
    echo "skipped a_full_disk_is_a_failure: no /dev/full"
fi
verdict states_need_their_folder "$(ends 1 steps=1 states=nowhere/states)"

# The file appears under its name only when it is whole.
verdict states_are_whole_or_not_there "$(
    "$lecture" steps=2 states=whole >/dev/null || echo 'it failed'
    [ "$(wc -l <whole)" = 76 ] || echo "whole has $(wc -l <whole) lines"
    ends 1 steps=2 n_seg=1 tol=1e-30 states=broken
    [ ! -e broken ] && [ -s broken.part ] || echo 'a broken run left a file'
    [ ! -e whole.part ] || echo 'whole.part is left'
)"

# same LECTURE-ARGUMENTS ELASTO-OPTIONS: states agree to 1e-8 m and 1e-6 m/s.
# lecture.c tests p before its use, elasto after it, so both run to a tolerance
# at which they end in the same minimum.
same() {
    "$lecture" $1 states=ours >updates || echo "lecture $1 failed"
    "$elasto" --headless --quiet $2 --states theirs ||
        echo "elasto $2 failed"
    paste -d , ours theirs | awk -F , '
        NF != 14 { print "row " NR " is one alone" }
        { for (c = 1; c <= 7 && NR > 1; c++)
              if (!(($c - $(c + 7)) ^ 2 <= (c > 5 ? 1e-12 : 1e-16)))
                  print "row " NR ", column " c ": " $c " " $(c + 7) }
        END { if (NR < 3) print "no rows" }' | head -n 1
    [ "$(wc -l <updates)" -gt 20 ] || echo 'lecture wrote no updates'
}
verdict tables_are_elasto_s "$(
    same 'steps=20 n_seg=7 side_len=0.3 rho=300 k=2e4 initial_stretch=0.7
        h=0.02 tol=1e-9' '--steps 20 --segments 7 --side 0.3 --density 300
        --stiffness 2e4 --stretch 0.7 --timestep 0.02 --tolerance 1e-9'
)"

# drawn STEP BLUE ALL WIDTH HEIGHT: pixels that are blue, that are not white, and
# the size of what they show; each to 2 %.
drawn() {
    od -An -tx1 -v -j54 -w1800 "lecture_pictures/step_$1.bmp" | awk -v to="$*" '
        { for (i = 1; i < 1800; i += 3)
              if ((colour = $i $(i + 1) $(i + 2)) != "ffffff") {
                  blue += colour == "ff0000"
                  all++
                  left = !left || i < left ? i : left
                  right = i > right ? i : right
                  low = low ? low : NR
                  high = NR
              } }
        END { split(blue " " all " " (right - left) / 3 " " high - low, is)
              split(to, was)
              for (k = 1; k <= 4; k++)
                  if ((is[k] - was[k + 1]) ^ 2 > (0.02 * was[k + 1]) ^ 2)
                      print "step, pixels " to ": " is[k] }'
}
verdict without_a_screen_it_draws_pictures "$(
    "$lecture" states=drawn >out 2>error || echo "failed: $(tail -n 1 error)"
    grep -q '^no screen: 100 pictures go to lecture_pictures/$' out ||
        echo 'it does not say so'
    [ "$(ls lecture_pictures | grep -c '^step_[0-9]*\.bmp$')" = 101 ] ||
        echo "$(ls lecture_pictures | wc -l) pictures"
    [ "$(cksum lecture_pictures/*.bmp | cut -d ' ' -f 1 | sort -u |
        wc -l)" -gt 50 ] || echo 'they are all alike'
    drawn 000 7135 16459 310 224
    drawn 020 6458 13592 238 228
    [ "$(wc -l <drawn)" = 2526 ] || echo "drawn has $(wc -l <drawn) lines"
)"
verdict pictures_that_cannot_be_written_fail "$(
    mkdir closed && : >closed/lecture_pictures && cd closed &&
        "$lecture" >out 2>error
    [ $? = 1 ] && grep -q '^lecture: cannot write' error || cat error
)"

missing=$(missing_program Xvfb xdotool)
if [ "$missing" ]; then
    echo "skipped the_window_closes: no $missing"
    exit $failed
fi
find_window() {
    window=$(xdotool search --name '^lecture: ' 2>/dev/null | tail -n 1)
    [ -n "$window" ]
}
# closes COMMAND...: the command closes the window; the states are whole.
closes() {
    rm -f seen
    "$lecture" states=seen >out 2>error &
    pid=$!
    until_true test -s out || echo 'no step' # SDL may create a window twice
    until_true find_window || echo 'no window'
    "$@" "$window" || echo "$1 failed"
    ends_with 0
    [ -s seen ] && [ ! -e seen.part ] || echo 'states are not whole'
}
escape() {
    timeout $timeout xdotool windowfocus --sync "$1" key Escape
}
# Drags the upper right node, 150 and 107 pixels from the middle of the window,
# upwards from (0.7, 0.5) to (0.7, 0.7933).
lives() {
    timeout $timeout xdotool windowfocus --sync "$1" \
        mousemove --window "$1" 452 191 mousedown 1 \
        mousemove --window "$1" 450 130
    until_true is_led || echo "the node is led to $(tail -n 1 seen.part)"
    xdotool mouseup 1
    escape "$1"
}
is_led() {
    tail -n 1 seen.part | awk -F , '{ off = ($4 - 0.7) ^ 2 + ($5 - 0.7933) ^ 2
        exit !($3 == 24 && off < 1e-4) }'
}

start_screen 1000x1000
# SDL ignores a click that arrives together with the focus.
export SDL_MOUSE_FOCUS_CLICKTHROUGH=1
verdict it_lives "$(closes lives)"
verdict escape_closes_the_window "$(closes escape)"
if compile_close_window; then
    verdict the_cross_closes_the_window "$(closes ./close_window)"
else
    echo "skipped the_cross_closes_the_window: no libX11"
fi

exit $failed
