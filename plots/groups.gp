# SPDX-License-Identifier: GPL-3.0-or-later
# Curves of several groups or kinds of molecules in one panel, each with its 95 % band, or the
# result of a fit for one of them on its target.
# Reads the table that MESOFIT_TABLE names: x, then columns of each group, those that end with
# _error behind what they belong to; what ends with _boltzmann is left out. Of a fit: x, target,
# target_error, result, result_error.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

# The names of columns without their units, and the numbers of those that are drawn.
heads = system("awk -F '\t' '/^#/ && NF > 1 { sub(/^# */, \"\"); for (n = 1; n <= NF; n++) { sub(/\\[.*/, \"\", $n); printf \"%s \", $n } exit }'" . from(table))
drawn = system("awk -F '\t' '/^#/ && NF > 1 { sub(/^# */, \"\"); for (n = 2; n <= NF; n++) if ($n !~ /(_error|_boltzmann)\\[/) printf \"%d \", n; exit }'" . from(table))
first = first_of(table)
of_time = first eq "time" || first eq "sweeps"
symbol = symbol_of(first)

stats table using 1 name "X" nooutput
highest = 0
lowest = 0
do for [k = 1:words(drawn)] {
    n = int(word(drawn, k))
    stats table using n name "Y" nooutput
    stats table using (column(n) + 1.96 * known(n + 1)) name "B" nooutput
    highest = high(highest, B_max)
    lowest = low(lowest, Y_min)
}
# In the colours of rdf.gp.
of_fit = word(heads, 2) eq "target" && word(heads, 4) eq "result"
if (of_fit) { drawn = "4" }

do for [kind in kinds] {
    eval open(kind, figure, 720, 440)
    begin = X_min > X_max / 4 ? X_min : low(0, X_min)
    set xrange [begin:above(begin, X_max)]
    set yrange [1.04 * lowest:end_of(highest)]
    set xlabel first eq "sweeps" ? first : per_unit(symbol, table, 1)
    set ylabel of_time ? per_unit("⟨|Δ{/:Bold R}({/:Italic t})|^2⟩", table, 2) : per_unit("{/:Italic p}" . index_of_part . "(" . symbol . ")", table, 2)
    eval part_title(0.96)
    set key tmargin right horizontal
    plot for [k = 1:words(drawn)] table using 1:(band_low(int(word(drawn, k)), int(word(drawn, k)) + 1)):(band_high(int(word(drawn, k)), int(word(drawn, k)) + 1)) \
            with filledcurves @band linecolor rgb colour_of(k - 1), \
        for [k = 1:words(drawn)] table using 1:int(word(drawn, k)) with lines \
            title word(heads, int(word(drawn, k))) linewidth 2.2 linecolor rgb colour_of(k - 1), \
        for [k = 1:of_fit] table using 1:2 with points title "target" \
            pointtype 7 pointsize 0.38 linecolor rgb ink
    eval close
}
