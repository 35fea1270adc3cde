# SPDX-License-Identifier: GPL-3.0-or-later
# A film of a run's snapshots, seen along z: discs of their size in the colours that the program gives
# them, what is far along z pale.
# Reads head.gp and frame_N.tsv (x, y, radius, colour; with bonds, in blocks for each layer of depth:
# corners of halves of bonds, as x, y, colour, and discs) in the folder $MESOFIT_FILM, writes film.gif there;
# of the run's folder used.json: units and an obstacle.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"
folder = system("printf %s \"$MESOFIT_FILM\"")
load folder . "/head.gp"

time_unit = has("used.json") && int(system("grep -c '\"units\": *\"' used.json || true")) ? "" : " {/:Italic τ}"
unit_of_bar = quantity eq "speed" && time_unit ne "" ? " / ({/:Italic λ}/{/:Italic τ})" : ""

obstacle(n) = !has("used.json") ? 0 : real(system(sprintf("awk '/\"obstacle_centre\":/ { sub(/.*\\[/, \"\"); split($0, centre, \",\") } \
    /\"obstacle_radius\":/ { gsub(/[^0-9.eE-]/, \"\", $2); radius = $2 } \
    END { print %d ? centre[%d] + 0 : radius + 0 }' used.json", n, n)))

# Pixels: the box 600 wide, or so high; a long channel is as wide as the screen.
inside = Y > X ? 600.0 * X / Y : Y < 0.4 * X ? 1100.0 : 600.0
scale_of_box = inside / X
left = 20
right = scale eq "types" && words(types) == 0 ? 20 : 130
top = 40
bottom = 20
across = int(inside) + left + right
tall = int(high(Y * scale_of_box, 120)) + top + bottom

set terminal gif animate delay 5 loop 0 size across, tall font "Liberation Sans,12" background "#ffffff"
set output folder . "/film.gif"
set lmargin at screen left / real(across)
set rmargin at screen 1 - right / real(across)
set bmargin at screen bottom / real(tall)
set tmargin at screen 1 - top / real(tall)
set xrange [0:X]
set yrange [0:Y]
if (Y * scale_of_box >= 120) { set size ratio -1 } else { set size noratio }
set border 15
unset tics
unset grid
if (obstacle(0) > 0) { set object 2 circle at obstacle(1), obstacle(2) size obstacle(0) behind fillstyle solid 1 border rgb ink fillcolor rgb 0xd9d9d9 }
set key on outside right top vertical Left reverse noautotitle
if (scale eq "types") { unset colorbox } else {
    set colorbox
    set cbrange [least:most]
    set cblabel quantity . unit_of_bar offset 1.5
    set cbtics format "%h"
    if (scale eq "turns") { set cbrange [0:1]; set cbtics ("0" 0, "{/:Italic π}" 0.5, "2{/:Italic π}" 1) } else { set cbtics scale 0.4 }
}
# A rim, where there are few enough to see it.
if (count <= 5000) { set style fill solid 1 border rgb "#ffffff" } else { set style fill solid 1 noborder }
# A colour bar's palette would take half of a GIF's colours: where there is no bar there is none.
bar = scale eq "types" ? "NaN with points linecolor rgb ink" : "NaN with points palette"
discs = " using 1:2:3:4 with circles linecolor rgb variable"
halves = " using 1:2:3 with filledcurves closed linecolor rgb variable"
legend = words(types) == 0 ? "" : ", for [n = 2:words(types):2] NaN with points pointtype 7 pointsize 1.5 " . \
    "linecolor rgb colour_of(int(word(types, n))) title word(types, n - 1)"
# Bonds are behind the discs of their layer.
drawn(n) = n == layers ? "" : sprintf(", frame index %d%s, frame index %d%s", 2 * n, halves, 2 * n + 1, discs) . drawn(n + 1)
do for [k = 0:frames - 1] {
    frame = sprintf("%s/frame_%d.tsv", folder, k)
    set title "{/:Italic t} = " . word(times, k + 1) . time_unit . (deep ? "   (pale: far along {/:Italic z})" : "") offset 0, -0.4
    eval "plot " . bar . legend . (layers ? drawn(0) : ", frame" . discs)
    print k + 1
}
unset output
