# SPDX-License-Identifier: GPL-3.0-or-later
# potentials.png from out: the three potentials with their 95 % bands, and with Coulomb's in a permittivity of 78.
set terminal pngcairo size 1400, 640 font "Liberation Sans,13" fontscale 2 linewidth 2 background "#ffffff"
set output "potentials.png"
set encoding utf8
set datafile separator tab
set border 3 linewidth 0.8 linecolor rgb "#222222"
set tics nomirror out scale 0.6
set grid ytics linetype 1 linewidth 0.5 linecolor rgb "#e4e4e4"
set xrange [0.2:1.2]
set yrange [-6:8]
set xlabel "{/:Italic r} / nm"
pairs = "Na-Na Na-Cl Cl-Cl"
colours = "#0072b2 #d55e00 #009e73"
file(k) = sprintf("out/potential_%s.tsv", word(pairs, k))
coulomb(k, r) = (k == 2 ? -1.7812 : 1.7812) / r
set multiplot layout 1, 2 margins 0.09, 0.975, 0.2, 0.88 spacing 0.1
set title "short-ranged"
set ylabel "{/:Italic Φ} / (kJ/mol)"
set key top right samplen 1.6 noautotitle
plot for [k = 1:3] file(k) using 1:($2 - 1.96 * $4):($2 + 1.96 * $4) with filledcurves \
        fillcolor rgb word(colours, k) fillstyle transparent solid 0.2 noborder, \
    for [k = 1:3] file(k) using 1:2 with lines linewidth 2 linecolor rgb word(colours, k) title word(pairs, k)
set title "with Coulomb's (dashed)"
unset key
set ylabel "{/:Italic Φ} + {/:Italic U}_{Coulomb} / (kJ/mol)"
plot for [k = 1:3] file(k) using 1:($2 + coulomb(k, $1)) with lines linewidth 2 linecolor rgb word(colours, k), \
    for [k = 2:3] coulomb(k, x) with lines dashtype 2 linewidth 1.2 linecolor rgb (k == 2 ? "#d55e00" : "#777777")
unset multiplot
