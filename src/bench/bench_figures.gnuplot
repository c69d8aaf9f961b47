# Figures of what elasto-bench measured: gnuplot -c bench_figures.gnuplot DATA
# PICTURES.  All go to the folder DATA, where the CSV files are; the one of
# the README, of a full run only, to PICTURES too.
data = ARG1
pictures = ARG2
set datafile separator ","
set terminal svg size 960,760 font "sans,13" background "white"
set tics nomirror
set border 3
set grid lc rgb "#dddddd" lw 0.5

has(name) = int(system("[ -f '".data."/".name.".csv' ] && echo 1 || echo 0"))
said(name, change) = system("sed -n '1s/^# //p' '".data."/".name.".csv' | " \
    ."sed -e '".change."'")
machine(name) = said(name, "s/; flags.*//")."\n" \
    .said(name, "s/.*; processor/processor/; s/, of which.*;/;/")
is_quick(name) = machine(name)[strlen(machine(name)) - 8:] eq "quick run"

# ---- error against processor time --------------------------------------------------
# Columns: 1 case, 2 segments, 3 integrator, 4 solver, 9 run time, 10 error,
# 15 failed.
work = data."/work_precision.csv"
methods = "forward-euler symplectic-euler verlet backward-euler bdf2 " \
    ."midpoint sdirk2 avf avf4"
array colour[9] = ["#999999", "#e69f00", "#d55e00", "#000000", "#56b4e9", \
    "#0072b2", "#009e73", "#cc79a7", "#7a3e9d"]
array mark[9] = [7, 7, 7, 4, 4, 4, 4, 4, 4]
method(i) = word(methods, i)
solver(i) = i <= 3 ? "none" : "multigrid"
is_row(kind, size, name, by) = strcol(1) eq kind && $2 == size \
    && strcol(3) eq name && strcol(4) eq by

work_panel(kind, size, column, failed_at) = \
    "plot for [i=1:9] work using (is_row('".kind."', ".size.", method(i), " \
    ."solver(i)) && $15 == 0 ? $9 : 1/0):".column." with linespoints lw 1.5 " \
    ."ps 0.5 pt mark[i] lc rgb colour[i] title method(i), " \
    ."for [i=1:9] work using (is_row('".kind."', ".size.", method(i), " \
    ."solver(i)) && $15 == 1 ? $9 : 1/0):(".failed_at.") with points pt 2 " \
    ."ps 0.6 lc rgb colour[i] notitle"

# An empty panel for the legend and what the figure does not say itself.
work_legend = "plot for [i=1:9] NaN with linespoints lw 1.5 ps 0.7 " \
    ."pt mark[i] lc rgb colour[i] title method(i).(i <= 3 ? ', explicit' " \
    .": ', implicit'), NaN with points pt 2 lc rgb '#555555' " \
    ."title 'failed: not finite, not converged, or gone'"

set_axes = "set logscale xy; set format xy '10^{%L}'; set xrange [*:*]; " \
    ."set xlabel 'processor time, s'; unset key"
set_error = set_axes."; set yrange [1e-9:1]; " \
    ."set ylabel 'position error at the end, m'"
set_drift = set_axes."; set yrange [1e-16:10]; " \
    ."set ylabel 'energy at the end / at the start - 1'"
set_legend = "unset logscale; unset tics; unset border; unset xlabel; " \
    ."unset ylabel; unset title; unset grid; set xrange [0:1]; " \
    ."set yrange [0:1]; set key center center left reverse Left " \
    ."samplen 2 spacing 1.25"
unset_legend = "reset; set datafile separator ','; set tics nomirror; " \
    ."set border 3; set grid lc rgb '#dddddd' lw 0.5"

work_title(kind, size) = sprintf("%s, %s x %s cells", kind eq "soft" \
    ? "soft (k = 10^5 J/m^2), 0.1 s" : kind eq "stiff" \
    ? "stiff (k = 10^9 J/m^2), 0.02 s" \
    : "stiff and turning slowly, 0.1 s", size, size)

