# SPDX-License-Identifier: GPL-3.0-or-later
# What measure.sh has found: compare.png from water.tsv, hexane.tsv and mixture.tsv.
set terminal pngcairo size 2100, 800 font "Liberation Sans,13" fontscale 1.9 linewidth 2 pointscale 2 background "#ffffff"
set output "compare.png"
set encoding utf8
set datafile separator tab
set border 3 linewidth 0.8 linecolor rgb "#222222"
set tics nomirror out scale 0.6
set grid ytics linetype 1 linewidth 0.5 linecolor rgb "#e4e4e4"
set logscale xy
set yrange [0.0015:1]
set ytics (0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1)
set xlabel "processor time / s" offset 0, 0.3
set key right top Left reverse samplen 1.5
ours = "#0072b2"
theirs = "#d55e00"
# The noise of a panel's measurement as a grey floor.
noise_floor(file) = sprintf("stats '%s' using 4 name 'N' nooutput; \
    set object 1 rectangle from graph 0, graph 0 to graph 1, first N_mean fillcolor rgb '#ececec' fillstyle solid noborder behind", file)
set multiplot layout 1, 3 margins 0.085, 0.98, 0.15, 0.91 spacing 0.035
set style line 1 linecolor rgb ours pointtype 6 pointsize 0.8 linewidth 2
set style line 2 linecolor rgb ours pointtype 7 pointsize 0.8 linewidth 2
set style line 3 linecolor rgb theirs pointtype 4 pointsize 0.8 linewidth 2
set style line 4 linecolor rgb theirs pointtype 5 pointsize 0.8 linewidth 2

set title "SPC/E water" offset 0, -0.4
set ylabel "error of {/:Italic g}({/:Italic r}), rms" offset 1, 0
set xrange [2:500]
set xtics (2, 5, 10, 20, 50, 100, 200, 500)
eval noise_floor("water.tsv")
stats "water.tsv" index 4 using 3 name "I" nooutput
stats "water.tsv" index 5 using 3 name "M" nooutput
set arrow 1 from graph 0.36, first I_mean to graph 1, first I_mean nohead dashtype 2 linecolor rgb theirs
set arrow 2 from graph 0.36, first M_mean to graph 1, first M_mean nohead linecolor rgb theirs
set label 1 "noise of the measurement" at graph 0.98, first 0.0017 right textcolor rgb "#777777"
set label 2 "VOTCA's own, IBI" at graph 0.985, first 1.16 * I_mean right textcolor rgb theirs
set label 3 "VOTCA's own, IMC" at graph 0.985, first 1.16 * M_mean right textcolor rgb theirs
plot "water.tsv" index 2 using 2:3 with linespoints linestyle 1 title "mesofit, IBI", \
    "" index 3 using 2:3 with linespoints linestyle 2 title "mesofit, IMC", \
    "" index 0 using 2:3 with linespoints linestyle 3 title "VOTCA with LAMMPS, IBI", \
    "" index 1 using 2:3 with linespoints linestyle 4 title "VOTCA with LAMMPS, IMC"

unset arrow
unset label
unset ylabel
set format y ""
set xrange [5:1000]
set xtics (5, 10, 20, 50, 100, 200, 500, 1000)
set title "hexane: three pair types, bond, angle"
eval noise_floor("hexane.tsv")
plot "hexane.tsv" index 1 using 2:3 with linespoints linestyle 2 title "mesofit, its defaults", \
    "" index 0 using 2:3 with linespoints linestyle 3 title "VOTCA with LAMMPS, IBI"

set xrange [5:500]
set title "mixture of two Lennard-Jones liquids"
eval noise_floor("mixture.tsv")
plot "mixture.tsv" index 2 using 2:3 with linespoints linestyle 2 title "mesofit, its defaults", \
    "" index 0 using 2:3 with linespoints linestyle 3 title "VOTCA with LAMMPS, IBI", \
    "" index 1 using 2:3 with linespoints linestyle 4 title "VOTCA with LAMMPS, IMC"
unset multiplot
