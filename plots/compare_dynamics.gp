# SPDX-License-Identifier: GPL-3.0-or-later
# Dynamics of several fits and simulations: how long pairs stay together, E(t, r0), at three first
# separations, as curves on those of the target; its difference from the target over all of them, a
# map for each fit; velocity autocorrelations, each divided by its own value at time 0, and their
# differences. A fit keeps its colour.
# Reads compare.tsv (names, in its comment lines) and, one block a fit and a row of nan for a fit that
# has none,
# etd_compare.tsv: time, r0, target, target_error, result, result_error, a row a cell;
# vacf_compare.tsv: time, target, target_error, result, result_error, from time 0.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

stats "compare.tsv" using 1 name "C" nooutput
count = int(C_records)
array name[count]
do for [i = 1:count] {
    name[i] = system(sprintf("awk -F '\t' '$1 == \"# %d\" { print $2; exit }' compare.tsv", i - 1))
}
with_etd = has("etd_compare.tsv")
with_vacf = has("vacf_compare.tsv")

# The fits that have both a target and a result of E, as their indices; then, of the first that has
# results, three first separations: the first and last that it knows, and one between.
in_block = "/^# [0-9]+\t/ { block = substr($1, 3) + 0 } /^#/ || $0 !~ /[0-9]/ { next } "
mapped = !with_etd ? "" : system("awk -F '\t' '" . in_block . "$3 ~ /[0-9]/ && $5 ~ /[0-9]/ && !seen[block]++ { printf \" %d\", block }' etd_compare.tsv")
separations = !with_etd ? "" : system("awk -F '\t' '" . in_block . "$5 ~ /[0-9]/ && $1 > 0 { \
    if (!begun) { begun = 1; first = block } \
    if (block == first && !seen[$2]++) r[n++] = $2 } \
    END { for (k = 0; k < 3 && k < n; k++) printf \" %s\", r[int((n - 1) * k / 2)] }' etd_compare.tsv")
# Rows of a fit at its own separation that is nearest to r.
cells(i, r) = sprintf("< awk -F '\t' '%s block == %d { row[n++] = $0; s[n - 1] = $2; \
    d = $2 - (%s); d = d < 0 ? -d : d; if (n == 1 || d < best) { best = d; nearest = $2 } } \
    END { for (k = 0; k < n; k++) if (s[k] == nearest) print row[k] }' etd_compare.tsv", in_block, i, r)
# The same of one in so many times, for points.
thin(i, r) = cells(i, r) . sprintf(" | awk 'NR %% %d == 1'", dots)

panels = words(separations)
maps = words(mapped)
with_target = maps > 0
if (panels > 0) {
    stats "etd_compare.tsv" using 1 name "T" nooutput
    stats "etd_compare.tsv" using 2 name "R" nooutput
    times = int(system("awk -F '\t' '" . in_block . "!begun { begun = 1; first = block } block == first && $1 != before { n++; before = $1 } END { print n + 0 }' etd_compare.tsv"))
    dots = int(high(1, times / 20))
    stats "etd_compare.tsv" using (valid(3) && valid(5) ? abs($5 - $3) : 0) name "D" nooutput
    limit = D_max > 0 ? D_max : 1
    r0_axis = axis_of("etd_compare.tsv", "r0", "{/:Italic r}_0", "{/:Italic r}_0 / {/:Italic λ}")
    r0_unit = r0_axis[strstrt(r0_axis, " / ") + 3:]
}

