# SPDX-License-Identifier: GPL-3.0-or-later
# Density of each type along an axis of the box, with its 95 % band; with masses that of all types
# together in a panel below, or of one type on a second axis.
# Reads density_profile.tsv: x, y or z; density and error of each type; mass densities and errors.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

file = "density_profile.tsv"
heads = system("awk -F '\t' '/^#/ && NF > 1 { sub(/^# */, \"\"); for (n = 1; n <= NF; n++) { sub(/\\[.*/, \"\", $n); printf \"%s \", $n } exit }' " . file)
drawn = system("awk -F '\t' '/^#/ && NF > 1 { sub(/^# */, \"\"); for (n = 2; n <= NF; n++) if ($n ~ /^density/) printf \"%d \", n; exit }' " . file)
mass = column_of(file, "mass_density")
name_of(k) = words(drawn) == 1 ? "" : word(heads, int(word(drawn, k)))[9:*]
axis = word(heads, 1)
# Of "1/nm^3".
unit = system("awk -F '\t' '/^#/ && NF > 1 { u = $2; sub(/^[^[]*\\[1.[ ]*/, \"\", u); sub(/\\].*/, \"\", u); sub(/\\^/, \"^{-\", u); sub(/lambda/, \"{/:Italic λ}\", u); sub(/angstrom/, \"Å\", u); print u \"}\"; exit }' " . file)

stats file using 1 name "X" nooutput
highest = 0
do for [k = 1:words(drawn)] {
    stats file using int(word(drawn, k)) name "Y" nooutput
    highest = high(highest, Y_max)
}
if (mass) { stats file using mass name "M" nooutput }
below = mass && words(drawn) > 1

do for [kind in kinds] {
    eval open(kind, "density_profile", 720, below ? 640 : 440)
    if (below) { set multiplot layout 2, 1; set lmargin 10 }
    if (mass && !below) {
        set border 11 linewidth 0.8 linecolor rgb ink
        set ytics nomirror
        set y2range [0:1.1 * end_of(M_max)]
        set y2tics
        set y2label "mass density / (g/cm³)"
    }
    set xrange [0:X_max + X_min]
    set yrange [0:1.1 * end_of(highest)]
    set xlabel per_unit("{/:Italic " . axis . "}", file, 1)
    set ylabel "number density / " . unit
    set key tmargin right horizontal
    plot for [k = 1:words(drawn)] file using 1:(band_low(int(word(drawn, k)), int(word(drawn, k)) + 1)):(band_high(int(word(drawn, k)), int(word(drawn, k)) + 1)) \
            with filledcurves @band linecolor rgb colour_of(k - 1), \
        for [k = 1:words(drawn)] file using 1:int(word(drawn, k)) with lines \
            title name_of(k) linewidth 2.2 linecolor rgb colour_of(k - 1)
    if (below) {
        set yrange [0:1.1 * end_of(M_max)]
        set ylabel "mass density / (g/cm³)"
        unset key
        plot file using 1:(band_low(mass, mass + 1)):(band_high(mass, mass + 1)) \
                with filledcurves @band linecolor rgb ink, \
            "" using 1:mass with lines linewidth 2.2 linecolor rgb ink
        unset multiplot
    }
    eval close
}
