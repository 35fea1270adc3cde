# SPDX-License-Identifier: GPL-3.0-or-later
# What starts.sh has measured: starts.png from starts.tsv.
set terminal pngcairo size 1200, 760 font "Liberation Sans,13" fontscale 2 linewidth 2 pointscale 2 background "#ffffff"
set output "starts.png"
set encoding utf8
set datafile separator tab
set border 3
set tics nomirror out scale 0.6
set logscale y
set xrange [0:16]
set yrange [0.004:1]
set ytics (0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1)
set grid ytics linetype 1 linewidth 0.5 linecolor rgb "#e4e4e4"
set xlabel "collisions of a disc so far"
set ylabel "distance from Maxwell's speeds"
set key at graph 1, graph 1.02 right top Right samplen 2
stats "starts.tsv" using 3 name "N" nooutput
set object 1 rectangle from graph 0, graph 0 to graph 1, first N_mean fillcolor rgb "#ececec" fillstyle solid noborder behind
set label 1 "chance, 19 times in 20" at graph 0.98, first 0.0046 right textcolor rgb "#777777"
colours = "#0072b2 #d55e00 #009e73"
array title[3] = ["one speed", "uniform components of velocity", "normal, heavy discs as fast as light ones"]
plot for [k = 1:3] "starts.tsv" index (k - 1) using 1:2 with linespoints pointtype 7 pointsize 0.5 linecolor rgb word(colours, k) title title[k]
