#!/bin/sh
# Rows of command lines: exit code, words of the message, and checks of the
# tables that they write.
. "$(dirname "$0")/verdict.sh"
work_apart

# ---- what is refused ---------------------------------------------------------
# Refused lines: exit code, words of the one line on standard error, arguments.
# k.csv is a file, d a folder, jump a script; no file is made or changed.
refusals() {
    echo precious >k.csv
    mkdir d
    echo '0 jump' >jump
    ls -A >../before.$$
    while IFS='|' read -r expected words arguments; do
        # shellcheck disable=SC2086
        timeout 300 "$elasto" $arguments >../out.$$ 2>../error.$$
        code=$?
        [ $code = "$expected" ] || echo "$arguments: exit $code"
        [ "$(wc -l <../error.$$)" -eq 1 ] && grep -q -e "$words" ../error.$$ ||
            echo "$arguments: $(cat ../error.$$)"
        [ ! -s ../out.$$ ] || echo "$arguments: something on standard output"
        [ "$(cat k.csv)" = precious ] || echo "$arguments: k.csv is lost"
        ls -A | cmp -s - ../before.$$ || echo "$arguments: $(ls -A)"
    done
}
mkdir refused
cd refused || exit 1
verdict refused_lines_change_no_file "$(refusals <<END
1|too large.*fewer --segments|--segments 3000 --body 0,0 --body 2,0
2|line 1.*'jump'.*--help commands$|--headless --script jump
2|--states and --log are one file, 'k.csv'|--states k.csv --log k.csv
2|nowhere: No such file|--headless --script nowhere
2|^elasto: --vtk is gone: --states .* CSV$|--vtk n
2|--states: 'n.npz': tables are CSV|--headless --states n.npz
2|--state: 'k.csv.gz': tables are CSV, but .gz|--headless --state k.csv.gz
2|.mp4, .webm, .gif or .apng|--headless --film n.avi
2|does not end|--headless --film n.avi --timestep 0.004,0.01
1|Is a directory|--headless --states d
1|No such file|--headless --states d/e/k.csv
1|/dev/full: No space|--headless --quiet --steps 5 --states /dev/full
1|nowhere/pictures: No such|--headless --quiet --frames nowhere/pictures
1|k.csv/.*: Not a directory|--headless --quiet --frames k.csv
1|step .*NaN or infinite.*--timestep|--headless --quiet --integrator forward-euler --timestep 1
2|--script: k.csv, line 1: write STEP COMMAND|--headless --script k.csv
2|--state 'd': Is a directory|--headless --state d
2|--state 'nowhere': No such file|--headless --state nowhere
2|--state 'k.csv': its first line, 'precious', has no column 'step'|--headless --state k.csv
1|d/: Is a directory|--headless --energies d/
1|nowhere/f.mp4: No such file|--headless --film nowhere/f.mp4
1|aaa: File name too long|--headless --states $(printf 'a%.0s' $(seq 300))
2|more than 64 side by side|--headless --stiffness $(seq -s , 65)
1|pane 2, step .*NaN|--headless --quiet --timestep 0.05 --integrator bdf2,forward-euler
END
)"
cd "$work" || exit 1

# Checks that no ASCII control character reaches the terminal.
odd=$(printf 'no\nwhere\033[31m\177x')
one_clean_line() { # what
    [ "$(wc -l <error)" -eq 1 ] || echo "$1: $(wc -l <error) lines"
    LC_ALL=C grep -q "$(printf '[\033\177]')" error &&
        echo "$1: a control gets through"
}
names() {
    printf '0 %s\n' "$odd" >script
    while read -r option; do
        "$elasto" --headless --quiet --steps 1 "$option$odd" >out 2>error &&
            echo "$option: it is taken"
        one_clean_line "$option"
    done <<'END'
--states=/nowhere/
--frames=/dev/null/
--film=
--script=
--script=script
--
--side=
x
END
    "$elasto" --headless --quiet --steps 1 --states "$odd" 2>error || cat error
    rm "$odd"
    "$elasto" --headless --steps 0 --frames "$odd" >out
    [ "$(wc -l <out)" = $(($("$elasto" --headless --steps 0 | wc -l) + 1)) ] ||
        echo "the summary has $(wc -l <out) lines"
}
verdict messages_are_one_line "$(names)"

