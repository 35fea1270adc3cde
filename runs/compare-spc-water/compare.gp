# SPDX-License-Identifier: GPL-3.0-or-later
# The genetic algorithm against inverse Monte Carlo: compare.png from out/METHOD-SEED/rdf.tsv and without_ramp.tsv of
# three methods and as many seeds as there are. Above, how far g(r) is off; below, the potentials as they were found,
# and without the ramp A (1 − r/r_c), which g(r) does not see.
set terminal pngcairo size 1500, 1300 font "Liberation Sans,13" fontscale 2 linewidth 2 pointscale 2 background "#ffffff"
set output "compare.png"
set encoding utf8
set minussign
set datafile separator tab
set border 3 linewidth 0.8 linecolor rgb "#222222"
set tics nomirror out scale 0.6
set grid ytics linetype 1 linewidth 0.5 linecolor rgb "#e4e4e4"
files(method, table) = system(sprintf("ls -d out/%s-[0-9]/%s", method, table))
colours = "#7a7a7a #d55e00 #0072b2"
methods = "original memetic imc"
array name = ["genetic, as in the thesis", "genetic, today", "inverse Monte Carlo"]
# What seed 1 cost, and how far off it is.
number(method, key) = real(system(sprintf("awk -F '[:,]' '/\"%s\":/ { print $2 + 0; exit }' out/%s-1/summary.json", key, method)))
seconds(method) = real(system(sprintf("tail -n 1 out/%s-1/timing.tsv | cut -f 3", method)))
array title[3]
do for [m = 1:3] {
    title[m] = sprintf("%s: %.1g in %.0f s", name[m], number(word(methods, m), "rdf_rmse"), seconds(word(methods, m)))
}
draw(table, columns) = \
    "for [m = 1:3] for [f in files(word(methods, m), '" . table . "')] f using " . columns . \
    " with lines linewidth 1.8 linecolor rgb word(colours, m) notitle"

set multiplot
set lmargin at screen 0.11
set rmargin at screen 0.98
set tmargin at screen 0.98
set bmargin at screen 0.62
set xrange [0.4:2.15]
set yrange [-0.4:0.5]
set ytics 0.2
set ylabel "{/:Italic g} − {/:Italic g}_{target}" offset 0.5
set xlabel "{/:Italic r} / {/:Italic λ}" offset 0, 0.4
set key right bottom vertical samplen 1.6 noautotitle textcolor rgb "#222222" Left reverse
eval "plot 0 linewidth 0.8 linecolor rgb '#222222', " . draw("rdf.tsv", "1:($4 - $2)") . \
    ", for [m = 1:3] NaN with lines linewidth 3 linecolor rgb word(colours, m) title title[m]"

set key off
set tmargin at screen 0.47
set bmargin at screen 0.09
set yrange [-1.2:2]
set ytics 0.5
set lmargin at screen 0.11
set rmargin at screen 0.53
set ylabel "{/:Italic Φ} / {/:Italic k}_B{/:Italic T}" offset 0.5
set label 1 "as found" at graph 0.5, graph 1.07 center
eval "plot 0 linewidth 0.8 linecolor rgb '#222222', " . draw("without_ramp.tsv", "1:2")
unset ylabel
set format y ""
set lmargin at screen 0.56
set rmargin at screen 0.98
set label 1 "without the ramp, which {/:Italic g} does not see"
eval "plot 0 linewidth 0.8 linecolor rgb '#222222', " . draw("without_ramp.tsv", "1:3")
unset multiplot
