# SPDX-License-Identifier: GPL-3.0-or-later
# The population of a genetic algorithm: its errors and its diversity, generation by generation.
# Reads history.tsv: iteration, evaluations, engine_steps, error, noise, least, mean, diversity,
# failures.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

stats "history.tsv" using 1 name "I" nooutput
stats "history.tsv" using (high(known(4), high(known(6), known(7)))) name "E" nooutput
stats "history.tsv" using (low(positive(4), low(positive(5), positive(6)))) name "L" nooutput
stats "history.tsv" using (known(8)) name "V" nooutput
dots = I_records > 50 ? 0 : 0.5

do for [kind in kinds] {
    eval open(kind, "generations", 720, 560)
    set multiplot
    set lmargin at screen 0.155
    set rmargin at screen 0.97
    set xrange [I_min:high(I_max, I_min + 1)]

    set tmargin at screen 0.92
    set bmargin at screen 0.40
    set xtics high(1, step_of((I_max - I_min) / 4))
    set format x ""
    set format y "%h"
    eval log_range("y", L_min, E_max)
    eval name_axis(error_label, 0.024)
    set key on at screen 0.97, screen 0.985 right top vertical maxrows 1 noautotitle
    plot "history.tsv" using 1:5 with lines title "noise" \
            linewidth 1.4 dashtype 2 linecolor rgb faint, \
        "" using 1:7 with linespoints title "mean" \
            linewidth 1.6 pointtype 7 pointsize dots linecolor rgb orange, \
        "" using 1:6 with linespoints title "least" \
            linewidth 1.6 pointtype 7 pointsize dots linecolor rgb sky, \
        "" using 1:4 with linespoints title "elite" \
            linewidth 2.6 pointtype 7 pointsize dots linecolor rgb blue

    set tmargin at screen 0.35
    set bmargin at screen 0.125
    unset logscale y
    set yrange [0:V_max > 0 ? 1.1 * V_max : 1]
    set ytics step_of(V_max / 2)
    set format x "%h"
    set xlabel "generation"
    eval name_axis("diversity", 0.024)
    set key off
    plot "history.tsv" using 1:8 with linespoints \
            linewidth 2 pointtype 7 pointsize dots linecolor rgb green
    unset xlabel
    unset multiplot
    eval close
}
