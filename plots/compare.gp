# SPDX-License-Identifier: GPL-3.0-or-later
# Several fits and simulations: g(r), Φ(r) and ω(r) with their 95 % bands, as far as any of them has
# one, and what the error cost each. A fit keeps its colour in every panel.
# Reads compare.tsv (numbers and names of the fits, in its comment lines) and, one block a fit and
# a row of nan for a fit that has none,
# rdf_compare.tsv: r, target, target_error, result, result_error;
# potential_compare.tsv: r, phi, phi_error, truth; omega_compare.tsv: r, omega, omega_error, truth;
# error_compare.tsv: iteration, evaluations, engine_steps, seconds, error, noise.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

stats "compare.tsv" using 1 name "C" nooutput
count = int(C_records)
name_of(i) = system(sprintf("awk -F '\t' '$1 == \"# %d\" { print $2; exit }' compare.tsv", i))
array name[count]
do for [i = 1:count] { name[i] = name_of(i - 1) }

# The first block of a file with a true curve, or −1; 1 if there is a file with an error.
truth_in(file) = !has(file) ? -1 : int(system("awk -F '\t' 'BEGIN { found = -1 } \
    /^# [0-9]+\t/ { block = substr($1, 3) } !/^#/ && found < 0 && $4 ~ /[0-9]/ { found = block } \
    END { print found }'" . from(file)))
with_rdf = has("rdf_compare.tsv")
r_axis = r_axis_of(with_rdf ? "rdf_compare.tsv" : has("potential_compare.tsv") ? "potential_compare.tsv" : \
    has("omega_compare.tsv") ? "omega_compare.tsv" : "compare.tsv")
with_target = 0
with_phi = has("potential_compare.tsv")
with_omega = has("omega_compare.tsv")
with_error = has_numbers("error_compare.tsv", 5)
phi_truth = truth_in("potential_compare.tsv")
omega_truth = truth_in("omega_compare.tsv")

# Distances from `begin`, beyond the cores; the same range for all, so that peaks stand above wells.
begin = 0
widest = 0
if (with_rdf) {
    stats "rdf_compare.tsv" using 1 name "R" nooutput
    stats "rdf_compare.tsv" using (high(known(2), known(4))) name "G" nooutput
    stats "rdf_compare.tsv" using (high(known(2), known(4)) > 1e-3 ? $1 : NaN) name "B" nooutput
    with_target = has_numbers("rdf_compare.tsv", 2)
    begin = B_records > 0 ? floor(10 * (B_min - 0.06)) / 10.0 : 0
    widest = R_max
}
if (with_phi) {
    stats "potential_compare.tsv" using 1 name "R" nooutput
    view = potential_view("potential_compare.tsv", 3)
    top = real(word(view, 1))
    bottom = low(0, real(word(view, 3)))
    first = floor(10 * real(word(view, 2))) / 10.0
    begin = with_rdf ? low(begin, first) : first
    widest = high(widest, R_max)
}
begin = high(0, begin)
if (with_omega) {
    stats "omega_compare.tsv" using 1 name "R" nooutput
    widest = high(widest, R_max)
    # Where the data say nothing the bands are wide: they may leave the figure.
    stats "omega_compare.tsv" using ($1 < begin ? NaN : high($2, known(4))) name "W" nooutput
    stats "omega_compare.tsv" using ($1 < begin ? NaN : $2 + low(1.96 * known(3), 0.3 * W_max)) \
        name "V" nooutput
}
if (with_error) {
    stats "error_compare.tsv" using (known(2)) name "N" nooutput
    stats "error_compare.tsv" using (positive(2)) name "M" nooutput
    stats "error_compare.tsv" using (known(3)) name "S" nooutput
    stats "error_compare.tsv" using (positive(3)) name "T" nooutput
    stats "error_compare.tsv" using (known(4)) name "U" nooutput
    stats "error_compare.tsv" using (positive(4)) name "Q" nooutput
    stats "error_compare.tsv" using (high(known(5), known(6))) name "E" nooutput
    stats "error_compare.tsv" using (low(positive(5), positive(6))) name "L" nooutput
}

