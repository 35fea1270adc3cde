# SPDX-License-Identifier: GPL-3.0-or-later
# What run.sh has measured: richardson.png from out/richardson.tsv.
set terminal pngcairo size 1200, 840 font "Liberation Sans,13" fontscale 2 linewidth 2 pointscale 2 background "#ffffff"
set output "richardson.png"
set datafile separator tab
set border 3
set tics nomirror out scale 0.6
set xrange [0.2:1]
set yrange [-1:15]
set xlabel "{/:Italic r} / {/:Italic λ}"
set ylabel "{/:Italic κ}({/:Italic r}) / ({/:Italic k}_B{/:Italic T}_0 {/:Italic μ}/{/:Italic τ})"
set key right top Left reverse
plot "out/richardson.tsv" using 1:2 with lines dashtype 2 linecolor rgb "#222222" title "2{/:Italic k}_B{/:Italic T ω}^2", \
    "" using 1:7:8 with yerrorbars pointtype 7 pointsize 0.5 linecolor rgb "#e69f00" title "{/:Italic Δt} = 0.05", \
    "" using 1:5:6 with yerrorbars pointtype 7 pointsize 0.5 linecolor rgb "#56b4e9" title "{/:Italic Δt} = 0.025", \
    "" using 1:3:4 with yerrorbars pointtype 7 pointsize 0.5 linecolor rgb "#0072b2" title "{/:Italic Δt} = 0.0125", \
    "" using 1:9:10 with yerrorbars pointtype 5 pointsize 0.7 linecolor rgb "#d55e00" title "extrapolated to 0"