# Values at time 0 of every fit that has a VACF, and the first fit with a target.
array V0[count]
array A0[count]
first_target = 0
shown_vacf = ""
if (with_vacf) {
    do for [i = 1:count] {
        text = system(sprintf("awk -F '\t' '%s block == %d { print $2, $4; exit }' vacf_compare.tsv", in_block, i - 1))
        A0[i] = words(text) > 1 && word(text, 1) ne "nan" ? real(word(text, 1)) : 0
        V0[i] = words(text) > 1 && word(text, 2) ne "nan" ? real(word(text, 2)) : 0
        if (V0[i] > 0) { shown_vacf = shown_vacf . sprintf(" %d", i) }
        if (first_target == 0 && A0[i] > 0) { first_target = i }
    }
    lowest = 0
    end = 0
    furthest = 0
    do for [k = 1:words(shown_vacf)] {
        i = int(word(shown_vacf, k))
        stats "vacf_compare.tsv" index (i - 1) using ($4 / V0[i]) name "L" nooutput
        lowest = low(lowest, L_min)
        # They are over where they stay below 0.01, and the axis a little later.
        stats "vacf_compare.tsv" index (i - 1) using (high(abs($4) / V0[i], A0[i] > 0 ? abs($2) / A0[i] : 0) > 0.01 ? $1 : 0) name "L" nooutput
        end = high(end, 1.25 * L_max)
        if (A0[i] > 0) {
            stats "vacf_compare.tsv" index (i - 1) using (abs($4 / V0[i] - $2 / A0[i])) name "L" nooutput
            furthest = high(furthest, L_max)
        }
    }
    stats "vacf_compare.tsv" using 1 name "S" nooutput
    end = low(end, S_max)
    if (first_target) {
        stats "vacf_compare.tsv" index (first_target - 1) using ($2 / A0[first_target]) name "L" nooutput
        lowest = low(lowest, L_min)
    }
}
with_vacf = words(shown_vacf) > 0
with_difference = with_vacf && furthest > 0
with_target = with_target || first_target > 0

# Heights in points, from the top.
rows = (count + with_target + 1) / 2
legend = 24 + 21 * rows
each_row = 4
map_rows = panels ? (maps + each_row - 1) / each_row : 0
etd_floor = legend + (panels ? 240 : 0)
map_height = 150
map_floor = etd_floor + (map_rows ? 85 + map_rows * map_height + (map_rows - 1) * 35 : 0)
vacf_top = map_floor + (panels ? 75 : 5)
vacf_floor = vacf_top + (with_vacf ? 220 : 0)
difference_floor = vacf_floor + (with_difference ? 140 : 0)
height = difference_floor + 55
edge(y) = 1 - y / real(height)
left = 0.105
right = 0.975
dashes(i) = i < 4 ? 1 : 4
do for [i = 1:count] {
    eval sprintf("set style line %d linewidth 2 dashtype %d linecolor rgb '%s'", i, dashes(i - 1), colour_of(i - 1))
}
target_points = "with points pointtype 6 pointsize 0.5 linewidth 0.9 linecolor rgb ink"

