# SPDX-License-Identifier: GPL-3.0-or-later
# Work-precision diagrams of soft discs and of Brownian dynamics: steps in a unit of time, which are the work,
# against what they leave of an error. Reads tests/bench/results/work-precision.tsv, named by
# MESOFIT_TABLE: four blocks of time step, error and its error. Draws figures/work_precision.svg and .png:
#   mkdir -p figures && MESOFIT_PLOTS=plots MESOFIT_TABLE=tests/bench/results/work-precision.tsv gnuplot plots/work_precision.gp

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

set datafile separator tab
set logscale xy
set format y "10^{%T}"
set key top right

# Error bars first; nothing is drawn where there are none.
draw(first, better, plain) = sprintf("plot table index %d using (1/$1):($3 > 0 ? $2 : NaN):3 with yerrorbars " . \
    "lc rgb '#0072b2' pt 7 ps 0 notitle, " . \
    "table index %d using (1/$1):2 with linespoints lc rgb '#0072b2' lw 2 pt 7 ps 0.6 title '%s', " . \
    "table index %d using (1/$1):2 with linespoints lc rgb '#d55e00' lw 2 pt 7 ps 0.6 title '%s'", \
    first, first, better, first + 1, plain)

do for [kind in kinds] {
    eval open(kind, "work_precision", 860, 400)
    set multiplot layout 1, 2 margins 0.11, 0.98, 0.17, 0.9 spacing 0.14
    set xlabel "steps in a unit of time / {/:Italic τ}^{-1}"
    set ylabel "energy error of a disc / {/:Italic k}_B{/:Italic T}_0"
    set title "soft discs"
    set xrange [400:5000]
    set yrange [1e-3:1e5]
    set xtics (500, 1000, 2000, 4000)
    eval draw(0, "velocity Verlet", "first order")
    set title "Brownian dynamics"
    set xrange [70:700]
    set yrange [1e-4:100]
    set xtics (100, 200, 500)
    eval draw(2, "brownian", "euler-maruyama")
    unset multiplot
    eval close
}
