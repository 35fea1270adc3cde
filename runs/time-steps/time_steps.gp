# SPDX-License-Identifier: GPL-3.0-or-later
# Which time step to take, a map a system: time-steps.png from time-steps.tsv.
if (!exists("file")) file = "time-steps.tsv"
set encoding utf8
set minussign
set datafile separator tab
set terminal pngcairo size 2400, 1240 font "Liberation Sans,12" fontscale 2 linewidth 2 pointscale 2 background "#ffffff"
set output "time-steps.png"
set border 15 linewidth 0.8 linecolor rgb "#222222"
set tics nomirror out scale 0.4
set palette defined (0 "#f3f7fb", 1 "#cfe3f2", 1.5 "#fde9a9", 2 "#f5a24c", 2.5 "#d55e00", 3 "#7a1f00")
set cbrange [-3:0]
set cbtics ("≤ 0.1 %%" -3, "1 %%" -2, "3 %%" -1.5, "10 %%" -1, "30 %%" -0.5, "≥ 100 %%" 0)
set key off

maps = "lennard-jones soft-discs brownian euler-maruyama water active-discs collision-dynamics"
array title[7] = ["Lennard-Jones, velocity Verlet", "soft discs, velocity Verlet", "soft spheres, brownian", \
    "the same, euler-maruyama", "water, linear friction", "active discs, brownian", "collision dynamics"]
array what[7] = ["energy, off by its rms over {/:Italic k}_B{/:Italic T}", "energy, off by its rms over {/:Italic k}_B{/:Italic T}", \
    "configurational temperature", "configurational temperature", "temperature, the worse of two", \
    "energy of overlaps", "viscosity beside theory; Schmidt number"]
array varied[7] = ["{/:Italic T}", "strength", "{/:Italic a}", "{/:Italic a}", "", "{/:Italic a}", "angle {/:Italic α}"]

list(map, key, column) = system(sprintf("awk -F '\t' '$1 == \"%s\" && !seen[$%d]++ { print $%d }' %s", map, key, column, file))
tics(list) = system(sprintf("echo '%s' | awk '{ printf \"%%s\\\"%%s\\\" %%d\", (NR > 1) ? \", \" : \"\", $1, NR - 1 }'", list))
low(least, x) = x < least ? least : x
high(x) = x > 0 ? 0 : x
# The longest step of a row up to which no error is above 3 % by more than its own error, and nothing unstable.
best(map) = sprintf("< awk -F '\t' '$1 == \"%s\" { e = ($7 == \"nan\") ? 0 : $7; if ($8 > 0 || $6 * $6 > (0.03 + e) * (0.03 + e)) over[$2] = 1; if (!over[$2]) last[$2] = $3 } END { for (r in last) print last[r] \"\t\" r }' %s", map, file)

set multiplot
do for [m = 1:7] {
    map = word(maps, m)
    across = (m - 1) % 4
    down = (m - 1) / 4
    left = 0.088 + across * 0.232
    set lmargin at screen left
    set rmargin at screen left + 0.175
    set tmargin at screen (down == 0 ? 0.9 : 0.405)
    set bmargin at screen (down == 0 ? 0.645 : 0.15)
    rows = words(list(map, 2, 4))
    columns = words(list(map, 3, 5))
    set xrange [-0.5:columns - 0.5]
    set yrange [-0.5:rows - 0.5]
    eval "set xtics (" . tics(list(map, 3, 5)) . ") rotate by 60 right font ',10'"
    eval "set ytics (" . tics(list(map, 2, 4)) . ") font ',10'"
    set label 1 title[m] at graph 0, graph 1.17 left font ",13"
    set label 2 what[m] at graph 0, graph 1.06 left font ",10" textcolor rgb "#555555"
    set label 3 varied[m] at graph -0.25, graph 0.5 center rotate
    set label 4 "time step / {/:Italic τ}" at graph 0.5, graph -0.42 center font ",11"
    if (m == 1) { set colorbox user origin 0.77, 0.13 size 0.012, 0.24 } else { unset colorbox }
    if (m == 1) {
        set label 10 "off by" at screen 0.77, 0.395 left
        set object 1 rectangle from screen 0.86, 0.34 to screen 0.872, 0.365 fillcolor rgb "#9a9a9a" fillstyle solid border rgb "#222222"
        set label 11 "ended as unstable" at screen 0.878, 0.3525 left font ",11"
        set label 12 "● longest step within 3 %" at screen 0.86, 0.30 left font ",11"
        set label 13 "Hard discs and spheres\nhave no time step:\nthey go from collision\nto collision." at screen 0.86, 0.25 left font ",11"
    } else { unset label 10; unset label 11; unset label 12; unset label 13; unset object 1 }
    if (map eq "collision-dynamics") {
        plot file using (strcol(1) eq map && $8 == 0 ? $3 : NaN):2:(0.5):(0.5):(high(low(-3, log10(abs($6) + 1e-9)))) \
            with boxxyerror linecolor palette fillstyle solid noborder, \
            file using (strcol(1) eq map && $8 == 0 ? $3 : NaN):2:(sprintf($9 < 9.5 ? "%.1f" : "%.0f", $9)) with labels font ",10"
    } else {
        plot file using (strcol(1) eq map && $8 == 0 ? $3 : NaN):2:(0.5):(0.5):(high(low(-3, log10(abs($6) + 1e-9)))) \
            with boxxyerror linecolor palette fillstyle solid noborder, \
            file using (strcol(1) eq map && $8 > 0 ? $3 : NaN):2:(0.5):(0.5) with boxxyerror linecolor rgb "#9a9a9a" fillstyle solid noborder, \
            best(map) using 1:2 with points pointtype 7 pointsize 0.9 linecolor rgb "#222222"
    }
}
unset multiplot
