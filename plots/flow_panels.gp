# SPDX-License-Identifier: GPL-3.0-or-later
# A solvent in the plane, in four panels: arrows along its velocity, streamlines, its particles, and how
# many of them there are for each place of a bin. Long channels one below the other, others two by two.
# Reads flow_field.tsv: x, y, v_x, v_y, density, vorticity, stream_function; solvent.tsv: x, y, if snapshots
# have the solvent; of used.json the obstacle.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

stats "flow_field.tsv" using 1 name "X" nooutput
stats "flow_field.tsv" using 2 name "Y" nooutput
stats "flow_field.tsv" using (sqrt($3**2 + $4**2)) name "V" nooutput
stats "flow_field.tsv" using ($5 > 0 ? $5 : NaN) name "D" nooutput
stats "flow_field.tsv" using 7 name "S" nooutput
nx = int(system("awk '!/^#/ { if (n && $2 != last) { print n; exit } last = $2; n++ }' flow_field.tsv"))
ny = int(X_records / nx)
width = X_max + X_min
height = Y_max + Y_min
lines = 12
load system("printf %s \"$MESOFIT_PLOTS\"") . "/streamlines.gp"

# At most so many arrows along the longer side, each as long as the way to the next one.
each = int(high(1, ceil(high(nx, ny) / 60.0)))
way = each * width / nx
long = V_max > 0 ? 0.95 * way / V_max : 1
range_of = D_max > D_min ? D_max - D_min : 1
# More particles than a figure can show: every so many.
with_particles = has("solvent.tsv")
count = with_particles ? int(system("grep -cv '^#' solvent.tsv")) : 0
thin = int(high(1, ceil(count / 8000.0)))
shown_title = thin == 1 ? "particles" : sprintf("one particle in %d", thin)

# Pixels.
is_long = height / width < 0.4
columns = is_long ? 1 : 2
panels = 3 + with_particles
rows = int(ceil(panels / real(columns)))
across = is_long ? 720 : 330
tall = int(high(height / width, 1 / 6.0) * across)
left = 70
between_x = 40
between_y = 44
right = 130
top = 30
bottom = 72
whole_x = left + columns * across + (columns - 1) * between_x + right
whole_y = top + rows * tall + (rows - 1) * between_y + bottom
# Place of a panel, from the upper left one.
low_x(k) = (left + (k % columns) * (across + between_x)) / real(whole_x)
high_x(k) = low_x(k) + across / real(whole_x)
high_y(k) = 1 - (top + (k / columns) * (tall + between_y)) / real(whole_y)
low_y(k) = high_y(k) - tall / real(whole_y)
is_last(k) = k + columns >= panels
# Of a panel that is stretched, so that arrows point where the flow goes: y a pixel over x a pixel.
turned = (height / tall) / (width / across)
place(k) = sprintf("set lmargin at screen %g; set rmargin at screen %g; set tmargin at screen %g; set bmargin at screen %g; ", \
    low_x(k), high_x(k), high_y(k), low_y(k)) . \
    (is_last(k) ? "set xlabel x_name; set format x '%h'; " : "unset xlabel; set format x ''; ") . \
    (k % columns == 0 ? "set ylabel y_name; set format y '%h'" : "unset ylabel; set format y ''")
x_name = axis_of("flow_field.tsv", "x", "{/:Italic x}", "{/:Italic x} / {/:Italic λ}")
y_name = axis_of("flow_field.tsv", "y", "{/:Italic y}", "{/:Italic y} / {/:Italic λ}")
disc = radius > 0 ? sprintf(", for [k = -1:1] [t = 0:2 * pi] '+' using (%g + k * %g + %g * cos(t)):(%g + %g * sin(t)) " . \
    "with filledcurves closed fillcolor rgb '#d9d9d9' fillstyle solid border linecolor rgb ink", centre_x, width, radius, centre_y, radius) : ""

do for [kind in kinds] {
    eval open(kind, "flow_panels", whole_x, whole_y)
    set multiplot
    unset grid
    set xrange [0:width]
    set yrange [0:height]
    set ytics step_of(height / 2.5)
    eval place(0)
    set title "velocity" offset 0, -0.6
    eval "plot 'flow_field.tsv' using (int($0) % nx % each == each / 2 && int($0) / nx % each == each / 2 && $5 > 0 ? $1 - 0.5 * long * $3 : NaN):" . \
        "($2 - 0.5 * long * turned * $4):(long * $3):(long * turned * $4) with vectors head size screen 0.004, 25 filled linewidth 0.8 linecolor rgb blue" . disc
    eval place(1)
    set title "streamlines" offset 0, -0.6
    eval "plot $streamlines using 1:2 with lines linewidth 1 linecolor rgb ink" . disc
    if (with_particles) {
        eval place(2)
        set title shown_title offset 0, -0.6
        eval "plot 'solvent.tsv' every thin using 1:2 with points pointtype 7 pointsize 0.15 linecolor rgb blue" . disc
    }
    eval place(panels - 1)
    set title "particles a bin" offset 0, -0.6
    set palette defined (0 "#ffffff", 0.5 "#56b4e9", 1 "#003d66")
    set cbrange [D_min:D_min + range_of]
    set cbtics step_of(range_of / 3)
    set cblabel axis_of("flow_field.tsv", "density", "density", "density {/:Italic λ}^2") offset 1.4
    eval "plot 'flow_field.tsv' using 1:2:($5 > 0 ? $5 : NaN) with image" . disc
    unset multiplot
    eval close
}
