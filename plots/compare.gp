# SPDX-License-Identifier: GPL-3.0-or-later
# Several fits of one target: their radial distribution functions, potentials, and what the error
# cost each. A fit keeps its colour in every panel.
# Reads compare.tsv (numbers and names of the fits, in its comment lines) and, one block a fit,
# rdf_compare.tsv: r, target, target_error, result, result_error;
# potential_compare.tsv: r, phi; error_compare.tsv: iteration, evaluations, seconds, error, noise.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

stats "compare.tsv" using 1 name "C" nooutput
count = int(C_records)
name_of(i) = system(sprintf("awk -F '\t' '$1 == \"# %d\" { print $2; exit }' compare.tsv", i))
array name[count]
do for [i = 1:count] { name[i] = name_of(i - 1) }

stats "rdf_compare.tsv" using 1 name "R" nooutput
stats "rdf_compare.tsv" using (high($2, $4)) name "G" nooutput
stats "potential_compare.tsv" using 2 name "P" nooutput
stats "error_compare.tsv" using 2 name "N" nooutput
stats "error_compare.tsv" using (positive(2)) name "M" nooutput
stats "error_compare.tsv" using (known(3)) name "S" nooutput
stats "error_compare.tsv" using (positive(3)) name "T" nooutput
stats "error_compare.tsv" using (high(known(4), known(5))) name "E" nooutput
stats "error_compare.tsv" using (low(positive(4), positive(5))) name "L" nooutput
bottom = low(0, P_min)
top = potential_top(bottom, P_max)
# Beyond the cores; the same range for g, so that peaks stand above wells.
stats "potential_compare.tsv" using ($2 < top ? $1 : NaN) name "B" nooutput
begin = is_soft(P_max) ? 0 : floor(10 * (B_min - 0.06)) / 10.0

# Heights in points, from the top: legend in two columns, then three rows of panels.
rows = (count + 3) / 2
legend = 16 + 21 * rows
height = legend + 890
edge(y) = 1 - (legend + y) / real(height)
dashes(i) = i < 4 ? 1 : 4
line_of(i) = sprintf("linewidth 2 dashtype %d linecolor rgb '%s'", dashes(i), colour_of(i))
do for [i = 1:count] { eval sprintf("set style line %d %s", i, line_of(i - 1)) }

do for [kind in kinds] {
    eval open(kind, "compare", 860, height)
    set multiplot
    set lmargin at screen 0.105
    set rmargin at screen 0.975
    set xrange [begin:R_max]
    set xtics autofreq
    set ytics autofreq
    set format "%h"
    unset logscale

    set tmargin at screen edge(10)
    set bmargin at screen edge(280)
    set yrange [0:1.08 * G_max]
    set format x ""
    eval name_axis(g_label, 0.02)
    set key on at screen 0.105, screen 1 - 8.0 / height left top vertical maxrows rows Left reverse
    plot NaN with points title "target" pointtype 7 pointsize 0.5 linecolor rgb ink, \
        NaN title "statistical noise" linewidth 1.2 dashtype 3 linecolor rgb ink, \
        for [i = 1:count] "rdf_compare.tsv" index (i - 1) using 1:4 with lines \
            title name[i] linestyle i, \
        "" index 0 using 1:2 with points pointtype 7 pointsize 0.32 linecolor rgb ink

    set tmargin at screen edge(305)
    set bmargin at screen edge(530)
    set yrange [bottom - 0.1 * (top - bottom):top]
    set format x "%h"
    set xlabel r_label
    eval name_axis(phi_label, 0.02)
    set key off
    plot 0 linewidth 0.8 linecolor rgb ink, for [i = 1:count] "potential_compare.tsv" \
        index (i - 1) using 1:2 with lines linestyle i

    set tmargin at screen edge(615)
    set bmargin at screen edge(810)
    set rmargin at screen 0.53
    eval log_range("y", L_min, E_max)
    eval log_range("x", M_min, N_max)
    set xlabel "simulations"
    eval name_axis("rmse of {/:Italic g}", 0.02)
    plot for [i = 1:count] "error_compare.tsv" index (i - 1) using 2:5 with lines \
            linewidth 1.2 dashtype 3 linecolor rgb colour_of(i - 1), \
        for [i = 1:count] "" index (i - 1) using 2:4 with lines linestyle i

    set lmargin at screen 0.57
    set rmargin at screen 0.975
    eval log_range("x", T_min, S_max)
    set format y ""
    set xlabel "time / s"
    unset label 1
    plot for [i = 1:count] "error_compare.tsv" index (i - 1) using 3:5 with lines \
            linewidth 1.2 dashtype 3 linecolor rgb colour_of(i - 1), \
        for [i = 1:count] "" index (i - 1) using 3:4 with lines linestyle i
    unset xlabel
    unset multiplot
    eval close
}
