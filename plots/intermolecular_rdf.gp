# SPDX-License-Identifier: GPL-3.0-or-later
# g(r) of beads of different molecules in one simulation, with the bands of one standard error.
# Reads intermolecular_rdf.tsv or, in a mixture, intermolecular_rdf_A-A.tsv, intermolecular_rdf_A-B.tsv, …:
# r, g, g_error.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

stem = "intermolecular_rdf"
tables = system("ls | grep -E '^" . stem . "(_[A-Za-z0-9_]+-[A-Za-z0-9_]+)?[.]tsv$'")
pair_of(file) = strlen(file) > strlen(stem . ".tsv") ? file[strlen(stem) + 2:strlen(file) - 4] : ""
nm = factor_of(word(tables, 1), "r[nm]", 1)
top = 0
do for [file in tables] {
    stats file using (nm * $1) name "R" nooutput
    stats file using ($2 + known(3)) name "G" nooutput
    top = high(top, G_max)
}

do for [kind in kinds] {
    eval open(kind, figure, 720, 440)
    set xrange [0:above(0, R_max)]
    set yrange [0:top > 0 ? 1.08 * top : 1]
    set xlabel r_axis_of(word(tables, 1))
    set ylabel "{/:Italic g}({/:Italic r}) between molecules"
    set key outside right top vertical
    plot for [i = 1:words(tables)] word(tables, i) using (nm * $1):($2 - $3):($2 + $3) \
            with filledcurves @band linecolor rgb colour_of(i - 1), \
        for [i = 1:words(tables)] word(tables, i) using (nm * $1):2 with lines \
            title pair_of(word(tables, i)) linewidth 2.2 linecolor rgb colour_of(i - 1)
    eval close
}
