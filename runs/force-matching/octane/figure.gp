# SPDX-License-Identifier: GPL-3.0-or-later
# What run.sh has found: octane.png, potentials of pairs above, of bonds and angles in the middle, and what
# g(r) is off below.
set terminal pngcairo size 1800, 1500 font "Liberation Sans,13" fontscale 1.8 linewidth 2 background "#ffffff"
set output "octane.png"
set border 3
set tics nomirror out scale 0.6
methods = "force-matching auto relative-entropy"
titles = "forces auto 'relative entropy'"
colour(n) = word("#0072b2 #d55e00 #009e73", n)
table(n, name) = sprintf("out/%s/%s.tsv", word(methods, n), name)
set multiplot layout 3, 3
set lmargin 9
set rmargin 3
set key off
set xrange [0.3:1.2]
set yrange [-2.5:3.5]
set xtics 0.3
do for [p in "A-A A-B B-B"] {
    set title p." pairs"
    set ylabel p eq "A-A" ? "{/Symbol F} [kJ/mol]" : ""
    if (p eq "A-A") { set key top right reverse Left samplen 1.5 } else { set key off }
    plot for [n = 1:3] table(n, "potential_".p) using 1:($2 - $4):($2 + $4) with filledcurves linecolor rgb colour(n) fillstyle transparent solid 0.25 notitle, \
        for [n = 1:3] table(n, "potential_".p) using 1:2 with lines linecolor rgb colour(n) title word(titles, n)
}
unset title
set xlabel "{/:Italic r} [nm]"
set ylabel "{/:Italic g} - target"
set yrange [-0.15:0.15]
do for [p in "A-A A-B B-B"] {
    plot for [n = 1:3] table(n, "rdf_".p) using 1:($4 - $2) with lines linecolor rgb colour(n)
    set ylabel ""
}
names = "'bonds A-B' 'bonds B-B' 'angles A-B-B'"
set xlabel "length [nm]"
set ylabel "{/:Italic U} [kJ/mol]"
set xrange [0.18:0.28]
set xtics 0.18, 0.05
set yrange [0:12]
do for [k = 1:3] {
    set title word(names, k)
    if (k == 3) { set xlabel "angle [degrees]"; set xrange [100:180]; set xtics 100, 20 }
    u = word("bonds_AB bonds_BB angles_ABB", k)
    plot for [n = 1:3] table(n, u) using 1:($2 - $3):($2 + $3) with filledcurves linecolor rgb colour(n) fillstyle transparent solid 0.25, \
        for [n = 1:3] table(n, u) using 1:2 with lines linecolor rgb colour(n)
    set ylabel ""
}
unset multiplot
