# SPDX-License-Identifier: GPL-3.0-or-later
# Speeds of hard particles and Maxwell's distribution, and the difference in standard errors.
# Reads speeds.tsv: speed, density, density_error (nan where nothing was counted), maxwell.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

stats "speeds.tsv" using 1 name "U" nooutput
stats "speeds.tsv" using (high($2, $4)) name "P" nooutput
stats "speeds.tsv" using (known(3) > 0 ? ($2 - $4) / $3 : 0) name "D" nooutput
limit = 1.1 * high(4, high(-D_min, D_max))

do for [kind in kinds] {
    eval open(kind, "speeds", 720, 560)
    set multiplot
    set lmargin at screen 0.155
    set rmargin at screen 0.97
    set xrange [0:end_of(U_max)]

    set tmargin at screen 0.925
    set bmargin at screen 0.40
    set yrange [0:end_of(P_max)]
    set ytics autofreq
    set format x ""
    eval name_axis("density", 0.024)
    set key at screen 0.97, screen 0.985 right top vertical maxrows 1
    plot "speeds.tsv" using 1:4 with lines title "Maxwell" linewidth 2.2 linecolor rgb blue, \
        "" using 1:2 with points title "measured" pointtype 7 pointsize 0.5 linecolor rgb ink

    set tmargin at screen 0.34
    set bmargin at screen 0.125
    set yrange [-limit:limit]
    set ytics step_of(limit / 1.5)
    set format x "%h"
    set xlabel "speed / ({/:Italic k}_B{/:Italic T}/{/:Italic m})^{1/2}"
    eval name_axis("difference / error", 0.024)
    set key off
    plot "speeds.tsv" using 1:(-1.96):(1.96) with filledcurves @band linecolor rgb faint, \
        0 linewidth 0.8 linecolor rgb ink, \
        "" using 1:(known(3) > 0 ? ($2 - $4) / $3 : NaN) with points pointtype 7 pointsize 0.5 linecolor rgb ink
    unset xlabel
    unset multiplot
    eval close
}
