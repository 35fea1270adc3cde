# SPDX-License-Identifier: GPL-3.0-or-later
# How many particles are in clusters of each size.
# Reads clusters.tsv: size, share of the particles, clusters in a sample; and from used.json the types
# whose particles count, if not all do.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

stats "clusters.tsv" using 1 name "X" nooutput
stats "clusters.tsv" using 2 name "Y" nooutput

types = system("awk '/\"clusters\":/ { inside = 1 } /}/ { inside = 0 } inside && sub(/.*\"types\":[ \t]*\"/, \"\") { \
    sub(/\".*/, \"\"); gsub(/ +/, \" and \"); print }' used.json")
particles = types eq "" ? "particles" : types . " beads"

do for [kind in kinds] {
    eval open(kind, "clusters", 720, 440)
    eval log_range("x", X_min, X_max)
    eval log_range("y", Y_min, Y_max)
    set format y "10^{%T}"
    set ytics autofreq
    set xlabel particles . " in a cluster" noenhanced
    set ylabel "share of all " . particles noenhanced
    plot "clusters.tsv" using 1:2 with points pointtype 7 pointsize 0.5 linecolor rgb blue
    eval close
}