# Heights in points, from the top: legend in two columns, the panels over r, the row of errors.
with_truth = phi_truth >= 0 || omega_truth >= 0
# More bands than these lie on each other and hide the curves.
most_bands = 5
with_band = count > most_bands ? 0 : \
    (with_phi ? has_numbers("potential_compare.tsv", 3) : 0) + \
    (with_omega ? has_numbers("omega_compare.tsv", 3) : 0)
banded = with_band ? count : 0
extra = with_target + with_truth + (with_band > 0) + with_error
rows = (count + extra + 1) / 2
legend = 24 + 21 * rows
panels = with_rdf + with_phi + with_omega
floor_of(panel) = 280 + 250 * (panel - 1) - (with_rdf ? 0 : 45)
last_floor = panels ? floor_of(panels) : -75
height = legend + last_floor + 80 + (with_error ? 280 : 0)
edge(y) = 1 - (legend + y) / real(height)
dashes(i) = i < 4 ? 1 : 4
line_of(i) = sprintf("linewidth 2 dashtype %d linecolor rgb '%s'", dashes(i), colour_of(i))
do for [i = 1:count] { eval sprintf("set style line %d %s", i, line_of(i - 1)) }

# Command for the next panel over r; the last one has the labels.
next_panel(panel) = sprintf("set tmargin at screen %g; set bmargin at screen %g; ", \
    edge(panel == 1 ? 10 : floor_of(panel - 1) + 25), edge(floor_of(panel))) . \
    (panel == panels ? "set format x '%h'; set xlabel r_axis" : "set format x ''")

# Steps are counted in thousands or millions where there are so many.
thousands = !with_error || S_max < 1e4 ? 0 : S_max < 1e7 ? 3 : 6
steps_label = thousands ? sprintf("steps / 10^{%d}", thousands) : "steps"
unit = 10.0**thousands
# A logarithmic axis of a panel that is narrow; nothing that could be shown is like one to ten.
narrow_tics(a, b) = sprintf("set xtics (%s%g)", decades(power(a), b, log10(b / a) > 1.6), \
    10**ceil(log10(b)))
narrow(a, b) = a > b ? narrow(1, 10) : sprintf("set logscale x; set xrange [%g:%g]; ", \
    a / 1.25, b * 1.25) . narrow_tics(a, b)
error_panel(k) = sprintf("set lmargin at screen %g; set rmargin at screen %g; ", \
    0.105 + 0.3 * k, 0.375 + 0.3 * k)
# The error is that of each fit's own targets.
others = int(system("awk -F '\t' '!/^#/ { exit } { for (k = 1; k <= NF; k++) \
    if ($k ~ /_rmse\\[/ && $k !~ /^(# *)?rdf_rmse/) found = 1 } END { print found + 0 }' compare.tsv"))
y_label = others ? "error of the fit" : "rmse of {/:Italic g}"

