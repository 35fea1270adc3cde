# SPDX-License-Identifier: GPL-3.0-or-later
# Work-precision diagram: what an integrator's time steps spoil against what they cost. An integrator
# keeps its colour in both panels; its points are its time steps, growing from right to left.
# Reads the table that MESOFIT_TABLE names, a block an integrator: integrator, time_step, cpu,
# cpu_error, cpu_to_error, g_largest, its error, g_noise, g_rms, its error, temperature_change, its
# error, configurational_change (13), its error, …, and temperature_configurational, which is found
# by its name; its comments say what error was wanted. Draws figures/MESOFIT_FIGURE.svg and .png.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

set datafile separator tab
wanted = real(system("awk '/^# wanted/ { print $3; exit }' < \"$MESOFIT_TABLE\""))
names = system("awk -F '\t' '!/^#/ && NF > 1 && !seen[$1]++ { print $1 }' < \"$MESOFIT_TABLE\"")
count = words(names)

stats table using 3 name "C" nooutput
stats table using 6 name "G" nooutput
stats table using 8 name "N" nooutput
configurational = int(system("awk -F '\t' '/^# integrator/ { for (k = 1; k <= NF; k++) \
    if ($k ~ /^temperature_configurational\\[/) print k; exit }' < \"$MESOFIT_TABLE\""))
percent(n) = 100 * column(n) / (column(configurational) - column(13))
bottom = low(G_min, N_min) / 1.6
top = low(G_max, 0.3)
# A bar that reaches 0 goes off the axis.
lower(value, error, floor) = high(abs(value) - error, floor / 10)
shown(value, floor) = high(abs(value), floor)
style(i) = sprintf("linewidth 1.8 pointtype %d pointsize 0.6 linecolor rgb '%s'", \
    word("7 5 9 11 13 4 6 8", (i - 1) % 8 + 1) + 0, colour_of(i - 1))
do for [i = 1:count] { eval sprintf("set style line %d %s", i, style(i)) }
set errorbars 0
rows = (count + 4) / 4

do for [kind in kinds] {
    height = 490 + 22 * rows
    eval open(kind, figure, 980, height)
    set multiplot
    set tmargin at screen 1 - (26.0 + 22 * rows) / height
    set bmargin at screen 78.0 / height
    eval log_range("x", 1e3 * C_min, 1e3 * C_max)
    set xlabel "processor time / ms per {/:Italic τ}"

    set lmargin at screen 0.095
    set rmargin at screen 0.485
    eval log_axis("y", bottom, 1.4 * top)
    eval name_axis("largest {/:Italic Δg}", 0.012)
    set key on at screen 0.095, screen 1 - 8.0 / height left top vertical maxrows rows Left reverse noautotitle \
        width -3.5
    plot wanted linewidth 1.2 dashtype 2 linecolor rgb ink, \
        for [i = 1:count] table index (i - 1) \
            using ($3 * 1e3):6:(lower($6, $7, bottom)):($6 + $7) \
            with yerrorbars linestyle i pointsize 0 linewidth 0.8, \
        for [i = 1:count] "" index (i - 1) using ($3 * 1e3):6 \
            with linespoints linestyle i title word(names, i), \
        "" index 0 using ($3 * 1e3):8 with lines \
            title "noise alone" linewidth 1.2 dashtype 3 linecolor rgb faint

    set lmargin at screen 0.575
    set rmargin at screen 0.975
    least = 0.1
    eval log_axis("y", least, 50)
    eval name_axis("|{/:Italic ΔT}_{conf}| / %", 0.515)
    set key off
    plot for [i = 1:count] table index (i - 1) \
            using ($3 * 1e3):(shown(percent(13), least)):(lower(percent(13), \
            percent(14), least)):(shown(percent(13), least) + percent(14)) \
            with yerrorbars linestyle i pointsize 0 linewidth 0.8, \
        for [i = 1:count] "" index (i - 1) using ($3 * 1e3):(shown(percent(13), least)) \
            with linespoints linestyle i
    unset xlabel
    unset multiplot
    eval close
}
