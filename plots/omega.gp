# SPDX-License-Identifier: GPL-3.0-or-later
# The friction weight that was found with its 95 % band, and the true one if it is known.
# Reads omega.tsv: r, omega, omega_error (nan where not known), and perhaps truth, r[nm]; and omega_flat.tsv
# if it is there: the change that the data say least of, on the same r. Friction across pairs and modes
# of memory, omega_transverse.tsv and memory_NAME.tsv, are drawn beside it with their bands.

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
others = system("ls omega_transverse.tsv memory_*.tsv 2>/dev/null | grep -v -e _flat -e _history")
other_name(file) = file eq "omega_transverse.tsv" ? "across" : file[8:strlen(file) - 4]
do for [file in others] {
    stats file using ($1 * nm) name "Q" nooutput
    stats file using 2 name "V" nooutput
    stats file using (shown_high(2, 3, V_max)) name "U" nooutput
    R_max = high(R_max, Q_max)
    top = high(top, high(V_max, U_max))
}
show_others = ""
do for [k = 1:words(others)] {
    file = word(others, k)
    show_others = show_others . sprintf(", '%s' using ($1 * nm):(band_low(2, 3)):(band_high(2, 3)) " . \
        "with filledcurves @band linecolor rgb '%s' notitle, '%s' using ($1 * nm):2 with lines " . \
        "linewidth 2.6 linecolor rgb '%s' title '%s'", \
        file, colour_of(k * 2), file, colour_of(k * 2), other_name(file))
}
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
    set xrange [0:above(0, R_max)]
    set yrange [0:top > 0 ? 1.08 * top : 1]
    set xlabel r_axis_of("omega.tsv")
    eval name_axis(axis_of("omega.tsv", "omega", "{/:Italic ω}({/:Italic r})", omega_label), 0.024)
    set key at screen 0.97, screen 0.985 right top vertical maxrows 1
    plot @show_band "omega.tsv" using ($1 * nm):2 with lines title words(others) ? "white" : "result" \
            linewidth 2.6 linecolor rgb vermillion @show_truth @show_flat @show_others
    eval close
}
