# SPDX-License-Identifier: GPL-3.0-or-later
# Mean-square displacement of the result on that of the target, and their difference.
# Reads msd.tsv: time, target, target_error, result, result_error, and perhaps the same in ps and nm.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

ps = factor_of("msd.tsv", "time[ps]", 1)
nm2 = factor_of("msd.tsv", "target[nm^2]", 2)
unit = in_units("msd.tsv", "target[nm^2]", " / nm^2", " / {/:Italic λ}^2")
combined(a, b) = nm2 * sqrt(known(a)**2 + known(b)**2)

stats "msd.tsv" using (ps * $1) name "T" nooutput
stats "msd.tsv" using (nm2 * high($2, $4)) name "M" nooutput
stats "msd.tsv" using (high(nm2 * abs($4 - $2), 1.96 * combined(3, 5))) name "D" nooutput
limit = D_max > 0 ? 1.15 * D_max : 1

do for [kind in kinds] {
    eval open(kind, "msd", 720, 560)
    set multiplot
    set lmargin at screen 0.155
    set rmargin at screen 0.97
    set xrange [0:above(0, T_max)]

    set tmargin at screen 0.925
    set bmargin at screen 0.40
    set yrange [0:end_of(M_max)]
    set ytics autofreq
    set format x ""
    eval name_axis("MSD" . unit, 0.024)
    set key at screen 0.97, screen 0.985 right top vertical maxrows 1
    plot "msd.tsv" using (ps * $1):(nm2 * band_low(4, 5)):(nm2 * band_high(4, 5)) \
            with filledcurves @band linecolor rgb blue, \
        "" using (ps * $1):(nm2 * $4) with lines title "result" linewidth 2.6 linecolor rgb blue, \
        "" using (ps * $1):(nm2 * $2) with points title "target" \
            pointtype 7 pointsize 0.38 linecolor rgb ink

    set tmargin at screen 0.34
    set bmargin at screen 0.125
    set yrange [-limit:limit]
    set ytics step_of(limit / 1.5)
    set format x "%h"
    set xlabel t_axis_of("msd.tsv")
    eval name_axis("result − target", 0.024)
    set key at graph 0.99, graph 1.18 right top vertical maxrows 1
    plot "msd.tsv" using (ps * $1):(-1.96 * combined(3, 5)):(1.96 * combined(3, 5)) \
            with filledcurves @band title "95 % band" linecolor rgb faint, \
        0 linewidth 0.8 linecolor rgb ink, \
        "" using (ps * $1):(nm2 * ($4 - $2)) with lines linewidth 1.3 linecolor rgb blue
    unset xlabel
    unset multiplot
    eval close
}
