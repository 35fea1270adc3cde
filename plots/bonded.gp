# SPDX-License-Identifier: GPL-3.0-or-later
# U of a group of bonds, angles or dihedrals that was found, or f of a local density, on that of the
# iterations before it, light to dark. Where the target says nothing, U goes on as a parabola or a
# line: dashed.
# Reads the table that MESOFIT_TABLE names: r, theta, phi or rho, energy, energy_error (nan where the target
# says nothing), perhaps energy[kJ/mol], and the history of iterations beside it.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"
load system("printf %s \"$MESOFIT_PLOTS\"") . "/iterations.gp"

symbol = symbol_of(first_of(table))
U = (first_of(table) eq "rho" ? "{/:Italic f}" : "{/:Italic U}") . index_of_part . "(" . symbol . ")"
kJ = factor_of(table, "energy[kJ/mol]", 2)
energy_axis = in_units(table, "energy[kJ/mol]", U . " / (kJ/mol)", U . " / {/:Italic k}_B{/:Italic T}")

# What is known, and a little around it; all of a curve whose errors nobody knows.
stats table using 1 name "X" nooutput
with_band = has_numbers(table, 3)
is_shown(n) = !with_band || valid(n)
stats table using (is_shown(3) ? $1 : NaN) name "K" nooutput
stats table using (is_shown(3) ? $2 : NaN) name "U" nooutput
most = U_max - U_min
stats table using (is_shown(3) ? shown_low(2, 3, most) : NaN) name "A" nooutput
stats table using (is_shown(3) ? shown_high(2, 3, most) : NaN) name "B" nooutput
around = 0.15 * (K_max - K_min)
height = B_max > A_min ? B_max - A_min : 1
# An empty loop would keep its place in the legend.
show_band = !with_band ? "" : "table using 1:(kJ * band_low(2, 3)):(kJ * band_high(2, 3)) " . \
    "with filledcurves @band linecolor rgb blue title '95 % band', " . \
    "table using 1:(kJ * $2) with lines title 'continued' linewidth 1.6 dashtype 2 linecolor rgb blue, "

do for [kind in kinds] {
    eval open(kind, figure, 720, 480)
    set lmargin at screen 0.13
    set rmargin at screen 0.97
    set tmargin at screen 0.86
    set bmargin at screen 0.14
    begin = high(X_min, K_min - around)
    set xrange [begin:above(begin, low(X_max, K_max + around))]
    set yrange [kJ * (A_min - 0.06 * height):kJ * (B_max + 0.2 * height)]
    set xlabel per_unit(symbol, table, 1)
    eval name_axis(energy_axis, 0.024)
    set key at screen 0.97, screen 0.97 right top vertical maxrows 1 samplen 2 width -1
    eval part_title(0.955)
    if (columns > 1) { eval iteration_bar(part eq "" ? 0 : low(0.05 + 0.014 * strlen(part), 0.19), 1.085) }
    plot for [k = oldest:columns:every] history \
            using 1:(kJ * column(k)):(iteration_of(k)) with lines linewidth 0.9 linecolor palette, \
        @show_band table using 1:(is_shown(3) ? kJ * $2 : NaN) with lines title "result" \
            linewidth 2.6 linecolor rgb blue
    eval close
}
