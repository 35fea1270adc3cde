# SPDX-License-Identifier: GPL-3.0-or-later
# Where the particles are in the last snapshot, seen along z; those with an orientation have its colour.
# Reads configuration.tsv and the box of used.json.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

table = "configuration.tsv"
edge(n) = real(system(sprintf("awk '/\"box\":/ { gsub(/[^0-9.eE, -]/, \"\"); split($0, e, \",\"); \
    print e[%d] + 0; exit }' used.json", n)))
angle = column_of(table, "orientation")
rows = int(system("grep -cv '^#'" . from(table)))
size = 40.0 / sqrt(rows)

do for [kind in kinds] {
    eval open(kind, "configuration", 640, 600)
    set size ratio -1
    set border 15
    unset grid
    set xrange [0:edge(1)]
    set yrange [0:edge(2)]
    set xlabel axis_of(table, "x", "{/:Italic x}", "{/:Italic x} / {/:Italic λ}")
    set ylabel axis_of(table, "y", "{/:Italic y}", "{/:Italic y} / {/:Italic λ}")
    set palette model HSV functions gray, 0.75, 0.85
    set cbrange [0:1]
    set cbtics ("0" 0, "{/:Italic π}" 0.5, "2{/:Italic π}" 1)
    set cblabel "orientation"
    if (angle > 0) { set colorbox } else { unset colorbox }
    turns(x) = x / (2 * pi) - floor(x / (2 * pi))
    if (angle > 0) {
        plot table using 1:2:(turns(column(angle))) with points pointtype 7 pointsize size linecolor palette
    } else {
        plot table using 1:2 with points pointtype 7 pointsize size linecolor rgb blue
    }
    eval close
}
