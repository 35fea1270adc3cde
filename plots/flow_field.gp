# SPDX-License-Identifier: GPL-3.0-or-later
# Flow of the solvent in the plane: vorticity as colours, and streamlines, on which the stream
# function is the same, outside the obstacle.
# Reads flow_field.tsv: x, y, v_x, v_y, density, vorticity, stream_function; of used.json the obstacle.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

stats "flow_field.tsv" using 1 name "X" nooutput
stats "flow_field.tsv" using 2 name "Y" nooutput
stats "flow_field.tsv" using (abs($6)) name "W" nooutput
stats "flow_field.tsv" using 7 name "S" nooutput
nx = int(system("awk '!/^#/ { if (n && $2 != last) { print n; exit } last = $2; n++ }' flow_field.tsv"))
# A few bins beside the obstacle would take all the colours.
limit = W_up_quartile + 6 * (W_up_quartile - W_lo_quartile)
limit = limit > 0 ? limit : 1
width = X_max + X_min
height = Y_max + Y_min
lines = 20
# Channels longer than six times their height are drawn higher than they are: labels want room.
longest = 6.0
tall = high(height / width, 1 / longest)

load system("printf %s \"$MESOFIT_PLOTS\"") . "/streamlines.gp"

do for [kind in kinds] {
    eval open(kind, "flow_field", 900, 860 * tall + 60)
    unset grid
    if (height > tall * width * 0.999) { set size ratio -1 } else { set size noratio }
    set ytics step_of(height / 2.5)
    set cbtics step_of(limit)
    set rmargin at screen 0.82
    set xlabel axis_of("flow_field.tsv", "x", "{/:Italic x}", "{/:Italic x} / {/:Italic λ}")
    set ylabel axis_of("flow_field.tsv", "y", "{/:Italic y}", "{/:Italic y} / {/:Italic λ}")
    set cblabel axis_of("flow_field.tsv", "vorticity", "vorticity", "vorticity / {/:Italic τ}^{-1}") offset 1.6
    set xrange [0:width]
    set yrange [0:height]
    set cbrange [-limit:limit]
    set palette defined (-1 "#0072b2", 0 "#ffffff", 1 "#d55e00")
    plot "flow_field.tsv" using 1:2:($5 > 0 ? $6 : NaN) with image, \
        $streamlines using 1:2 with lines linewidth 1.1 linecolor rgb ink, \
        for [k = -1:(radius > 0 ? 1 : -2)] [t = 0:2 * pi] "+" \
            using (centre_x + k * width + radius * cos(t)):(centre_y + radius * sin(t)) \
            with filledcurves closed fillcolor rgb "#d9d9d9" fillstyle solid border linecolor rgb ink
    eval close
}
