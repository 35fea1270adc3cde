# SPDX-License-Identifier: GPL-3.0-or-later
# The covariance of the forces on two particles, by their distance: of a simulation on what it is without
# a time step, of a fit on its target.
# Reads force_covariance.tsv: r, kappa, kappa_error, exact (nan in a mixture); or of a fit r, target,
# target_error, result, result_error.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

file = "force_covariance.tsv"
of_fit = column_of(file, "target") > 0
# Columns of points with their errors, of a line, and of its errors.
points = 2
line = 4
with_line = has_numbers(file, line)
with_band = of_fit && has_numbers(file, line + 1)
with_errors = has_numbers(file, points + 1)
stats file using 1 name "R" nooutput
stats file using (high(known(points), known(line))) name "K" nooutput
stats file using (low(known(points), 0)) name "L" nooutput
reduced = "{/:Italic κ}({/:Italic r}) / ({/:Italic k}_B{/:Italic T}_0 {/:Italic μ}/{/:Italic τ})"

do for [kind in kinds] {
    eval open(kind, "force_covariance", 560, 400)
    set xrange [0:end_of(R_max)]
    set yrange [1.05 * low(L_min, 0):end_of(K_max)]
    set xlabel r_axis_of(file)
    set ylabel of_fit ? axis_of(file, "target", "{/:Italic κ}({/:Italic r})", reduced) : \
        axis_of(file, "kappa", "{/:Italic κ}({/:Italic r})", reduced)
    set key on inside right top noautotitle enhanced
    style = of_fit ? "linewidth 2.2 linecolor rgb blue title 'result'" : \
        "@true_line title '2{/:Italic k}_B{/:Italic T ω}^2, without a time step'"
    look = "pointtype 7 pointsize 0.6 linewidth 1.2 linecolor rgb " . (of_fit ? "ink title 'target'" : \
        "blue title '−{/:Italic Δt} ⟨{/:Bold F}_i·{/:Bold F}_j⟩, measured'")
    eval "plot " . \
        (with_band ? "file using 1:(band_low(line, line + 1)):(band_high(line, line + 1)) " . \
            "with filledcurves @band linecolor rgb blue title '95 % band', " : "") . \
        (with_line ? "file using 1:line with lines " . style . ", " : "") . \
        (with_errors ? "file using 1:(valid(points) ? column(points) : NaN):points + 1 with yerrorbars " : \
            "file using 1:points with points ") . look
    eval close
}
