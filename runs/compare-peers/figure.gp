# SPDX-License-Identifier: GPL-3.0-or-later
# What measure.sh has found: compare.png from course.tsv.
set terminal pngcairo size 1300, 800 font "Liberation Sans,13" fontscale 2 linewidth 2 pointscale 2 background "#ffffff"
set output "compare.png"
set encoding utf8
set datafile separator tab
set border 3 linewidth 0.8 linecolor rgb "#222222"
set tics nomirror out scale 0.6
set grid ytics linetype 1 linewidth 0.5 linecolor rgb "#e4e4e4"
set logscale xy
set xrange [2:500]
set xtics (2, 5, 10, 20, 50, 100, 200, 500)
set yrange [0.0015:0.4]
set ytics (0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.4)
set xlabel "processor time / s"
set ylabel "error of {/:Italic g}({/:Italic r}), rms"
stats "course.tsv" using 4 name "N" nooutput
set object 1 rectangle from graph 0, graph 0 to graph 1, first N_mean fillcolor rgb "#ececec" fillstyle solid noborder behind
set label 1 "noise of this measurement" at graph 0.98, first 0.0017 right textcolor rgb "#777777"
set key right top Left reverse samplen 2
stats "course.tsv" index 4 using 3 name "I" nooutput
stats "course.tsv" index 5 using 3 name "M" nooutput
set arrow 1 from graph 0.62, first I_mean to graph 1, first I_mean nohead dashtype 2 linecolor rgb "#d55e00"
set arrow 2 from graph 0.62, first M_mean to graph 1, first M_mean nohead linecolor rgb "#d55e00"
set label 2 "IBI in VOTCA's test data" at graph 0.985, first 1.16 * I_mean right textcolor rgb "#d55e00"
set label 3 "IMC in VOTCA's test data" at graph 0.985, first 1.16 * M_mean right textcolor rgb "#d55e00"
plot "course.tsv" index 2 using 2:3 with linespoints pt 6 ps 0.8 lw 2 lc rgb "#0072b2" title "mesofit, IBI", \
    "" index 3 using 2:3 with linespoints pt 7 ps 0.8 lw 2 lc rgb "#0072b2" title "mesofit, IMC", \
    "" index 0 using 2:3 with linespoints pt 4 ps 0.8 lw 2 lc rgb "#d55e00" title "VOTCA with LAMMPS, IBI", \
    "" index 1 using 2:3 with linespoints pt 5 ps 0.8 lw 2 lc rgb "#d55e00" title "VOTCA with LAMMPS, IMC"
