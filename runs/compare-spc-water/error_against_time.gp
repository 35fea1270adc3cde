# SPDX-License-Identifier: GPL-3.0-or-later
# How far water's g(r) is off after how much work: error-against-time.png from out/METHOD-1/course.tsv of five methods.
set terminal pngcairo size 1400, 860 font "Liberation Sans,13" fontscale 2 linewidth 2 pointscale 2 background "#ffffff"
set output "error-against-time.png"
set encoding utf8
set datafile separator tab
set border 3 linewidth 0.8 linecolor rgb "#222222"
set tics nomirror out scale 0.6
set grid ytics linetype 1 linewidth 0.5 linecolor rgb "#e4e4e4"
set logscale xy
set rmargin 3
set xrange [2:400]
set xtics (2, 5, 10, 20, 50, 100, 200)
set yrange [0.0014:1]
set ytics (0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1)
set xlabel "processor time / s"
set ylabel "error of {/:Italic g}({/:Italic r}), rms"
set key off

stats "out/imc-1/course.tsv" using 4 name "N" nooutput
set object 1 rectangle from graph 0, graph 0 to graph 1, first N_mean fillcolor rgb "#ececec" fillstyle solid noborder behind
set label 1 "noise: differences cannot be told here" at graph 0.98, first 0.00165 right textcolor rgb "#777777"
set arrow 1 from graph 0, first 0.113 to graph 1, first 0.113 nohead dashtype 3 linewidth 1.2 linecolor rgb "#777777"
set label 2 "without any fit: {/:Italic Φ} = −{/:Italic k}_B{/:Italic T} ln {/:Italic g}" at graph 0.98, first 0.135 right textcolor rgb "#777777"

course(method) = sprintf("out/%s-1/course.tsv", method)
points = "with linespoints linewidth 2.4 pointtype 7 pointsize 0.75 linecolor rgb"
# The name of a method stands at one of its points.
at_last(method, name, colour, k, x, y) = sprintf("set label %d '%s' at %g, %g center textcolor rgb '%s'", \
    k, name, x * real(system("tail -n 1 ".course(method)." | cut -f 2")), \
    y * real(system("tail -n 1 ".course(method)." | cut -f 3")), colour)
eval at_last("original", "genetic, as in the thesis", "#7a7a7a", 11, 0.55, 0.74)
eval at_last("memetic", "genetic, today", "#d55e00", 12, 1.1, 0.72)
eval at_last("gauss-newton", "Gauss-Newton", "#56b4e9", 13, 0.9, 1.5)
eval at_last("imc", "inverse Monte Carlo", "#0072b2", 14, 0.38, 1.22)
eval at_last("ibi", "iterative Boltzmann inversion", "#009e73", 15, 2.85, 1.02)

plot course("original") using 2:3 @points "#7a7a7a", \
    course("memetic") using 2:3 @points "#d55e00", \
    course("gauss-newton") using 2:3 @points "#56b4e9", \
    course("ibi") using 2:3 @points "#009e73", \
    course("imc") using 2:3 @points "#0072b2"
