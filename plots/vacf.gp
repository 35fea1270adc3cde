# SPDX-License-Identifier: GPL-3.0-or-later
# Velocity autocorrelation of the result on that of the target, and their difference, each divided
# by its own value at time 0, which the temperature sets.
# Reads vacf.tsv: time, target, target_error, result, result_error; the first row is that of time 0.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

stats "vacf.tsv" using 2 every ::0::0 name "A" nooutput
stats "vacf.tsv" using 4 every ::0::0 name "B" nooutput
target = A_max > 0 ? A_max : 1
result = B_max > 0 ? B_max : 1
combined(a, b) = sqrt((known(a) / target)**2 + (known(b) / result)**2)
difference(a, b) = column(b) / result - column(a) / target

ps = factor_of("vacf.tsv", "time[ps]", 1)
stats "vacf.tsv" using (ps * $1) name "T" nooutput
stats "vacf.tsv" using (low($2 / target, $4 / result)) name "L" nooutput
stats "vacf.tsv" using (high(abs(difference(2, 4)), 1.96 * combined(3, 5))) name "D" nooutput
limit = D_max > 0 ? 1.15 * D_max : 1

do for [kind in kinds] {
    eval open(kind, "vacf", 720, 560)
    set multiplot
    set lmargin at screen 0.145
    set rmargin at screen 0.97
    set xrange [0:above(0, T_max)]

    set tmargin at screen 0.925
    set bmargin at screen 0.40
    set yrange [low(-0.05, 1.3 * L_min):1.05]
    set ytics 0.2
    set format x ""
    eval name_axis("VACF({/:Italic t}) / VACF(0)", 0.024)
    set key at screen 0.97, screen 0.985 right top vertical maxrows 1
    plot 0 linewidth 0.8 linecolor rgb ink, \
        "vacf.tsv" using (ps * $1):(band_low(4, 5) / result):(band_high(4, 5) / result) \
            with filledcurves @band linecolor rgb blue, \
        "" using (ps * $1):($4 / result) with lines title "result" linewidth 2.6 linecolor rgb blue, \
        "" using (ps * $1):($2 / target) with points title "target" \
            pointtype 7 pointsize 0.38 linecolor rgb ink

    set tmargin at screen 0.34
    set bmargin at screen 0.125
    set yrange [-limit:limit]
    set ytics step_of(limit / 1.5)
    set format x "%h"
    set xlabel t_axis_of("vacf.tsv")
    eval name_axis("result − target", 0.024)
    set key at graph 0.99, graph 1.18 right top vertical maxrows 1
    plot "vacf.tsv" using (ps * $1):(-1.96 * combined(3, 5)):(1.96 * combined(3, 5)) \
            with filledcurves @band title "95 % band" linecolor rgb faint, \
        0 linewidth 0.8 linecolor rgb ink, \
        "" using (ps * $1):(difference(2, 4)) with lines linewidth 1.3 linecolor rgb blue
    unset xlabel
    unset multiplot
    eval close
}
