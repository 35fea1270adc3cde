# SPDX-License-Identifier: GPL-3.0-or-later
# A curve with its 95 % band, and its target if there is one: of any observable without a script of
# its own.
# Reads the table that MESOFIT_TABLE names: x, values, errors, of a mixture those of each pair type
# as "S(A-B)[1]", or of a fit x, target, target_error, result, result_error.
# Draws figures/MESOFIT_FIGURE.svg and .png.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

y = column_of(table, "result") > 0 ? 4 : 2
# Symbols as the other figures have them, for what heads of columns call by plain letters.
names = "of[\"r\"] = \"{/:Italic r}\"; of[\"q\"] = \"{/:Italic q}\"; of[\"time\"] = \"{/:Italic t}\"; " . \
    "of[\"g\"] = \"" . g_label . "\"; of[\"S\"] = \"{/:Italic S}({/:Italic q})\"; " . \
    "of[\"msd\"] = \"MSD\"; of[\"vacf\"] = \"VACF\"; "
# The name of column n and its unit, "q / lambda^{-1}" for "q[1/lambda]", "S" for "S[1]".
header(n) = system(sprintf("awk -F '\t' 'BEGIN { " . names . "} /^#/ && NF > 1 { sub(/^# */, \"\"); h = $%d; ", n) . \
    "gsub(/\\^2/, \"²\", h); gsub(/\\^3/, \"³\", h); " . \
    "if (h ~ /\\[[^1].*\\/.*\\]/) { sub(/\\[/, \" / (\", h); sub(/\\]/, \")\", h) } gsub(/k_B\\.T_0/, \"ENERGY\", h); gsub(/[{}_@&~^\\\\]/, \" \", h); gsub(/ENERGY[.]?/, \"{/:Italic k}_B{/:Italic T}_0 \", h); sub(/\\[1\\]$/, \"\", h); " . \
    "if (sub(/\\[1\\//, \" / \", h)) sub(/\\]$/, \"^{-1}\", h); sub(/\\[/, \" / \", h); sub(/\\]/, \"\", h); " . \
    "gsub(/lambda/, \"λ\", h); gsub(/tau/, \"τ\", h); " . \
    "k = index(h \" \", \" \"); s = substr(h, 1, k - 1); print (s in of ? of[s] : s) substr(h, k); exit }'" . from(table))

# The columns of pair types, and the pair type that a column is of.
pairwise = y == 4 ? "" : system("awk -F '\t' '/^#/ && NF > 1 { for (i = 4; i <= NF; i++) " . \
    "if ($i ~ /[(].*-.*[)]/ && $i !~ /_error/) print i; exit }'" . from(table))
pair_column(i) = i > words(pairwise) ? 1 : int(word(pairwise, i)) # asked once where there are none, too
type_of(n) = system(sprintf("awk -F '\t' '/^#/ && NF > 1 { sub(/^[^(]*[(]/, \"\", $%d); sub(/[)].*/, \"\", $%d); print $%d; exit }'", n, n, n) . from(table))

stats table using 1 name "X" nooutput
# Errors are nan where they are not known: there is no band then.
stats table using (low(column(2), column(y) - 1.96 * known(y + 1))) name "L" nooutput
stats table using (high(column(2), column(y) + 1.96 * known(y + 1))) name "H" nooutput
margin = H_max > L_min ? 0.05 * (H_max - L_min) : 0.5
# What is never below 0 begins there, unless it is all far above.
stats table using (y == 4 ? low(column(2), column(4)) : $2) name "V" nooutput
P_min = L_min
P_max = H_max
do for [i = 1:words(pairwise)] {
    n = pair_column(i)
    stats table using (known(n) - 1.96 * known(n + 1)):(known(n) + 1.96 * known(n + 1)) name "S" nooutput
    P_min = low(P_min, S_min_x)
    P_max = high(P_max, S_max_y)
}
# Parts that are much larger, as where types part, leave the figure, so that the whole is seen.
if (pairwise ne "") {
    all = H_max
    L_min = high(P_min, -2 * all)
    V_min = L_min
    H_max = low(P_max, 3 * all)
}
begin = V_min >= 0 && V_min < H_max / 4 ? 0 : L_min - margin

do for [kind in kinds] {
    eval open(kind, figure, 720, 440)
    set xrange [low(0, X_min):end_of(X_max)]
    set yrange [begin:H_max + margin]
    if (part ne "") { set tmargin at screen 0.92 }
    eval part_title(0.96)
    set xlabel header(1)
    if (y == 4) { set ylabel figure noenhanced } else { set ylabel header(2) }
    if (y == 4 || pairwise ne "") { set key tmargin right horizontal } else { unset key }
    plot table using 1:(band_low(y, y + 1)):(band_high(y, y + 1)) \
            with filledcurves @band linecolor rgb blue, \
        for [i = 1:words(pairwise)] "" using 1:(band_low(pair_column(i), pair_column(i) + 1)):(band_high(pair_column(i), pair_column(i) + 1)) \
            with filledcurves @band linecolor rgb colour_of(i), \
        for [i = 1:words(pairwise)] "" using 1:(column(pair_column(i))) with lines \
            title type_of(pair_column(i)) noenhanced linewidth 1.2 linecolor rgb colour_of(i), \
        "" using 1:y with lines title (y == 4 ? "result" : pairwise eq "" ? "" : "all") linewidth 2.2 linecolor rgb blue, \
        "" using 1:(y == 4 ? $2 : NaN) with points title (y == 4 ? "target" : "") \
            pointtype 7 pointsize 0.38 linecolor rgb ink
    eval close
}
