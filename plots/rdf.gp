# SPDX-License-Identifier: GPL-3.0-or-later
# Radial distribution function of the result on that of the target, and their difference.
# Reads rdf.tsv: r, target, target_error, result, result_error, and perhaps given[1], r[nm].

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

combined(a, b) = sqrt(known(a)**2 + known(b)**2)

nm = factor_of(table, "r[nm]", 1)
divided = factor_of(table, "given[1]", 2)
target = abs(divided - 1) < 5e-5 ? "target" : sprintf("target / %.4f", divided)
stats table using ($1 * nm) name "R" nooutput
stats table using (high($2, $4)) name "G" nooutput
stats table using (high(abs($4 - $2), combined(3, 5))) name "D" nooutput
limit = D_max > 0 ? 1.15 * D_max : 1

do for [kind in kinds] {
    eval open(kind, figure, 720, 560)
    set multiplot
    set lmargin at screen 0.17
    set rmargin at screen 0.97
    set xrange [0:above(0, R_max)]

    set tmargin at screen 0.925
    set bmargin at screen 0.40
    eval part_title(0.96)
    set yrange [0:G_max > 0 ? 1.08 * G_max : 1]
    set ytics autofreq
    set format x ""
    eval name_axis(g_label, 0.024)
    set key at screen 0.97, screen 0.985 right top vertical maxrows 1
    plot table using ($1 * nm):($4 - $5):($4 + $5) with filledcurves @band linecolor rgb blue, \
        table using ($1 * nm):4 with lines title "result" linewidth 2.6 linecolor rgb blue, \
        table using ($1 * nm):2 with points title target pointtype 7 pointsize 0.38 linecolor rgb ink

    unset label 3
    set tmargin at screen 0.34
    set bmargin at screen 0.125
    set yrange [-limit:limit]
    set ytics step_of(limit / 1.5)
    set format x "%h"
    set xlabel r_axis_of(table)
    eval name_axis("{/:Italic g} − {/:Italic g}_{target}", 0.024)
    set key at graph 0.99, graph 1.18 right top vertical maxrows 1
    plot table using ($1 * nm):(-combined(3, 5)):(combined(3, 5)) with filledcurves @band \
            title "± 1 standard error" linecolor rgb faint, \
        0 linewidth 0.8 linecolor rgb ink, \
        table using ($1 * nm):($4 - $2) with lines linewidth 1.3 linecolor rgb blue
    unset xlabel
    unset multiplot
    eval close
}
