# SPDX-License-Identifier: GPL-3.0-or-later
# Velocity of the solvent along x over y, and the curve that tells its viscosity.
# Reads flow_profile.tsv: y, v_x, v_x_error, fit, particles.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

stats "flow_profile.tsv" using 1 name "Y" nooutput
do for [kind in kinds] {
    eval open(kind, "flow_profile", 720, 440)
    set xlabel axis_of("flow_profile.tsv", "y", "{/:Italic y}", "{/:Italic y} / {/:Italic λ}")
    set ylabel axis_of("flow_profile.tsv", "v_x", "{/:Italic v}_x", "{/:Italic v}_x / ({/:Italic λ}/{/:Italic τ})")
    set xrange [0:Y_max + Y_min]
    set key right top vertical
    plot "flow_profile.tsv" using 1:(band_low(2, 3)):(band_high(2, 3)) \
            with filledcurves @band linecolor rgb blue, \
        "" using 1:2 with points title "measured" pointtype 7 pointsize 0.5 linecolor rgb blue, \
        "" using 1:(valid(4) ? $4 : NaN) with lines title "fit" @true_line
    eval close
}
