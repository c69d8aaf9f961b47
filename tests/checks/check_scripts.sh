#!/bin/sh
# Checks scripts: a script with every command ends on each scene, and twice with
# the same state on some scenes (LONG=1: all).
. "$(dirname "$0")/verdict.sh"

work_apart
table=$root/include/play/command_rows.def

# Each command of the table, on the way through a scene and back, by step
awk '{ step = $1; sub("[0-9]* ", ""); n = split($0, all, "; ")
    for (i = 1; i <= n; i++) print step, all[i] }' >commands <<'END'
0 page-on; page-back; page solid; pages; code; escape; scene SCENE; colours
0 keys; keys; letters; letters; bare; bare; faster; slower; card 0; enlarge 1; fit
0 zoom 150 0.1 0.2; pan 0.1 -0.1; blank; blank; sheet; sheet; full-screen
0 full-screen; select; raise; lower; default stretch; start 0.3 0.2
0 set timestep 0.005; handle 0 0.2 0.1; flip 0; predict 0.5 0.2; cell 3
0 options; options; add gravity; place 1 0.1 0.1; obstacle 0 0 -2; push 0; grab 2; play
2 drag 0.6 -0.5
3 drag 0.7 -0.2
4 release; pin 1
5 projection; play
6 projection; play
7 line-search; play
8 line-search; pause; back
7 back
6 next
7 finer; next; finer; next; next; back; finer; home
0 end
9 goto 3
3 shot; film; step
4 film; hash; add-pane; step
5 pane 1; set tolerance 0.001; method; step
6 undo
5 undo; redo; redo
6 step; end-pane; step
7 restart
0 step
1 step
2 quit
END

missing_words() {
    words=$(sed -n 's/^ROW([A-Z_]*, [a-z_]*, "\([a-z-]*\)".*/\1/p' "$table")
    [ "$(echo "$words" | wc -l)" -gt 40 ] || echo 'the table was not read'
    for word in $words; do
        grep -q "^[0-9]* $word\( \|$\)" commands || echo "no $word"
    done
}
verdict the_script_has_every_command "$(missing_words)"

