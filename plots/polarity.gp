# SPDX-License-Identifier: GPL-3.0-or-later
# Directions of particles: how many share one, how long one is kept, and how far it takes them.
# Reads polar_order.tsv: time, order; polarity.tsv: time, correlation, error, MSD, error and, of free
# particles, what both are by theory.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

exact = column_of("polarity.tsv", "correlation_theory")
stats "polar_order.tsv" using 1 name "O" nooutput
stats "polarity.tsv" using (positive(1)) name "E" nooutput
stats "polarity.tsv" using 1 name "T" nooutput
stats "polarity.tsv" using (positive(4)) name "L" nooutput
stats "polarity.tsv" using 4 name "M" nooutput

do for [kind in kinds] {
    eval open(kind, "polarity", 720, 640)
    set multiplot
    set lmargin at screen 0.12
    set rmargin at screen 0.97
    set tmargin at screen 0.97
    set bmargin at screen 0.60
    set xrange [0:high(O_max, 1e-9)]
    set yrange [0:1.02]
    set xlabel t_axis_of("polar_order.tsv")
    set ylabel "order |⟨{/:Bold n}⟩|"
    plot seen("polar_order.tsv", 2) using 1:2 with lines linewidth 1.6 linecolor rgb green

    set tmargin at screen 0.47
    set bmargin at screen 0.10
    set rmargin at screen 0.50
    set xrange [0:above(0, T_max)]
    set yrange [-0.1:1.05]
    set ylabel "⟨{/:Bold n}({/:Italic t})·{/:Bold n}(0)⟩"
    plot "polarity.tsv" using 1:(band_low(2, 3)):(band_high(2, 3)) with filledcurves @band linecolor rgb vermillion, \
        "" using 1:2 with lines linewidth 2.2 linecolor rgb vermillion, \
        "" using 1:(exact > 0 ? column(exact) : NaN) with lines @true_line

    set lmargin at screen 0.62
    set rmargin at screen 0.97
    eval log_range("x", E_min, T_max)
    eval log_range("y", L_min, M_max)
    set ylabel axis_of("polarity.tsv", "msd", "MSD", "MSD / {/:Italic λ}^2")
    plot "polarity.tsv" every ::1 using 1:(band_low(4, 5)):(band_high(4, 5)) with filledcurves @band linecolor rgb blue, \
        "" every ::1 using 1:4 with lines linewidth 2.2 linecolor rgb blue, \
        "" every ::1 using 1:(exact > 0 ? column(exact + 1) : NaN) with lines @true_line
    unset multiplot
    unset logscale
    set xtics autofreq
    set ytics autofreq
    eval close
}
