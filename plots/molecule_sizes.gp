# SPDX-License-Identifier: GPL-3.0-or-later
# How large molecules are, and how long they keep their direction: rms end-to-end distance and radius of
# gyration of each kind over time, and the correlation of the end-to-end vector.
# Reads molecule_sizes.tsv: time or sweeps, then of each kind gyration_KIND and end_KIND, squares; and
# end_to_end.tsv: time or sweeps, then of each kind the correlation and its error.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

sizes = "molecule_sizes.tsv"
turns = "end_to_end.tsv"
kinds_of_molecules = system("awk -F '\t' '/^#/ && NF > 1 { for (n = 2; n <= NF; n += 2) { sub(/\\[.*/, \"\", $n); printf \"%s \", $n } exit }' " . turns)
count = words(kinds_of_molecules)
unit = system("awk -F '\t' '/^#/ && NF > 1 { h = $2; sub(/.*\\[/, \"\", h); sub(/\\^2.*/, \"\", h); gsub(/angstrom/, \"Å\", h); gsub(/lambda/, \"{/:Italic λ}\", h); print h; exit }' " . sizes)
what(n) = first_of(n) eq "sweeps" ? "sweeps" : per_unit("{/:Italic t}", n, 1)

top = 0
do for [k = 2:2 * count + 1] {
    stats sizes using (sqrt(known(k))) name "S" nooutput
    top = high(top, S_max)
}
stats sizes using 1 name "X" nooutput
stats turns using 1 name "T" nooutput
lowest = 0
do for [k = 1:count] {
    stats turns using 2 * k name "C" nooutput
    lowest = low(lowest, C_min)
}

do for [kind in kinds] {
    eval open(kind, "molecule_sizes", 720, 600)
    set multiplot
    set lmargin at screen 0.12
    set rmargin at screen 0.97

    set tmargin at screen 0.92
    set bmargin at screen 0.60
    set xrange [X_min:above(X_min, X_max)]
    set yrange [0:end_of(top)]
    set xlabel what(sizes)
    eval name_axis("size / " . unit, 0.024)
    set key at screen 0.97, screen 0.985 right top horizontal
    plot for [k = 1:count] seen(sizes, 2 * k + 1) using 1:(sqrt(column(2 * k + 1))) with lines \
            title word(kinds_of_molecules, k) . ": end to end" linewidth 1.8 linecolor rgb colour_of(k - 1), \
        for [k = 1:count] seen(sizes, 2 * k) using 1:(sqrt(column(2 * k))) with lines \
            title "radius of gyration" linewidth 1.8 dashtype 2 linecolor rgb colour_of(k - 1)

    set tmargin at screen 0.47
    set bmargin at screen 0.11
    set xrange [0:above(0, T_max)]
    set yrange [1.04 * lowest:1.04]
    set xlabel "apart in time, " . what(turns)
    eval name_axis("⟨{/:Bold R}({/:Italic t})·{/:Bold R}(0)⟩ / ⟨{/:Italic R}²⟩", 0.024)
    set key off
    plot for [k = 1:count] turns using 1:(band_low(2 * k, 2 * k + 1)):(band_high(2 * k, 2 * k + 1)) \
            with filledcurves @band linecolor rgb colour_of(k - 1), \
        for [k = 1:count] turns using 1:2 * k with lines linewidth 2.2 linecolor rgb colour_of(k - 1)
    unset multiplot
    eval close
}