verdict summaries_have_what_was_done_in_each_pane "$(
    "$elasto" --headless --steps 2 --timestep 0.004,0.01 |
        sed -n 's/^pane.* h //p; s/^steps  *\([0-9]*\)$/\1/p
            s/^simulated time *//p' | tr '\n' ';' |
        grep -qx '0.004 s;5;0.02 s;0.01 s;2;0.02 s;' || echo 'other numbers'
    [ -z "$("$elasto" --headless --quiet --steps 5 2>&1)" ] || echo 'not quiet'
)"

if [ -c /dev/full ]; then
    verdict a_full_output_is_reported "$(
        for arguments in --help --version --list '--headless --steps 1'; do
            # shellcheck disable=SC2086
            "$elasto" $arguments >/dev/full 2>error
            [ $? = 1 ] && [ "$(cat error)" = \
                "elasto: standard output: No space left on device" ] ||
                echo "$arguments: $(cat error)"
        done
    )"
fi

# Each value of a list has a run, equal to that of the value alone; a reader
# that closes the pipe ends them silently.
verdict a_sweep_has_a_run_for_each_value "$(
    values=$(seq -s , 1000 1000 20000)
    "$elasto" --headless --quiet --steps 3 --stiffness "$values" --states all ||
        echo "exit $?"
    for pane in 1 7 20; do
        "$elasto" --headless --quiet --steps 3 --stiffness "${pane}000" \
            --states one
        awk -F, -v pane=$pane 'NR > 1 && $8 == pane' all | cut -d, -f4-7 >its
        tail -n +2 one | cut -d, -f4-7 | cmp - its
    done
    rm -f all one its
)"
# Frames of an earlier run that are not replaced are named.
verdict frames_of_an_earlier_run_are_named "$(
    frames() { # STEPS MESSAGE
        "$elasto" --headless --quiet --size 64x64 --steps "$1" --frames fr \
            2>error || echo "exit $?"
        [ "$(cat error)" = "$2" ] || cat error
    }
    mkdir fr
    : >fr/frame_7.png && : >fr/frame_0000070.png && : >fr/frame_000001.png.part
    frames 4 ''
    frames 4 ''
    frames 3 'fr/: frames of an earlier run stay: 1, from frame_000004.png to frame_000004.png'
    frames 1 'fr/: frames of an earlier run stay: 3, from frame_000002.png to frame_000004.png'
    frames 4 ''
    rm -r fr
)"
verdict a_reader_that_leaves_gets_no_message "$(
    for arguments in --help --list '--help commands' '--headless --steps 5' \
        '--headless --states -'; do
        # shellcheck disable=SC2086
        (sleep 0.2; "$elasto" $arguments 2>error; echo $? >code) | :
        until_true test -s code
        [ "$(cat code)" = 1 ] && [ ! -s error ] ||
            echo "$arguments: exit $(cat code): $(cat error)"
        rm -f code
    done
)"

# ---- what scenes leave -------------------------------------------------------
# Rows: exit code, rows of the states, arguments; the line below is a test in
# awk, which prints errors, of the log, the summary, or else the states.
scenes() {
    while IFS='|' read -r expected rows arguments && read -r test; do
        # shellcheck disable=SC2086
        timeout 300 "$elasto" $arguments --headless --states states --log log \
            >summary 2>error
        code=$?
        [ $code = "$expected" ] || echo "$arguments: exit $code"
        [ $(($(wc -l <states) - 1)) = "$rows" ] ||
            echo "$arguments: $(wc -l <states) lines"
        case $test in
        summary*) awk "${test#summary}" summary ;;
        log*) awk -F, "${test#log}" log ;;
        *) awk -F, "$test" states ;;
        esac | sed "s/^/$arguments: /"
    done
}
verdict scenes_leave_what_they_should "$(scenes <<'END'
3|3|overshoot
(NR == 3 && $4 > -11.6449585) || (NR == 4 && !($4 > 3.2e9 && $4 < 3.3e9)) || (NR > 1 && $2 != 0)
3|3|overshoot
summary /^steps not converged 1/ { n = 1 } /^(simulated|energy)/ { print } END { if (!n) print "the summary is silent" }
0|50|square --steps 1 --stretch 1
summary /^energy at start.* -0 J/ || (/^wall time/ && $3 > 300)
0|3468|square --steps 2 --segments 33
summary /^V-cycles  *[1-9]/ { n = 1 } /^(factorisations|solves)/ { n = 0 } END { if (!n) print "not by V-cycles" }
0|100|square --steps 3 --stretch 0 --timestep 0.1 --projection none
summary /^not at a minimum  *3$/ { n = 1 } END { if (!n) print "it is not said" }
0|100|square --steps 3 --stretch 0 --timestep 0.1
summary /^not at a minimum/
END
)"

exit $failed