do for [kind in kinds] {
    eval open(kind, "compare", 860, height)
    set multiplot
    # The legend, on an empty panel: a lower one would not have room for its rows.
    set lmargin at screen 0.105
    set rmargin at screen 0.975
    set tmargin at screen 1
    set bmargin at screen 0
    unset border
    unset tics
    unset grid
    unset logscale
    unset label 1
    unset xlabel
    set xrange [0:1]
    set yrange [0:1]
    set key on at screen 0.105, screen 1 - 8.0 / height left top vertical maxrows rows Left reverse noautotitle
    eval "plot " . \
        (with_target ? "NaN with points title 'target' " . \
            "pointtype 7 pointsize 0.5 linecolor rgb ink, " : "") . \
        (with_truth ? "NaN title 'truth' @true_line, " : "") . \
        (with_band ? "NaN with filledcurves y=0 title '95 % band' @band linecolor rgb faint, " \
            : "") . \
        (with_error ? "NaN title 'statistical noise' linewidth 1.2 dashtype 3 linecolor rgb ink, " \
            : "") . \
        "for [i = 1:count] NaN title name[i] linestyle i"
    set key off
    set tics
    set border 3 linewidth 0.8 linecolor rgb ink
    set tics nomirror out scale 0.6
    set grid xtics ytics linetype 1 linewidth 0.5 linecolor rgb "#e4e4e4"

    set xrange [begin:widest > begin ? widest : begin + 1]
    set xtics autofreq
    set ytics autofreq
    set format "%h"
    panel = 0
    if (with_rdf) {
        panel = panel + 1
        eval next_panel(panel)
        set yrange [0:G_max > 0 ? 1.08 * G_max : 1]
        eval name_axis(g_label, 0.012)
        plot for [i = 1:count] "rdf_compare.tsv" index (i - 1) using 1:4 with lines linestyle i, \
            for [i = 1:count] "" index (i - 1) using 1:2 with points pointtype 7 pointsize 0.32 \
                linecolor rgb ink
    }
    if (with_phi) {
        panel = panel + 1
        eval next_panel(panel)
        set yrange [bottom - 0.1 * (top - bottom):top]
        eval name_axis(axis_of("potential_compare.tsv", "phi", "{/:Italic Φ}({/:Italic r})", phi_label), 0.012)
        plot 0 linewidth 0.8 linecolor rgb ink, \
            for [i = 1:banded] "potential_compare.tsv" index (i - 1) \
                using 1:(band_low(2, 3)):(band_high(2, 3)) with filledcurves @band \
                linecolor rgb colour_of(i - 1), \
            for [i = 1:count] "potential_compare.tsv" index (i - 1) using 1:2 with lines linestyle i, \
            for [i = phi_truth:phi_truth] "" index (i < 0 ? 0 : i) using 1:4 with lines @true_line
    }
    if (with_omega) {
        panel = panel + 1
        eval next_panel(panel)
        set yrange [0:V_max > 0 || W_max > 0 ? 1.08 * high(V_max, W_max) : 1]
        eval name_axis(axis_of("omega_compare.tsv", "omega", "{/:Italic ω}({/:Italic r})", omega_label), 0.012)
        plot 0 linewidth 0.8 linecolor rgb ink, \
            for [i = 1:banded] "omega_compare.tsv" index (i - 1) \
                using 1:(band_low(2, 3)):(band_high(2, 3)) with filledcurves @band \
                linecolor rgb colour_of(i - 1), \
            for [i = 1:count] "omega_compare.tsv" index (i - 1) using 1:2 with lines linestyle i, \
            for [i = omega_truth:omega_truth] "" index (i < 0 ? 0 : i) using 1:4 \
                with lines @true_line
    }
    if (with_error) {
        set tmargin at screen edge(last_floor + 85)
        set bmargin at screen edge(last_floor + 280)
        set format "%h"
        eval log_range("y", L_min, E_max)
        eval error_panel(0) . narrow(M_min, N_max)
        set xlabel "simulations"
        eval name_axis(y_label, 0.012)
        plot for [i = 1:count] "error_compare.tsv" index (i - 1) using 2:6 with lines \
                linewidth 1.2 dashtype 3 linecolor rgb colour_of(i - 1), \
            for [i = 1:count] "" index (i - 1) using 2:5 with linespoints linestyle i pointtype 7 pointsize 0.45

        set format y ""
        unset label 1
        eval error_panel(1) . narrow(T_min / unit, S_max / unit)
        set xlabel steps_label
        plot for [i = 1:count] "error_compare.tsv" index (i - 1) using ($3 / unit):6 with lines \
                linewidth 1.2 dashtype 3 linecolor rgb colour_of(i - 1), \
            for [i = 1:count] "" index (i - 1) using ($3 / unit):5 with linespoints linestyle i pointtype 7 pointsize 0.45

        eval error_panel(2) . narrow(Q_min, U_max)
        set xlabel "time / s"
        plot for [i = 1:count] "error_compare.tsv" index (i - 1) using 4:6 with lines \
                linewidth 1.2 dashtype 3 linecolor rgb colour_of(i - 1), \
            for [i = 1:count] "" index (i - 1) using 4:5 with linespoints linestyle i pointtype 7 pointsize 0.45
    }
    unset xlabel
    unset multiplot
    eval close
}