do for [kind in kinds] {
    eval open(kind, "compare_dynamics", 860, height)
    set multiplot
    # The legend, on an empty panel.
    set lmargin at screen left
    set rmargin at screen right
    set tmargin at screen 1
    set bmargin at screen 0
    unset border
    unset tics
    unset grid
    unset label 1
    unset xlabel
    set xrange [0:1]
    set yrange [0:1]
    set key on at screen left, screen 1 - 8.0 / height left top vertical maxrows rows Left reverse noautotitle
    eval "plot " . (with_target ? "NaN title 'target' @target_points, " : "") . \
        "for [i = 1:count] NaN with lines title name[i] linestyle i"
    set key off
    set tics
    set border 3 linewidth 0.8 linecolor rgb ink
    set tics nomirror out scale 0.6
    set grid xtics ytics linetype 1 linewidth 0.5 linecolor rgb "#e4e4e4"
    set format "%h"

    if (panels) {
        width = (right - left - 0.03 * (panels - 1)) / panels
        set tmargin at screen edge(legend + 22)
        set bmargin at screen edge(etd_floor)
        set xrange [0:above(0, T_max)]
        set xtics step_of(T_max / 3)
        set yrange [0:1.03]
        set ytics 0.2
        set xlabel t_axis_of("etd_compare.tsv")
        eval name_axis(E_label, 0.012)
        do for [p = 1:panels] {
            set lmargin at screen left + (p - 1) * (width + 0.03)
            set rmargin at screen left + (p - 1) * (width + 0.03) + width
            set format y (p == 1 ? "%h" : "")
            set label 2 sprintf("{/:Italic r}_0 = %.3g %s", real(word(separations, p)), r0_unit) \
                at graph 0.5, graph 1.06 center enhanced
            r0 = word(separations, p)
            # A loop from 1 to 0 would still look at its file.
            eval "plot for [i = 1:count] cells(i - 1, r0) using 1:5 with lines linestyle i" . \
                (maps ? ", thin(int(word(mapped, 1)), r0) using 1:3 @target_points" : "")
            unset label 1
        }
        unset label 2
        set format "%h"
    }
    if (map_rows) {
        set palette defined (-1 blue, -0.5 "#8fbfdd", 0 "#f7f7f7", 0.5 "#eeb48c", 1 vermillion)
        set cbrange [-limit:limit]
        set cbtics step_of(limit / 1.5) scale 0.5
        set colorbox vertical user origin screen 0.905, screen edge(map_floor) \
            size screen 0.02, screen map_height / real(height) noborder
        unset grid
        columns = low(each_row, maps)
        width = (0.885 - left - 0.02 * (columns - 1)) / columns
        set yrange [R_min:R_max]
        set ytics step_of((R_max - R_min) / 3)
        set xtics step_of(T_max / (columns > 3 ? 1.2 : 2.5))
        eval name_axis(r0_axis, 0.012)
        set label 3 "{/:Italic E} − {/:Italic E}_{target}" at screen 0.985, screen edge(map_floor - map_height - 16) right
        do for [k = 1:maps] {
            row = (k - 1) / each_row
            column = (k - 1) % each_row
            floor = etd_floor + 85 + map_height + row * (map_height + 35)
            i = int(word(mapped, k)) + 1
            set lmargin at screen left + column * (width + 0.02)
            set rmargin at screen left + column * (width + 0.02) + width
            set tmargin at screen edge(floor - map_height)
            set bmargin at screen edge(floor)
            set format y (column == 0 ? "%h" : "")
            set format x (k > maps - each_row ? "%h" : "")
            eval (k > maps - each_row ? "set xlabel t_axis_of(\"etd_compare.tsv\")" : "unset xlabel")
            title_of = strlen(name[i]) > 26 ? "…" . name[i][strlen(name[i]) - 25:] : name[i]
            set label 2 title_of font columns > 3 ? ",10" : ",13" at graph 0.5, graph 1.1 center noenhanced textcolor rgb colour_of(i - 1)
            plot "etd_compare.tsv" index (i - 1) using 1:2:($5 - $3) with image
        }
        unset label 1
        unset label 2
        unset label 3
        unset colorbox
        set grid
        set format "%h"
    }
    if (with_vacf) {
        set lmargin at screen left
        set rmargin at screen right
        set tmargin at screen edge(vacf_top)
        set bmargin at screen edge(vacf_floor)
        set xrange [0:above(0, end)]
        set xtics autofreq
        set yrange [low(-0.05, 1.1 * lowest):1.03]
        set ytics 0.2
        if (with_difference) { set format x ""; unset xlabel } else { set xlabel t_axis_of("vacf_compare.tsv") }
        eval name_axis("VACF({/:Italic t}) / VACF(0)", 0.012)
        eval "plot 0 linewidth 0.8 linecolor rgb ink, " . \
            "for [k = 1:words(shown_vacf)] 'vacf_compare.tsv' index (int(word(shown_vacf, k)) - 1) " . \
            "using 1:($4 / V0[int(word(shown_vacf, k))]) with lines linestyle int(word(shown_vacf, k))" . \
            (first_target ? ", '' index (first_target - 1) using 1:($2 / A0[first_target]) @target_points" : "")
    }
    if (with_difference) {
        set tmargin at screen edge(vacf_floor + 20)
        set bmargin at screen edge(difference_floor)
        set yrange [-1.1 * furthest:1.1 * furthest]
        set ytics step_of(furthest / 1.5)
        set format x "%h"
        set xlabel t_axis_of("vacf_compare.tsv")
        eval name_axis("result − target", 0.012)
        plot 0 linewidth 0.8 linecolor rgb ink, \
            for [k = 1:words(shown_vacf)] "vacf_compare.tsv" index (int(word(shown_vacf, k)) - 1) \
                using 1:($4 / V0[int(word(shown_vacf, k))] - $2 / A0[int(word(shown_vacf, k))]) \
                with lines linestyle int(word(shown_vacf, k))
    }
    unset label 1
    unset xlabel
    unset multiplot
    eval close
}
