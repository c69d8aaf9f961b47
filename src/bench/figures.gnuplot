# Error against run time: gnuplot -c figures.gnuplot DATA PICTURES reads
# DATA/work.csv and writes PICTURES/work_precision.svg; of a quick run, DATA/.
# Columns: 1 case, 2 segments, 3 integrator, 4 solver, 8 run time, 9 error,
# 10 failed.
work = ARG1."/work.csv"
machine = system("sed -n '1s/^# //p' ".work." | sed 's/; flags[^;]*//'")
quick = machine[strlen(machine) - 8:] eq "quick run"
set datafile separator ","
set terminal svg size 1300,760 font "sans,13" background "white"
set output (quick ? ARG1 : ARG2)."/work_precision.svg"
set tics nomirror
set border 3
set grid lc rgb "#dddddd" lw 0.5
set logscale xy
set format xy "10^{%L}"
set yrange [1e-9:1]
set xlabel "processor time, s"
set ylabel "position error at the end, m"
unset key

methods = "forward-euler symplectic-euler verlet backward-euler bdf2 " \
    ."midpoint sdirk2"
array colour[7] = ["#999999", "#e69f00", "#d55e00", "#000000", "#56b4e9", \
    "#0072b2", "#009e73"]
method(i) = word(methods, i)
shape(i) = i <= 3 ? 7 : 4
is_row(kind, size, i) = strcol(1) eq kind && $2 == size && \
    strcol(3) eq method(i) && strcol(4) eq (i <= 3 ? "none" : "multigrid")

set multiplot layout 2,3 title machine font ",9"
do for [panel in quick ? "soft:4 stiff:4 spinning:4" \
        : "soft:16 soft:64 soft:128 stiff:16 spinning:16"] {
    kind = panel[:strstrt(panel, ":") - 1]
    size = panel[strstrt(panel, ":") + 1:]
    set title sprintf("%s, %s x %s cells", kind eq "soft" \
        ? "soft (k = 10^5 J/m^2), 0.1 s" : kind eq "stiff" \
        ? "stiff (k = 10^9 J/m^2), 0.02 s" \
        : "stiff and turning slowly, 0.1 s", size, size)
    plot for [i=1:7] work using \
            (is_row(kind, size, i) && $10 == 0 ? $8 : 1/0):9 \
            with linespoints lw 1.5 ps 0.5 pt shape(i) lc rgb colour[i], \
        for [i=1:7] work using \
            (is_row(kind, size, i) && $10 == 1 ? $8 : 1/0):(0.6) \
            with points pt 2 ps 0.6 lc rgb colour[i]
}
# An empty panel for the legend.
unset logscale
unset tics
unset border
unset xlabel
unset ylabel
unset title
unset grid
set xrange [0:1]
set yrange [0:1]
set key center center left reverse Left samplen 2 spacing 1.25
plot for [i=1:7] NaN with linespoints lw 1.5 ps 0.7 pt shape(i) \
        lc rgb colour[i] title method(i).(i <= 3 ? ", explicit" \
        : ", implicit"), \
    NaN with points pt 2 lc rgb "#555555" \
        title "failed: not finite, not converged, or gone"
unset multiplot
set output
