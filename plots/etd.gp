# SPDX-License-Identifier: GPL-3.0-or-later
# How long pairs stay together, for some first separations r0.
# Reads etd.tsv and etd_error.tsv: time, then a column for each bin of r0; etd_bins.tsv: r0, pairs.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

# Its tables are targets of fits, in reduced units alone: others of the folder know the physical ones.
times = "thermodynamics.tsv"
rdfs = system("ls | grep -E '^rdf(_[A-Za-z0-9_]+-[A-Za-z0-9_]+)?[.]tsv$'")
distances = words(rdfs) > 0 ? word(rdfs, 1) : ""
ps = has(times) ? factor_of(times, "time[ps]", 2) : 1
nm = strlen(distances) ? factor_of(distances, "r[nm]", 1) : 1
t_axis = t_axis_of(has(times) ? times : "etd.tsv")
r0_axis = strlen(distances) ? in_units(distances, "r[nm]", "{/:Italic r}_0 / nm", \
    "{/:Italic r}_0 / {/:Italic λ}") : "{/:Italic r}_0 / {/:Italic λ}"

stats "etd.tsv" using (ps * $1) name "T" nooutput
stats "etd.tsv" using 1 name "F" nooutput
# From the first bin to the last with pairs enough for a curve, an error below 0.05; if none has so many,
# with any.
stats "etd_bins.tsv" using 2 name "P" nooutput
enough = P_max < 100 ? 1 : 100
stats "etd_bins.tsv" using ($2 >= enough ? $0 : 1/0) name "B" nooutput
first = B_records > 0 ? int(B_min) : 0
last = B_records > 0 ? int(B_max) : 0
curves = low(6, last - first + 1)
bin(i) = curves > 1 ? first + int((last - first) * i / (curves - 1.0) + 0.5) : first

do for [i = 0:curves - 1] {
    stats "etd_bins.tsv" using 1 every ::bin(i)::bin(i) name sprintf("R%d", i) nooutput
}
r0(i) = value(sprintf("R%d_mean", i))

do for [kind in kinds] {
    eval open(kind, "etd", 720, 460)
    set lmargin at screen 0.115
    set rmargin at screen 0.80
    set tmargin at screen 0.95
    set bmargin at screen 0.15
    set xrange [0:above(0, T_max)]
    set yrange [0:1.04]
    set ytics 0.2
    set xlabel t_axis
    eval name_axis("{/:Italic E}({/:Italic t}, {/:Italic r}_0)", 0.024)
    set key outside right top title r0_axis enhanced
    # The columns of the errors follow those of the values.
    both = "< paste etd.tsv etd_error.tsv"
    plot for [i = 0:curves - 1] both using (ps * $1):(column(bin(i) + 2) - column(bin(i) + 2 + F_columns)): \
            (column(bin(i) + 2) + column(bin(i) + 2 + F_columns)) with filledcurves @band \
            linecolor rgb colour_of(i), \
        for [i = 0:curves - 1] "etd.tsv" using (ps * $1):(column(bin(i) + 2)) with lines linewidth 2.2 \
            linecolor rgb colour_of(i) title sprintf("%.3f", nm * r0(i))
    eval close
}
