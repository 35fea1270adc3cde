# SPDX-License-Identifier: GPL-3.0-or-later
# How dense it is around a place: two peaks are two phases.
# Reads local_density.tsv: number, density, share, and perhaps the packing fraction.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

table = "local_density.tsv"
packing = column_of(table, "packing")
x = packing > 0 ? packing : 2
stats table using x name "X" nooutput
stats table using 3 name "Y" nooutput

do for [kind in kinds] {
    eval open(kind, "local_density", 720, 440)
    set xrange [0:end_of(X_max)]
    set yrange [0:end_of(Y_max)]
    set xlabel packing > 0 ? "packing fraction of a cell" : axis_of("local_density.tsv", "density", "density of a cell", sprintf("density of a cell / {/:Italic λ}^{-%d}", dimensions))
    set ylabel "share of cells"
    plot table using x:3 with filledcurves y1=0 @band linecolor rgb blue, \
        "" using x:3 with lines linewidth 2.2 linecolor rgb blue
    eval close
}
