# SPDX-License-Identifier: GPL-3.0-or-later
# Escape times of the result on those of the target, for some first separations r0, and the
# difference over all of them.
# Reads etd_cells.tsv: time, r0, target, target_error, result, result_error; a row a cell, all r0 of
# a time together; nan where not known. What few pairs tell, with errors of a tenth and more, is
# left out of the curves and of the colours' range, if there is anything else.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

# The number of r0, then the row (from 0) and r0 of those that are known of both, or else of all.
found = system("awk -F '\t' '/^#/ { next } !begun { begun = 1; first = $1 } \
    $1 == first { r[bins++] = $2 } { row++ } \
    $1 != first && $3 ~ /[0-9]/ && $5 ~ /[0-9]/ { k = (row - 1) % bins; some[k] = 1; \
    if ($4 + 0 > 0.1 || $6 + 0 > 0.1) few[k] = 1 } \
    END { for (k in some) if (!few[k]) { seen[k] = 1; any = 1 } \
    for (k in some) if (!any) seen[k] = 1; for (k in seen) any = 1; \
    printf \"%d\", bins; for (k = 0; k < bins; k++) if (seen[k] || !any) \
    printf \" %d %s\", k, r[k] }' etd_cells.tsv")
bins = int(word(found, 1))
known_bins = (words(found) - 1) / 2
curves = low(6, known_bins)
pick(i) = curves > 1 ? int((known_bins - 1) * i / (curves - 1.0) + 0.5) : 0
bin(i) = int(word(found, 2 + 2 * pick(i)))
r0(i) = real(word(found, 3 + 2 * pick(i)))

ps = factor_of("etd_cells.tsv", "time[ps]", 1)
nm = factor_of("etd_cells.tsv", "r0[nm]", 2)
r0_label = in_units("etd_cells.tsv", "r0[nm]", "{/:Italic r}_0 / nm", "{/:Italic r}_0 / {/:Italic λ}")
stats "etd_cells.tsv" using (ps * $1) name "T" nooutput
stats "etd_cells.tsv" using (nm * $2) name "R" nooutput
stats "etd_cells.tsv" using (valid(3) && valid(5) ? abs($5 - $3) : 0) name "D" nooutput
stats "etd_cells.tsv" using (valid(3) && valid(5) && !(valid(4) && $4 > 0.1) && \
    !(valid(6) && $6 > 0.1) ? abs($5 - $3) : 0) name "K" nooutput
limit = K_max > 0 ? K_max : D_max > 0 ? D_max : 1
half = bins > 1 ? 0.5 * (R_max - R_min) / (bins - 1) : 0.5
times = T_records / bins
step = T_max / high(1, times - 1)
dots = int(high(1, times / 25))

do for [kind in kinds] {
    eval open(kind, "etd_cells", 720, 640)
    set multiplot
    set lmargin at screen 0.125
    set rmargin at screen 0.79
    set xrange [0:above(0, T_max + 0.5 * step)]

    set tmargin at screen 0.97
    set bmargin at screen 0.50
    set yrange [0:1.04]
    set ytics 0.2
    set format x ""
    eval name_axis(E_label, 0.024)
    set key at screen 0.985, graph 1 right top title r0_label enhanced
    plot for [i = 0:curves - 1] "etd_cells.tsv" every bins::bin(i) using (ps * $1):5 with lines \
            linewidth 2.4 linecolor rgb colour_of(i) title sprintf("%.3f", nm * r0(i)), \
        for [i = 0:curves - 1] "" every (dots * bins)::bin(i) using (ps * $1):3 with points \
            pointtype 6 pointsize 0.42 linewidth 0.8 linecolor rgb colour_of(i), \
        NaN with points title "target" pointtype 6 pointsize 0.42 linewidth 0.8 linecolor rgb ink

    set tmargin at screen 0.45
    set bmargin at screen 0.11
    set key off
    unset grid
    set yrange [R_min - half:R_max + half]
    set ytics step_of((R_max - R_min) / 3)
    set format x "%h"
    set xlabel t_axis_of("etd_cells.tsv")
    eval name_axis(r0_label, 0.024)
    set palette defined (-1 blue, -0.5 "#8fbfdd", 0 "#f7f7f7", 0.5 "#eeb48c", 1 vermillion)
    set cbrange [-limit:limit]
    set cbtics step_of(limit / 1.5) scale 0.5
    set colorbox vertical user origin screen 0.82, screen 0.11 size screen 0.025, screen 0.34 \
        noborder
    set label 2 "{/:Italic E} − {/:Italic E}_{target}" at screen 0.97, screen 0.28 center rotate
    plot "etd_cells.tsv" using (ps * $1):(nm * $2):($5 - $3) with image
    unset label 2
    unset xlabel
    unset multiplot
    set grid
    eval close
}