if (has("work_precision")) {
    files = "'".data."/work_precision.svg'"
    if (!is_quick("work_precision")) {
        files = files." '".pictures."/work_precision.svg'"
    }
    shown = is_quick("work_precision") ? "soft:4 stiff:4 spinning:4" \
        : "soft:16 soft:64 soft:128 stiff:16 spinning:16"
    set terminal svg size 1300,760 font "sans,13" background "white"
    do for [file in files] {
        set output file
        set multiplot layout 2,3 title machine("work_precision") font ",9"
        do for [panel in shown] {
            kind = panel[:strstrt(panel, ":") - 1]
            size = panel[strstrt(panel, ":") + 1:]
            eval(set_error)
            set title work_title(kind, size)
            eval(work_panel(kind, size, "10", "0.6"))
        }
        eval(set_legend)
        eval(work_legend)
        unset multiplot
        eval(unset_legend)
    }
    panels = system("sed -e 1,2d '".work."' | cut -d , -f 1,2 | tr , : | " \
        ."uniq | tr '\n' ' '")
    set terminal svg size 1300,1050 font "sans,12" background "white"
    do for [what in "error drift"] {
        set output data."/work_precision_".what.".svg"
        set multiplot layout 3,3 title machine("work_precision") font ",9"
        do for [panel in panels] {
            kind = panel[:strstrt(panel, ":") - 1]
            size = panel[strstrt(panel, ":") + 1:]
            eval(what eq "error" ? set_error : set_drift)
            set title work_title(kind, size)
            eval(what eq "error" ? work_panel(kind, size, "10", "0.6") \
                : work_panel(kind, size, "11", "5"))
        }
        eval(set_legend)
        eval(work_legend)
        unset multiplot
        eval(unset_legend)
    }
} else {
    print "no ".work
}

# ---- milliseconds a step -----------------------------------------------------
# Columns: 1 solver, 2 segments, 4 total, 11 bare.
if (has("solver")) {
    steps = data."/solver.csv"
    set terminal svg size 760,600 font "sans,13" background "white"
    set output data."/solver.svg"
    set title machine("solver") font ",9"
    set logscale xy 10
    set xtics (4, 8, 16, 32, 64, 128, 256)
    set xlabel "segments per side"
    set ylabel "time of a step, ms"
    set key top left reverse Left
    names = "plain newton multigrid"
    array shade[3] = ["#999999", "#0072b2", "#d55e00"]
    set xrange [3.5:300]
    of(i) = "< grep '^".word(names, i).",' '".steps."'"
    plot for [i=1:3] of(i) using 2:4 with linespoints pt 7 ps 0.6 lw 1.5 \
            lc rgb shade[i] title word(names, i), \
        for [i=2:3] of(i) using 2:11 with lines dt 2 lc rgb shade[i] \
            title word(names, i)."'s calls of factor and solve alone"
    eval(unset_legend)
} else {
    print "no ".data."/solver.csv"
}

# ---- filters -----------------------------------------------------------------
# Columns: 1 filter, 2 time step, 3 stretch, 4 steps, 5 iterations,
# 8 unconverged, 9 failed.
if (has("filters")) {
    rows = data."/filters.csv"
    names = system("sed -e 1,2d -e 's/,.*//' '".rows."' | sort -u | " \
        ."tr '\n' ' '")
    set terminal svg size 960,460 font "sans,13" background "white"
    set output data."/filters.svg"
    set multiplot layout 1,2 title machine("filters") font ",9"
    do for [h in "0.004 0.02"] {
        set title "time step ".h." s, ten steps, 8 x 8 cells"
        set xlabel "stretch at the start"
        set ylabel "Newton iterations"
        set yrange [0:*]
        set key top left reverse Left
        plot for [i=1:words(names)] rows using \
                (strcol(1) eq word(names, i) && $2 == h + 0 && $8 + $9 == 0 \
                ? $3 : 1/0):5 with linespoints pt 7 ps 0.6 lw 1.5 lc i \
                title word(names, i), \
            for [i=1:words(names)] rows using \
                (strcol(1) eq word(names, i) && $2 == h + 0 && $8 + $9 > 0 \
                ? $3 : 1/0):5 with points pt 2 ps 1 lw 2 lc i notitle, \
            NaN with points pt 2 lc rgb "#555555" \
                title "not all steps converged"
    }
    unset multiplot
} else {
    print "no ".data."/filters.csv"
}
set output
