# SPDX-License-Identifier: GPL-3.0-or-later
# What run.sh has measured: error-against-time.png from error-against-time.tsv.
set terminal pngcairo size 1500, 660 font "Liberation Sans,12" fontscale 2 linewidth 2 pointscale 2 background "#ffffff"
set output "error-against-time.png"
set encoding utf8
set datafile separator tab
set border 3
set tics nomirror out scale 0.6
set logscale xy
set grid ytics linetype 1 linewidth 0.5 linecolor rgb "#e4e4e4"
set key at graph 1, graph 1 right top reverse Left samplen 1.2 font ",10"
set bmargin at screen 0.2
set tmargin at screen 0.86
file = "error-against-time.tsv"
colours = "#0072b2 #d55e00 #009e73"
shapes = "7 5 9"
array name[6] = ["between plates", "a wave", "a stronger wave", "discs, packing 0.3", "spheres, packing 0.45", "no forces"]
colour(k) = word(colours, k)
shape(k) = int(word(shapes, k))
# A panel of the blocks from one to another; filled with lines: the standard error, open: the distance from theory.
panel(from, to) = sprintf("plot for [k = %d:%d] file index (k - 1) using 2:(100 * $4 / $3) with linespoints \
    pointtype shape(k - %d + 1) pointsize 0.7 linecolor rgb colour(k - %d + 1) title name[k], \
    for [k = %d:%d] file index (k - 1) using 2:(100 * abs($3 / $5 - 1)) with points \
    pointtype shape(k - %d + 1) - 1 pointsize 0.9 linecolor rgb colour(k - %d + 1) notitle", from, to, from, from, from, to, from, from)
set multiplot
set label 9 "lines: standard error; open: distance from theory; processor time / s" at screen 0.5, 0.04 centre
set ylabel "error / %" offset 1

set lmargin at screen 0.085
set rmargin at screen 0.335
set title "viscosity of a solvent"
set xrange [1:40]
set yrange [0.1:10]
set ytics (0.1, 0.2, 0.5, 1, 2, 5, 10)
set xtics (1, 2, 5, 10, 20)
eval panel(1, 3)
unset label 9
set lmargin at screen 0.42
set rmargin at screen 0.665
unset ylabel
set title "pressure of a hard gas"
set xrange [1:50]
set yrange [0.005:0.5]
set ytics (0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5)
set xtics (0.5, 1, 2, 5, 10, 20)
eval panel(4, 5)
set lmargin at screen 0.75
set rmargin at screen 0.985
set title "D of active discs"
set xrange [0.3:2]
set yrange [0.1:10]
set ytics (0.1, 0.2, 0.5, 1, 2, 5, 10)
set xtics (0.5, 1, 2)
eval panel(6, 6)
unset multiplot
