# SPDX-License-Identifier: GPL-3.0-or-later
# How far particles go, and how long they remember their velocity.
# Reads motion.tsv: time, msd, msd_error, vacf, vacf_error, and perhaps the same in ps and nm. The first row is that of time 0.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

ps = factor_of("motion.tsv", "time[ps]", 1)
nm2 = factor_of("motion.tsv", "msd[nm^2]", 2)
msd_axis = in_units("motion.tsv", "msd[nm^2]", "MSD / nm^2", "MSD / {/:Italic λ}^2")
stats "motion.tsv" using (ps * $1) name "T" nooutput
stats "motion.tsv" using (ps * positive(1)) name "E" nooutput
stats "motion.tsv" using (nm2 * $2) name "M" nooutput
stats "motion.tsv" using (nm2 * positive(2)) name "L" nooutput
# Without velocities the VACF is nan: the MSD has the page.
number(k) = strcol(k) eq "nan" ? 0 : column(k)
stats "motion.tsv" using (number(4) - number(5)) name "V" nooutput
stats "motion.tsv" using (number(4)) name "W" nooutput
flies = W_max > 0
first = flies ? W_max : 1

do for [kind in kinds] {
    eval open(kind, "motion", 720, 560)
    set multiplot
    set lmargin at screen 0.145
    set rmargin at screen 0.97

    set tmargin at screen 0.96
    set bmargin at screen flies ? 0.58 : 0.125
    set format x "%h"
    set format y "%h"
    set key off
    eval log_range("x", E_min, T_max)
    eval log_range("y", L_min, M_max)
    eval name_axis(msd_axis, 0.024)
    if (!flies) { set xlabel t_axis_of("motion.tsv") }
    plot "motion.tsv" every ::1 using (ps * $1):(nm2 * ($2 - $3)):(nm2 * ($2 + $3)) with filledcurves @band \
            linecolor rgb blue, \
        "" every ::1 using (ps * $1):(nm2 * $2) with lines linewidth 2.2 linecolor rgb blue

    if (flies) {
        set tmargin at screen 0.50
        set bmargin at screen 0.125
        unset logscale
        set xrange [0:above(0, T_max)]
        set xtics autofreq
        set yrange [low(-0.05, V_min / first):1.05]
        set ytics 0.2
        set xlabel t_axis_of("motion.tsv")
        eval name_axis("VACF({/:Italic t}) / VACF(0)", 0.024)
        plot 0 linewidth 0.8 linecolor rgb ink, \
            "motion.tsv" using (ps * $1):(($4 - $5) / first):(($4 + $5) / first) with filledcurves @band \
                linecolor rgb vermillion, \
            "" using (ps * $1):($4 / first) with lines linewidth 2.2 linecolor rgb vermillion
    }
    unset xlabel
    unset multiplot
    eval close
}