# run SCENE: prints the hash of the last state.
run() {
    sed "s/SCENE/$1/" commands >"$1.script"
    timeout 600 "$elasto" --headless --script "$1.script" "$1" >out 2>error
    code=$?
    case $code in
    0 | 2 | 3) sed -n 's/^state hash *//p' out ;;
    *) echo "ends with $code: $(tail -n 1 error)" ;;
    esac
    rm -f elasto_*
}
on_every_scene() {
    "$elasto" --list | while read -r scene rest; do
        first=$(run "$scene")
        [ ${#first} = 16 ] || echo "$scene: $first"
        case ${LONG:+all}$scene in
        all* | square | dial)
            again=$(run "$scene")
            [ "$first" = "$again" ] || echo "$scene: $first, then $again"
            ;;
        esac
    done
}
verdict every_command_on_every_scene "$(on_every_scene)"

# Invalid commands are reported and skipped, and the exit code is that of a bad
# command line.
refusals() {
    printf '0 pin 999\n0 set timestep -1\n1 set foo 1\n1 step\n2 quit\n' \
        >bad.script
    "$elasto" --headless --quiet --script bad.script --states states 2>error
    [ $? = 2 ] || echo 'a refused command is no bad command line'
    [ "$(grep -c '^script: step [01]: ' error)" = 3 ] &&
        grep -q "'set foo 1': there is no option 'foo' " error || cat error
    [ "$(tail -n 1 states | cut -d, -f1)" = 2 ] || echo 'the rest is not done'
}
verdict invalid_script_lines_are_reported "$(refusals)"

# A script that asks for a step after the last one ends without waiting.
ends_of_runs() {
    for beyond in '2 hash' '2 goto 50'; do
        printf '0 pause\n0 step\n1 step\n%s\n2 quit\n' "$beyond" >end.script
        "$elasto" --headless --script end.script 2>error |
            sed -n 's/^state hash *//p'
        rm -f elasto_*
    done | sort -u | wc -l | grep -qx 1 || echo 'a step beyond the newest'
    "$elasto" --headless --segments 2 | grep -q '^steps  *100$' ||
        echo 'not 100 steps without a window'
    printf '0 pause\n9 step\n' >late.script # a line waits while steps are made
    timeout 60 "$elasto" --headless --segments 2 --script late.script |
        grep -q '^steps  *1$' || echo 'a line of a script waits for ever'
    echo '0 play' >play.script
    "$elasto" --headless --quiet --integrator forward-euler --timestep 0.1 \
        --steps 30 --script play.script 2>error
    code=$?
    [ $code = 1 ] || echo "a failing run ends with $code"
}
verdict runs_have_ends "$(ends_of_runs)"

# Checks that the line printed by Y leads to its state from any command line.
leads() { # ARGUMENT...
    "$elasto" --headless --quiet "$@" --script y.script 2>told
    told=$(sed -n 's/^state \([0-9a-f]*\) at step [0-9]*: elasto /\1 /p' told)
    echo "'$elasto' ${told#* }" >line
    sh line >out 2>error
    grep -qx "state hash  *${told%% *}" out || echo "$*: $(cat told error out)"
    for file in elasto_*.script; do
        [ ! -e "$file" ] ||
            [ "$(head -n 1 "$file")" = "# elasto ${told#* }" ] || cat "$file"
        rm -f "$file"
    done
}
lines_of_y() {
    "$elasto" --headless --quiet --steps 1 --states "it's a \"table\".csv"
    echo '3 hash' >y.script
    leads --state "it's a \"table\".csv" --gravity '9 m/s^2' --pin ''"$(seq -s , 24)"
    leads --lecture
    printf '0 set segments 3\n1 set stiffness 2e4\n3 hash\n' >y.script
    leads --at '0 m,1 m' --steps=9 --gravity=9.81 --states y.csv
    leads drop --pin "$(seq -s , 0 9)" --log y.csv
    set --
    for i in $(seq 16); do
        set -- "$@" --body "$((2 * i)).00000000,0.00000000,$i.000000"
    done
    leads "$@" --speed 2 --timestep 0.002,0.004
}
verdict the_line_of_y_leads_there "$(lines_of_y)"

# Recorded sessions of twenty seconds of pushing, pressing and throwing end in
# the recorded state, with pictures and without.
pushes_end() {
    script=$root/tests/data/push.script
    line=$(sed -n 's/^# line: //p' "$script")
    wanted=$(sed -n 's/^# ends: //p' "$script")
    for frames in '' '--frames frames --size 40x30'; do
        # shellcheck disable=SC2086
        found=$("$elasto" $line --headless $frames --script "$script" |
            sed -n 's/^state hash *//p')
        [ "$found" = "$wanted" ] || echo "$found, not $wanted"
    done
}
verdict twenty_seconds_of_pushing_have_one_hash "$(pushes_end)"

# Checks that the exit code is that of the worst pane.
each_pane() {
    for pair in none,clamp clamp,none; do
        "$elasto" unprojected --headless --quiet --steps 5 --projection $pair
        code=$?
        [ $code = 3 ] || echo "$pair ends with $code"
    done
}
verdict every_pane_counts "$(each_pane)"

# Panes share one time; files have the rows of all panes.
panes() {
    "$elasto" --headless --quiet --steps 4 --states states.csv \
        --timestep 0.001,0.002 --projection clamp,none || echo "ends with $?"
    awk -F, 'NR > 1 { nodes[$1]++; time[$1 "," $2] = 1 }
        END { for (s = 0; s < 5; s++) if (nodes[s] != 100) print "step", s, nodes[s]
              n = 0; for (t in time) n++
              if (n != 5) print n, "times for 5 steps" }' states.csv
    "$elasto" --headless --quiet --steps 4 --log log.csv \
        --timestep 0.001,0.002 || echo "ends with $?"
    awk -F, 'NR == 1 { if ($NF != "pane") print "no column of panes" }
        NR > 1 && $1 < step { print "row", NR, "goes back to step", $1 }
        NR > 1 { step = $1; if ($(11) != "running") ends[$1 "," $NF]++ }
        END { for (s = 1; s < 5; s++)
            if (ends[s ",1"] != 2 || ends[s ",2"] != 1)
                print "step", s, ends[s ",1"] + 0, ends[s ",2"] + 0 }' log.csv
}
verdict panes_have_one_time "$(panes)"

# Checks that the last ledger row of a step has the numbers from which the run
# continues, even after going back, undo and redo. Each line is a script; its
# last rows equal those of the first script.
ledgers() {
    first='2 set stiffness 2e4\n4 set stiffness 5e4\n'
    while read -r rest; do
        printf "$first$rest" >script
        "$elasto" --headless --quiet --segments 2 --steps 8 --script script \
            --energies rows || echo "$rest: ends with $?"
        awk -F, '{ row[$1] = $0 } END { for (i in row) print row[i] }' rows |
            sort -n >ledger
        [ -f straight ] || cp ledger straight
        rows=$(wc -l <ledger)
        [ "$rows" -ge 6 ] || echo "$rest: only $rows rows"
        head -n "$rows" straight | cmp -s - ledger ||
            echo "$rest changes the ledger: $(diff straight ledger | head -n 2)"
    done <<'END'
8 pause
6 undo\n4 undo\n2 redo\n4 redo\n
6 undo\n4 redo\n
4 undo\n4 undo\n2 redo\n4 redo\n
6 goto 3\n3 goto 1\n1 goto 6\n
5 pin 0\n5 undo\n5 undo\n4 redo\n
7 set timestep 0.01\n7 undo\n
6 undo\n4 undo\n2 goto 1\n1 goto 2\n2 redo\n4 redo\n
END
}
verdict undo_leaves_the_ledger "$(ledgers)"

exit $failed
