# SPDX-License-Identifier: GPL-3.0-or-later
#
# table.tsv of the standard set (MESOFIT_TABLE) as a figure (MESOFIT_FIGURE): a row a system, four panels that
# share the rows. A dashed line is what is asked for; what is beyond a panel stands at its edge.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

table = system("printf %s \"$MESOFIT_TABLE\"")
set datafile separator tab
set terminal pngcairo size 2200, 1640 font 'Liberation Sans,13' fontscale 1.25 linewidth 2 pointscale 1.5 background '#ffffff' rounded
set output figure
rows = int(system("grep -vc '^#' " . table))

set yrange [rows - 0.5:-0.5]
set multiplot layout 1, 4
set tmargin at screen 0.93
set bmargin at screen 0.11
within(c, least, most) = valid(c) ? (column(c) < least ? least : column(c) > most ? most : column(c)) : NaN
set lmargin at screen 0.19
set key at screen 0.325, screen 0.065 center top horizontal maxcols 2 samplen 0.5
set rmargin at screen 0.46
set title "distributions, in their statistics"
set logscale x
set xrange [0.3:30]
set ytics scale 0
set arrow 1 from 2, graph 0 to 2, graph 1 nohead dashtype 2 linecolor rgb ink
plot table using (within(6, 0.31, 29)):0:ytic(sprintf("%s%s", strcol(1), strcol(2) eq "converged" ? "" : "  (" . strcol(2) . ")")) \
        with points pointtype 7 linecolor rgb blue title "g", \
    "" using (within(7, 0.31, 29)):0 with points pointtype 5 linecolor rgb vermillion title "lengths", \
    "" using (within(8, 0.31, 29)):0 with points pointtype 9 linecolor rgb green title "angles", \
    "" using (within(9, 0.31, 29)):0 with points pointtype 11 linecolor rgb purple title "dihedrals"

set ytics format "" 0, 1 scale 0
unset logscale x
set lmargin at screen 0.48
set key at screen 0.555, screen 0.065 center top horizontal maxcols 2 samplen 0.5
set rmargin at screen 0.63
set title "temperature − that of the scene / %"
set xrange [-5:5]
set arrow 1 from 1, graph 0 to 1, graph 1 nohead dashtype 2 linecolor rgb ink
set arrow 2 from -1, graph 0 to -1, graph 1 nohead dashtype 2 linecolor rgb ink
plot table using (within(10, -4.9, 4.9)):0:11 with xerrorbars pointtype 7 linecolor rgb blue title "kinetic", \
    "" using (within(12, -4.9, 4.9)):0:13 with xerrorbars pointtype 6 linecolor rgb vermillion title "configurational"

unset arrow 2
set lmargin at screen 0.65
set key at screen 0.735, screen 0.065 center top horizontal maxcols 2 samplen 0.5
set rmargin at screen 0.82
set title "{/:Italic Φ} − truth, rms in stated errors"
set logscale x
set xrange [0.3:30]
set arrow 1 from 1.3, graph 0 to 1.3, graph 1 nohead dashtype 2 linecolor rgb ink
plot table using (within(18, 0.31, 29)):0 with points pointtype 7 linecolor rgb blue title "Φ", \
    "" using (within(19, 0.31, 29)):0 with points pointtype 6 linecolor rgb blue title "without the open way", \
    "" using (within(20, 0.31, 29)):0 with points pointtype 5 linecolor rgb vermillion title "bonded"

set lmargin at screen 0.84
set key at screen 0.91, screen 0.065 center top horizontal maxcols 2 samplen 0.5
set rmargin at screen 0.98
set title "time / s"
set xrange [3:1200]
set arrow 1 from 480, graph 0 to 480, graph 1 nohead dashtype 2 linecolor rgb ink
plot table using (within(4, 3.1, 1190)):0 with points pointtype 7 linecolor rgb blue title "wall", \
    "" using (within(5, 3.1, 1190)):0 with points pointtype 6 linecolor rgb faint title "processor"
unset multiplot
