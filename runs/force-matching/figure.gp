# SPDX-License-Identifier: GPL-3.0-or-later
# What run.sh has found: force-matching.png from the tables of its three fits.
set terminal pngcairo size 1300, 1500 font "Liberation Sans,13" fontscale 2 linewidth 2 background "#ffffff"
set output "force-matching.png"
set border 3
set tics nomirror out scale 0.6
set xrange [0.8:2.5]
methods = "force-matching imc relative-entropy"
colour(n) = word("#0072b2 #d55e00 #009e73", n)
table(n, name) = sprintf("out/%s/%s.tsv", word(methods, n), name)
lj(r) = 4 * (r**-12 - r**-6) - 4 * (2.5**-12 - 2.5**-6)
set multiplot layout 3, 1
set key right top Left reverse
set ylabel "{/Symbol F} [kJ/mol]"
set yrange [-1.2:1]
plot for [n = 1:3] table(n, "potential") using 1:($2 - $4):($2 + $4) with filledcurves linecolor rgb colour(n) fillstyle transparent solid 0.25 notitle, \
    for [n = 1:3] table(n, "potential") using 1:2 with lines linecolor rgb colour(n) title word(methods, n), \
    lj(x) with lines dashtype 2 linecolor rgb "#000000" title "truth"
set ylabel "{/Symbol F} - truth [kJ/mol]"
set yrange [-0.15:0.15]
plot for [n = 1:3] table(n, "potential") using 1:($2 - lj($1) - $4):($2 - lj($1) + $4) with filledcurves linecolor rgb colour(n) fillstyle transparent solid 0.25 notitle, \
    for [n = 1:3] table(n, "potential") using 1:($2 - lj($1)) with lines linecolor rgb colour(n) notitle
set ylabel "{/:Italic g} - target"
set xlabel "{/:Italic r} [nm]"
set yrange [-0.06:0.06]
plot for [n = 1:3] table(n, "rdf") using 1:($4 - $2) with lines linecolor rgb colour(n) notitle
unset multiplot
