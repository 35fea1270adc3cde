# SPDX-License-Identifier: GPL-3.0-or-later
# What work_precision.sh has measured: work_precision.png from work_precision.tsv.
set terminal pngcairo size 1200, 760 font "Liberation Sans,13" fontscale 2 linewidth 2 pointscale 2 background "#ffffff"
set output "work_precision.png"
set datafile separator tab
set border 3
set tics nomirror out scale 0.6
set logscale xy
set xrange [1.5:40]
set yrange [0.15:5]
set xtics (2, 5, 10, 20)
set ytics (0.2, 0.5, 1, 2, 5)
set grid ytics linetype 1 linewidth 0.5 linecolor rgb "#e4e4e4"
set xlabel "processor time / s"
set ylabel "error of viscosity / %"
set key at screen 0.98, screen 0.97 right top reverse Left samplen 2
file = "work_precision.tsv"
colours = "#0072b2 #d55e00 #009e73"
shapes = "7 5 9"
array title = ["flow between plates, in the plane", "a wave, in space", "a stronger wave in a smaller box"]
plot for [k = 1:3] file index (k - 1) using 2:(100 * $4 / $3) with linespoints pointtype int(word(shapes, k)) pointsize 0.8 \
        linecolor rgb word(colours, k) title title[k], \
    for [k = 1:3] file index (k - 1) using 2:(100 * abs($3 / $5 - 1)) with points pointtype int(word(shapes, k)) - 1 pointsize 1 \
        linecolor rgb word(colours, k) notitle, \
    NaN with points pointtype 6 pointsize 1 linecolor rgb "#222222" title "open: distance from kinetic theory", \
    1.4 / sqrt(x) with lines linecolor rgb "#8a8a8a" dashtype 2 title "1/{/Symbol \326}time"
