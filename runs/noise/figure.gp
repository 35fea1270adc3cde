# SPDX-License-Identifier: GPL-3.0-or-later
# What run.sh has measured: noise.png from out/noise.tsv.
set terminal pngcairo size 1200, 760 font "Liberation Sans,13" fontscale 2 linewidth 2 pointscale 2 background "#ffffff"
set output "noise.png"
set datafile separator tab
set border 3
set tics nomirror out scale 0.6
set logscale xy
set xrange [7:130]
set xtics (9, 17, 33, 49, 97)
set yrange [0.002:0.1]
set xlabel "samples, 50 steps apart"
set ylabel "standard error, rms over bins"
set key right top Left reverse
stats "out/noise.tsv" using ($3 * sqrt($1)) name "G" nooutput
stats "out/noise.tsv" using ($4 * sqrt($1)) name "E" nooutput
plot "out/noise.tsv" using 1:4 with points pointtype 7 pointsize 0.8 linecolor rgb "#d55e00" title "escape times {/:Italic E}({/:Italic t}, {/:Italic r}_0)", \
    E_mean / sqrt(x) with lines linecolor rgb "#d55e00" notitle, \
    "" using 1:3 with points pointtype 7 pointsize 0.8 linecolor rgb "#0072b2" title "{/:Italic g}({/:Italic r})", \
    G_mean / sqrt(x) with lines linecolor rgb "#0072b2" title "lines: 1/{/Symbol \326}samples"
