# SPDX-License-Identifier: GPL-3.0-or-later
# What should not change: particles in the box, momentum and energy, as changes since the first sample.
# Reads conserved.tsv: step, time, particles, energy, momentum_x, momentum_y, perhaps momentum_z.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

file = "conserved.tsv"
first(n) = real(system(sprintf("awk '!/^#/ { print $%d; exit }' conserved.tsv", n)))
E0 = first(4)
N0 = first(3)
axes = column_of(file, "momentum_z") > 0 ? 3 : 2
stats file using 2 name "T" nooutput
change(n) = column(n) - first_value[n]
array first_value[8]
do for [n = 3:4 + axes] { first_value[n] = first(n) }
stats file using (abs($4 / E0 - 1)) name "E" nooutput
stats file using (abs($3 - N0)) name "N" nooutput
most = 0
do for [n = 5:4 + axes] {
    stats file using (abs(change(n))) name "M" nooutput
    most = high(most, M_max)
}
panel(k) = sprintf("set tmargin at screen %g; set bmargin at screen %g", 0.95 - 0.29 * k, 0.95 - 0.29 * k - 0.23)
both(x) = x > 0 ? sprintf("set yrange [%g:%g]; set ytics %g", -1.2 * x, 1.2 * x, step_of(x)) : "set yrange [-1:1]; set ytics 1"

do for [kind in kinds] {
    eval open(kind, "conserved", 640, 520)
    set multiplot
    set lmargin at screen 0.2
    set rmargin at screen 0.97
    set xrange [T_min < T_max ? T_min : T_min - 1:T_max]
    set format x ""
    set format y "%h"
    unset xlabel
    set key off
    eval panel(0) . "; " . both(N_max)
    set label 2 sprintf("of %.0f", N0) at graph 0.98, graph 0.85 right
    eval name_axis("particles, change", 0.03)
    plot file using 2:($3 - N0) with lines linewidth 1.6 linecolor rgb green
    unset label 2
    eval panel(1) . "; " . both(most)
    eval name_axis("momentum, change", 0.03)
    set key on at graph 1, graph 1.22 right top vertical maxrows 1 noautotitle enhanced
    plot for [k = 1:axes] file using 2:(change(4 + k)) with lines linewidth 1.4 linecolor rgb colour_of(k - 1) title word("x y z", k)
    eval panel(2) . "; " . both(E_max)
    set format x "%h"
    set xlabel t_axis_of(file)
    eval name_axis("energy, relative", 0.03)
    set key off
    plot file using 2:($4 / E0 - 1) with lines linewidth 1.4 linecolor rgb ink
    unset multiplot
    eval close
}
