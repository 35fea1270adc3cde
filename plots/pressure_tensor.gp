# SPDX-License-Identifier: GPL-3.0-or-later
# Pressure along each axis in time, and across: means of twenty samples where there are many.
# Reads pressure_tensor.tsv: time or sweeps, xx, yy, perhaps zz, xy, perhaps xz, yz.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

file = "pressure_tensor.tsv"
axes = column_of(file, "zz") > 0 ? 3 : 2
across = axes == 3 ? 3 : 1
stats file using 1 name "T" nooutput
each = T_records > 400 ? floor(T_records / 100) : 1
means = sprintf("< awk -v each=%d -v OFS='\t' '/^#/ { next } { for (n = 1; n <= NF; n++) sum[n] += $n / each; if (++rows == each) { line = sum[1]; for (n = 2; n <= NF; n++) line = line OFS sum[n]; print line; rows = 0; delete sum } }' %s", each, file)
span(begin, count) = sprintf("set ytics %g", step_of(spread(begin, count) / 2.5))
# From the lowest to the highest of so many columns.
spread(begin, count) = real(system(sprintf("%s | awk -v a=%d -v n=%d '{ for (k = a; k < a + n; k++) { low = !rows || $k < low ? $k : low; high = !rows++ || $k > high ? $k : high } } END { print high - low }'", means[3:*], begin, count)))
names = axes == 3 ? "xx yy zz xy xz yz" : "xx yy xy"
panel(k) = sprintf("set tmargin at screen %g; set bmargin at screen %g", 0.93 - 0.42 * k, 0.93 - 0.42 * k - 0.34)

do for [kind in kinds] {
    eval open(kind, "pressure_tensor", 640, 480)
    set multiplot
    set lmargin at screen 0.2
    set rmargin at screen 0.97
    set xrange [T_min < T_max ? T_min : T_min - 1:T_max]
    set format x ""
    unset xlabel
    set key on at graph 1, graph 1.15 right top vertical maxrows 1 noautotitle enhanced
    eval panel(0) . "; " . span(2, axes)
    eval name_axis(per_unit("{/:Italic P}", file, 2), 0.03)
    plot for [k = 1:axes] means using 1:(column(1 + k)) with lines linewidth 1.4 linecolor rgb colour_of(k - 1) title word(names, k)
    eval panel(1) . "; " . span(2 + axes, across)
    set format x "%h"
    set xlabel first_of(file) eq "sweeps" ? "sweeps" : t_axis_of(file)
    eval name_axis(per_unit("across", file, 2), 0.03)
    plot for [k = 1:across] means using 1:(column(1 + axes + k)) with lines linewidth 1.4 linecolor rgb colour_of(k - 1) title word(names, axes + k)
    unset multiplot
    eval close
}
