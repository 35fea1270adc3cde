# SPDX-License-Identifier: GPL-3.0-or-later
# Density of a slab about its middle, along the longest edge of the box, and the tanh through it.
# Reads slab.tsv: place, density, error, fit.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

table = "slab.tsv"
stats table using 1 name "X" nooutput
stats table using (column(2) + 1.96 * known(3)) name "Y" nooutput
first = first_of(table)

do for [kind in kinds] {
    eval open(kind, "slab", 720, 440)
    set xrange [X_min:X_max]
    set yrange [0:end_of(Y_max)]
    set xlabel axis_of(table, first, "{/:Italic " . first . "}", "{/:Italic " . first . "} / {/:Italic λ}")
    set ylabel axis_of(table, "density", "density", sprintf("density / {/:Italic λ}^{-%d}", dimensions))
    set key right top vertical
    plot table using 1:(band_low(2, 3)):(band_high(2, 3)) notitle \
            with filledcurves @band linecolor rgb blue, \
        "" using 1:2 with points title "measured" pointtype 7 pointsize 0.5 linecolor rgb blue, \
        "" using 1:(valid(4) ? $4 : NaN) with lines title "fit" @true_line
    eval close
}
