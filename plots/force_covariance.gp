# SPDX-License-Identifier: GPL-3.0-or-later
# The covariance of the forces on two particles, by their distance, on what it is without a time step.
# Reads force_covariance.tsv: r, kappa, kappa_error, exact (nan in a mixture).

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

file = "force_covariance.tsv"
stats file using 1 name "R" nooutput
stats file using (high(known(2), known(4))) name "K" nooutput
stats file using (low(known(2), 0)) name "L" nooutput
with_exact = has_numbers(file, 4)

do for [kind in kinds] {
    eval open(kind, "force_covariance", 560, 400)
    set xrange [0:R_max + R_min]
    set yrange [1.05 * low(L_min, 0):end_of(K_max)]
    set xlabel r_axis_of(file)
    set ylabel axis_of(file, "kappa", "{/:Italic κ}({/:Italic r})", "{/:Italic κ}({/:Italic r}) / ({/:Italic k}_B{/:Italic T}_0 {/:Italic μ}/{/:Italic τ})")
    set key on inside right top noautotitle enhanced
    plot for [i = 1:with_exact] file using 1:4 with lines @true_line title "2{/:Italic k}_B{/:Italic T ω}^2, without a time step", \
        file using 1:(valid(2) ? $2 : NaN):3 with yerrorbars pointtype 7 pointsize 0.6 linewidth 1.2 linecolor rgb blue \
            title "−{/:Italic Δt} ⟨{/:Bold F}_i·{/:Bold F}_j⟩, measured"
    eval close
}
