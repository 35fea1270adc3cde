# SPDX-License-Identifier: GPL-3.0-or-later
# The potential that was found, on the potentials of the iterations before it, light to dark.
# Reads potential.tsv: r, phi, force, phi_error (nan where not known), perhaps truth, total, r[nm], phi[kJ/mol]
# and, if it is there, potential_history.tsv: r, then one column an iteration.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"
load system("printf %s \"$MESOFIT_PLOTS\"") . "/iterations.gp"

# In nm and kJ/mol where the table has them.
nm = factor_of(table, "r[nm]", 1)
kJ = factor_of(table, "phi[kJ/mol]", 2)
phi_axis = in_units(table, "phi[kJ/mol]", phi_name . " / (kJ/mol)", phi_label)

# The iterations may go a little lower than the result.
stats table using 1 name "R" nooutput
view = potential_view(table, 4)
top = real(word(view, 1))
begin = real(word(view, 2))
bottom = low(0, real(word(view, 3)))
lowest = 2 * bottom - 0.05 * top
do for [k = columns:2:-every] {
    stats history using k name "H" nooutput
    bottom = low(bottom, high(lowest, H_min))
}

# With the band, where the result is shown.
most = top - bottom
stats table using ($2 > top ? NaN : shown_high(2, 4, most)) name "B" nooutput
stats table using ($2 > top ? NaN : shown_low(2, 4, most)) name "A" nooutput
top = high(top, B_max)
bottom = low(bottom, A_min)
bottom = bottom - 0.06 * (top - bottom)

truth = column_of(table, "truth")
lower = truth ? 0.065 : 0
# An empty loop would keep its place in the legend; so would nan.
show_band = !has_numbers(table, 4) ? "" : "table " . \
    "using ($1 * nm):(kJ * band_low(2, 4)):(kJ * band_high(2, 4)) " . \
    "with filledcurves @band linecolor rgb blue title '95 % band', "
show_truth = !truth ? "" : ", table using ($1 * nm):(kJ * column(truth)) " . \
    "with lines title 'truth' @true_line"

do for [kind in kinds] {
    eval open(kind, figure, 720, 480)
    set lmargin at screen 0.13
    set rmargin at screen 0.97
    set tmargin at screen part eq "" ? 0.97 : 0.91
    eval part_title(0.955)
    set bmargin at screen 0.14
    set xrange [nm * begin:above(nm * begin, nm * R_max)]
    set yrange [kJ * bottom:kJ * top]
    set xlabel r_axis_of(table)
    eval name_axis(phi_axis, 0.024)
    set key at graph 0.985, graph 0.97 right top
    if (columns > 1) { eval iteration_bar(0.765, 0.74 - lower) }
    plot for [k = oldest:columns:every] history \
            using ($1 * nm):(kJ * column(k)):(iteration_of(k)) with lines linewidth 0.9 linecolor palette, \
        0 linewidth 0.8 linecolor rgb ink, \
        @show_band table using ($1 * nm):(kJ * $2) with lines title "result" \
            linewidth 2.6 linecolor rgb blue @show_truth
    eval close
}
