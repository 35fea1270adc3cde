# SPDX-License-Identifier: GPL-3.0-or-later
# Flow of the solvent in the plane, bin by bin: arrows along its velocity, and how many particles there
# are for each place of a bin.
# Reads flow_field.tsv: x, y, v_x, v_y, density, …

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

stats "flow_field.tsv" using 1 name "X" nooutput
stats "flow_field.tsv" using 2 name "Y" nooutput
stats "flow_field.tsv" using (sqrt($3**2 + $4**2)) name "V" nooutput
stats "flow_field.tsv" using ($5 > 0 ? $5 : NaN) name "D" nooutput
nx = int(system("awk '!/^#/ { if (n && $2 != last) { print n; exit } last = $2; n++ }' flow_field.tsv"))
ny = int(X_records / nx)
width = X_max + X_min
height = Y_max + Y_min
# At most so many arrows along the longer side, each as long as the way to the next one.
each = int(high(1, ceil(high(nx, ny) / 60.0)))
way = each * width / nx
long = V_max > 0 ? 0.95 * way / V_max : 1
tall = high(height / width, 1 / 5.0)
range_of = D_max > D_min ? D_max - D_min : 1

do for [kind in kinds] {
    eval open(kind, "flow_panels", 900, 2 * 720 * tall + 130)
    set multiplot layout 2, 1
    unset grid
    if (height > tall * width * 0.999) { set size ratio -1 } else { set size noratio }
    set lmargin at screen 0.09
    set rmargin at screen 0.86
    set xrange [0:width]
    set yrange [0:height]
    set ytics step_of(height / 2.5)
    set ylabel axis_of("flow_field.tsv", "y", "{/:Italic y}", "{/:Italic y} / {/:Italic λ}")
    set title "velocity" offset 0, -0.6
    plot "flow_field.tsv" using (int($0) % nx % each == each / 2 && int($0) / nx % each == each / 2 && $5 > 0 ? $1 - 0.5 * long * $3 : NaN):\
        ($2 - 0.5 * long * $4):(long * $3):(long * $4) with vectors head size screen 0.004, 25 filled linewidth 0.8 linecolor rgb blue
    set title "particles" offset 0, -0.6
    set xlabel axis_of("flow_field.tsv", "x", "{/:Italic x}", "{/:Italic x} / {/:Italic λ}")
    set palette defined (0 "#ffffff", 0.5 "#56b4e9", 1 "#003d66")
    set cbrange [D_min:D_min + range_of]
    set cbtics step_of(range_of / 3)
    set cblabel axis_of("flow_field.tsv", "density", "density", "density {/:Italic λ}^2") offset 1.4
    plot "flow_field.tsv" using 1:2:($5 > 0 ? $5 : NaN) with image
    unset multiplot
    eval close
}
