# SPDX-License-Identifier: GPL-3.0-or-later
# What run.sh has measured: threads.png from threads.tsv.
set terminal pngcairo size 1000, 700 font "Liberation Sans,13" fontscale 2 linewidth 2 pointscale 2 background "#ffffff"
set output "threads.png"
set datafile separator tab
set border 3
set tics nomirror out scale 0.6
stats "threads.tsv" using 2 name "T" nooutput
set xrange [0.9:T_max + 0.1]
set yrange [0.9:T_max + 0.1]
set xtics 1
set ytics 0.5
set xlabel "threads"
set ylabel "times as fast as one thread"
set key left top Left reverse samplen 2
plot x with lines lc rgb "#8a8a8a" dashtype 2 title "a core a thread", \
    "threads.tsv" index 1 using 2:5 with linespoints pt 7 ps 0.9 lc rgb "#d55e00" title "candidates of a fit", \
    "" index 0 using 2:5 with linespoints pt 5 ps 0.9 lc rgb "#0072b2" title "one simulation"
