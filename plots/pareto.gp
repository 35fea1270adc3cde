# SPDX-License-Identifier: GPL-3.0-or-later
# What a fit of several targets has to choose from, by its errors of the first two of them: every
# simulation, the front of the last iteration, and the member that was chosen; dashed, what the
# statistical errors alone would give.
# Reads pareto.tsv: member, rank, chosen, measured, error, an rmse of each target, then a noise of each;
# and pareto_history.tsv: iteration, front, error, an rmse of each target.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

targets = int(system("head -n 1 pareto.tsv | grep -o _rmse | wc -l"))
target(n) = system(sprintf("awk -F '\t' '{ sub(/_.*/, \"\", $%d); print $%d; exit }' pareto.tsv", \
    5 + n, 5 + n))
noise_x = 6 + targets
noise_y = 7 + targets

# Those far off would squeeze the front into a corner: the axes end where the farthest tenth begins.
stats "pareto_history.tsv" using 4 name "X" nooutput
stats "pareto_history.tsv" using 5 name "Y" nooutput
stats "pareto.tsv" using ($2 == 1 ? $6 : NaN) name "A" nooutput
stats "pareto.tsv" using ($2 == 1 ? $7 : NaN) name "B" nooutput
stats "pareto.tsv" using noise_x every ::0::0 name "P" nooutput
stats "pareto.tsv" using noise_y every ::0::0 name "Q" nooutput
upper(front, quartile, median) = high(1.15 * front, quartile + 2 * (quartile - median))
left = P_max > 0 ? low(A_min, P_max) : A_min
bottom = Q_max > 0 ? low(B_min, Q_max) : B_min
right = low(X_max, upper(A_max, X_up_quartile, X_median))
top = low(Y_max, upper(B_max, Y_up_quartile, Y_median))

light = "#b5d3e7"
# The front of two targets is a line; that of more is a surface, seen from the side.
front_style = targets > 2 ? "points" : "linespoints"

do for [kind in kinds] {
    eval open(kind, "pareto", 720, 560)
    set lmargin at screen 0.13
    set rmargin at screen 0.97
    set tmargin at screen 0.92
    set bmargin at screen 0.125
    eval log_range("x", left, right)
    eval log_range("y", bottom, top)
    set xlabel rmse_of(target(1))
    eval name_axis(rmse_of(target(2)), 0.024)
    set key at screen 0.97, screen 0.985 right top vertical maxrows 1
    if (P_max > 0) {
        set arrow 1 from first P_max, graph 0 to first P_max, graph 1 nohead back \
            linewidth 1.4 dashtype 2 linecolor rgb faint
    }
    if (Q_max > 0) {
        set arrow 2 from graph 0, first Q_max to graph 1, first Q_max nohead back \
            linewidth 1.4 dashtype 2 linecolor rgb faint
    }
    plot NaN with lines title "noise" linewidth 1.4 dashtype 2 linecolor rgb faint, \
        NaN with points title "simulations" pointtype 7 pointsize 0.7 linecolor rgb light, \
        "pareto_history.tsv" using ($2 == 0 ? $4 : NaN):5 with points \
            pointtype 7 pointsize 0.3 linecolor rgb light, \
        "pareto.tsv" using ($2 == 1 ? $6 : NaN):7 with @front_style title "front" \
            linewidth 2 pointtype 7 pointsize 0.7 linecolor rgb blue, \
        "" using ($3 == 1 ? $6 : NaN):7 with points title "chosen" \
            pointtype 6 pointsize 1.5 linewidth 2.4 linecolor rgb vermillion
    eval close
}
