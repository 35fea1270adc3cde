# SPDX-License-Identifier: GPL-3.0-or-later
# The friction weight that was found with its 95 % band, and the true one if it is known.
# Reads omega.tsv: r, omega, omega_error (nan where not known), and perhaps truth, r[nm]; and omega_flat.tsv
# if it is there: the change that the data say least of, on the same r.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

truth = column_of("omega.tsv", "truth")
nm = factor_of("omega.tsv", "r[nm]", 1)
stats "omega.tsv" using ($1 * nm) name "R" nooutput
stats "omega.tsv" using 2 name "W" nooutput
if (truth) {
    stats "omega.tsv" using truth name "T" nooutput
    W_max = high(W_max, T_max)
}
stats "omega.tsv" using (shown_high(2, 3, W_max)) name "B" nooutput
top = high(W_max, B_max)
# An empty loop would keep its place in the legend; so would nan.
show_band = !has_numbers("omega.tsv", 3) ? "" : "'omega.tsv' " . \
    "using ($1 * nm):(band_low(2, 3)):(band_high(2, 3)) " . \
    "with filledcurves @band linecolor rgb vermillion title '95 % band', "
show_truth = !truth ? "" : ", 'omega.tsv' using ($1 * nm):(column(truth)) " . \
    "with lines title 'truth' @true_line"

both = '"< paste omega.tsv omega_flat.tsv" using ($1 * nm):'
offset = 2 + int(system("awk -F '\t' '/^#/ { print NF; exit }' omega.tsv"))
flat(sign) = sprintf(", %s($2 %s 1.96 * $%d) with lines linewidth 1.2 dashtype 3 " . \
    "linecolor rgb ink", both, sign, offset)
show_flat = !has("omega_flat.tsv") ? "" : \
    flat("-") . " title 'flattest'" . flat("+") . " notitle"

do for [kind in kinds] {
    eval open(kind, "omega", 720, 480)
    set lmargin at screen 0.13
    set rmargin at screen 0.97
    set tmargin at screen 0.91
    set bmargin at screen 0.14
    set xrange [0:R_max]
    set yrange [0:top > 0 ? 1.08 * top : 1]
    set xlabel r_axis_of("omega.tsv")
    eval name_axis(axis_of("omega.tsv", "omega", "{/:Italic ω}({/:Italic r})", omega_label), 0.024)
    set key at screen 0.97, screen 0.985 right top vertical maxrows 1
    plot @show_band "omega.tsv" using ($1 * nm):2 with lines title "result" \
            linewidth 2.6 linecolor rgb vermillion @show_truth @show_flat
    eval close
}
