#!/bin/sh
# Checks that the log tells how each minimisation ended, even one that began at
# its minimum, and that the summary has the same counts.
. "$(dirname "$0")/verdict.sh"
work_apart

# ends STAGES LINE: complains unless the log of this line has STAGES ends of
# minimisations in each step, and the same steps that did not converge, with the
# same reasons, as the summary.
ends() {
    stages=$1
    shift
    "$elasto" --headless --log log "$@" >summary 2>error
    code=$?
    steps=$(sed -n 's/^steps  *\([0-9]*\)$/\1/p' summary)
    awk -F, -v stages="$stages" -v steps="$steps" -v line="$*" '
        NR == 1 { next }
        $11 != "running" { ends[$1]++; all++ }
        $11 != "running" && $11 != "ok" { bad[$1] = $11 }
        END {
            if (all != stages * steps)
                print line ": " all " ends of " stages * steps
            for (step in ends)
                if (ends[step] != stages)
                    print line ": step " step " has " ends[step] " ends"
            for (step in bad) {
                count++
                reasons[bad[step]]++
            }
            print "steps not converged " count + 0 >"told"
            for (name in reasons)
                print name " " reasons[name] >"told"
        }' log
    sed -n 's/^\(steps not converged [0-9]*\).*/\1/p
        s/^  \([a-z_]*\)  *\([0-9]*\)$/\1 \2/p' summary | sort >summed
    sort told | cmp -s - summed ||
        echo "$*: the log tells $(cat told), the summary $(cat summed)"
    grep -q ' converged 0$' told && expected=0 || expected=3
    [ "$code" -eq $expected ] || echo "$*: exit $code"
}

verdict the_log_says_how_each_step_ended "$(
    ends 1 --steps 40
    ends 1 --steps 20 --tolerance 1e-30
    ends 1 --steps 20 --tolerance 1e-14 --stretch 1
    ends 2 --steps 20 --integrator sdirk2
    ends 2 --steps 20 --integrator sdirk2 --tolerance 1e-30
    ends 1 --steps 60 --integrator bdf2 --tolerance 1e-13
    ends 1 --steps 30 --solver multigrid --tolerance 1e-30
    ends 1 --steps 20 --integrator midpoint --tolerance 1e-12 --timestep 1
)"
verdict steps_that_did_not_converge_are_reported "$(
    ends 1 --steps 10 --projection none --timestep 0.02 --stretch 0.5
    ends 1 --steps 10 --line-search none --timestep 0.05 --stretch 0.3
    ends 1 --steps 10 --line-search none --projection none --timestep 0.05 \
        --stretch 0.5 --segments 1
    ends 1 --steps 5 --segments 1 --stiffness 1e30 --tolerance 1e-14
    ends 1 --steps 5 --stiffness 1e15 --timestep 100
    ends 1 --steps 30 unprojected
)"
# A step that a moving wall or pin ends has a row of its own in the log, besides
# those of its minimisations.
told() { # REASON LINE
    reason=$1
    shift
    "$elasto" --headless --quiet --log log "$@" >/dev/null 2>error
    [ $? = 3 ] || echo "$*: it does not end with 3"
    "$elasto" --headless "$@" 2>error |
        sed -n "s/^  $reason  *\([0-9]*\)\$/\1/p" >summed
    [ -s summed ] || echo "$*: nothing is $reason"
    grep -c ",$reason," log | cmp -s - summed ||
        echo "$*: $reason $(cat summed), in the log $(grep -c ",$reason," log)"
}
verdict blocked_steps_are_reported "$(
    told blocked squeeze --segments 4 --pin top --steps 30
    told blocked tear --segments 4 --ground 1,0,-0.52,0 --timestep 0.01 \
        --steps 30
    told blocked return --segments 4 --body 0,0 --body 0,1.1 \
        --ground 0,1,0,-0.6 --ceiling 1.7,-50,-5 --steps 8
)"
verdict energy_from_nothing_is_reported "$(
    set -- --headless --segments 6 --self-contact on --material neo-hookean \
        --body 0,0,0,8,0 --body 1.2,0.1,3,-8,0 --steps 5
    "$elasto" "$@" --timestep 0.1 |
        grep -q '^energy gained  *3.335e+04 J without work, in 1 steps' ||
        echo 'not in the summary'
    "$elasto" "$@" --timestep 0.002 | grep gained
)"
verdict a_start_that_is_the_minimum_is_reported "$(
    ends 1 --steps 5 --stretch 1
    [ "$(grep -c ,ok, log)" -eq 5 ] && [ "$(wc -l <log)" -eq 6 ] ||
        echo 'a step at rest is not told, or not one update'
)"

# kinds KIND AWK LINE: complains unless AWK picks rows of the log of this line,
# and all of them have this kind.
kinds() {
    kind=$1 pick=$2
    shift 2
    "$elasto" --headless --log log --steps 3 "$@" >summary
    awk -F, -v kind="$kind" -v line="$*" '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == "kind") at = i; next }
        '"$pick"' { rows++; bad += $at != kind }
        END { if (!at || !rows || bad)
                  print line ": " bad + 0 " of " rows + 0 " rows" }' log
}
verdict the_log_says_the_kind_of_each_residual "$(
    # residuals by a factor of the same Hessian, and by an older factor
    kinds value '$9 == 1' --segments 4
    kinds estimate '$9 == 0' --segments 4
    kinds estimate 1 --segments 33
    kinds value 1 --stretch 1
    kinds value '$NF == 2' --projection clamp,none
)"

# Compares summaries, without run times, with tests/data/summaries.txt.
verdict summaries_say_what_runs_have_done "$(
    sed -n 's/^> //p' "$root/tests/data/summaries.txt" | while read -r line; do
        echo "> $line"
        eval "timeout 60 \"\$elasto\" --headless $line" 2>&1 | grep -v '^wall time'
    done | diff "$root/tests/data/summaries.txt" - | head -n 3
)"
exit $failed
