# SPDX-License-Identifier: GPL-3.0-or-later
# How the error fell: over simulations, which counts work, and over seconds, which counts waiting.
# Reads history.tsv: iteration, evaluations, engine_steps, error, noise, …
# and timing.tsv: iteration, seconds.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

# Where a method begins another part of the fit, as `successive` tells by its column finds_omega, its
# error begins anew, and no line leads there.
part = column_of("history.tsv", "finds_omega")
parts = sprintf("awk -v part=%d '/^#/ { next } n++ && part && $part != last { print \"\" } { last = $part; print }' history.tsv", part)
history = "< " . parts

# seconds, evaluations, error, noise of the iterations that both tables have
joined = "< " . parts . " | awk '/^#/ { next } FILENAME == \"timing.tsv\" { seconds[$1] = $2; next } \
    NF == 0 { print; next } $1 in seconds { print seconds[$1], $2, $4, $5 }' timing.tsv -"

stats "history.tsv" using 2 name "N" nooutput
stats "timing.tsv" using 2 name "S" nooutput
stats "history.tsv" using (high(known(4), known(5))) name "E" nooutput
stats "history.tsv" using (low(positive(4), positive(5))) name "L" nooutput
dots = E_records > 50 ? 0 : 0.5

do for [kind in kinds] {
    eval open(kind, "error", 860, 420)
    set multiplot
    set tmargin at screen 0.87
    set bmargin at screen 0.165
    eval log_range("y", L_min, E_max)
    set format y "%h"
    set key on at screen 0.13, screen 0.995 left top vertical Left reverse noautotitle

    set lmargin at screen 0.135
    set rmargin at screen 0.55
    set xrange [0:end_of(N_max)]
    set xtics step_of(N_max / 3)
    set xlabel "simulations"
    eval name_axis(error_label, 0.018)
    plot history using 2:5 with lines title "what noise alone would make of it" \
            linewidth 1.4 dashtype 2 linecolor rgb faint, \
        "" using 2:4 with linespoints title "error: distance from the targets" \
            linewidth 2.2 pointtype 7 pointsize dots linecolor rgb blue

    set lmargin at screen 0.585
    set rmargin at screen 0.975
    set xrange [0:end_of(S_max)]
    set xtics step_of(S_max / 3)
    set format y ""
    set xlabel "time / s"
    unset label 1
    set key off
    plot joined using 1:4 with lines linewidth 1.4 dashtype 2 linecolor rgb faint, \
        "" using 1:3 with linespoints \
            linewidth 2.2 pointtype 7 pointsize dots linecolor rgb blue
    unset multiplot
    eval close
}
