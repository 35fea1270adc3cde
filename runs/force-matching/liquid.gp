# SPDX-License-Identifier: GPL-3.0-or-later
# What run.sh of a liquid has found: its figure, from the tables of its four fits. `liquid` is its name; the axes
# go from r = `low` to `range`, from Φ = −`depth`, g goes to `top`, what it is off to `off`.
set terminal pngcairo size 1300, 1500 font "Liberation Sans,13" fontscale 2 linewidth 2 background "#ffffff"
set output liquid.".png"
set border 3
set tics nomirror out scale 0.6
set xrange [low:range]
methods = "force-matching pressure imc relative-entropy"
titles = "'force matching' 'force matching, 1 bar' 'imc' 'relative-entropy'"
colour(n) = word("#0072b2 #56b4e9 #d55e00 #009e73", n)
table(n, name) = sprintf("out/%s/%s.tsv", word(methods, n), name)
set multiplot layout 3, 1
set lmargin 9
set key right top Left reverse
set ylabel "{/Symbol F} [kJ/mol]"
set yrange [-depth:3]
plot for [n = 1:4] table(n, "potential") using 1:($2 - $4):($2 + $4) with filledcurves linecolor rgb colour(n) fillstyle transparent solid 0.25 notitle, \
    for [n = 1:4] table(n, "potential") using 1:2 with lines linecolor rgb colour(n) title word(titles, n)
set ylabel "{/:Italic g}"
set yrange [0:top]
plot table(1, "rdf") using 1:2 with lines linecolor rgb "#000000" title "target", \
    for [n = 1:4] table(n, "rdf") using 1:4 with lines linecolor rgb colour(n) notitle
set ylabel "{/:Italic g} - target"
set xlabel "{/:Italic r} [nm]"
set yrange [-off:off]
plot for [n = 1:4] table(n, "rdf") using 1:($4 - $2) with lines linecolor rgb colour(n) notitle
unset multiplot
