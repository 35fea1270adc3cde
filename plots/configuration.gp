# SPDX-License-Identifier: GPL-3.0-or-later
# Where the particles are in the last snapshot, seen along z: discs of their size, in the colour of
# their orientation, stiffness or type, and bonds of molecules as lines between them. In three dimensions
# there is a slab at the front, in which the colour fades with the distance.
# Reads configuration.tsv, whose comment tells how many rows are of each type, perhaps
# configuration_bonds.tsv: the rows of the two beads of each bond, and of used.json the box, an obstacle,
# and what the size of those without radii is.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

table = "configuration.tsv"
bonds = "configuration_bonds.tsv"
with_bonds = has(bonds)
angle = column_of(table, "orientation")
radius = column_of(table, "radius")
# Those that are not all alike are coloured by their stiffness, if they have no orientation.
stiffness = angle > 0 ? 0 : column_of(table, "stiffness")
if (stiffness > 0) {
    stats table using stiffness name "K" nooutput
    if (K_max == K_min) { stiffness = 0 }
}
rows = int(system("grep -cv '^#'" . from(table)))
box = system("awk '/\"box\":/ { gsub(/[^0-9.eE, -]/, \"\"); gsub(/,/, \" \"); print; exit }' used.json")
edge(n) = real(word(box, n))
# Of a reduced file with units: λ in nm, in which the axes are.
nm = real(system("awk '/\"units\":[ \t]*{/ { inside = 1 } inside && /\"system\":/ { named = 1 } \
    inside && /\"length\":/ { gsub(/[^0-9.eE+-]/, \"\", $2); nm = $2; inside = 0 } \
    END { print named ? 0 : nm + 0 }' used.json"))
axis(of) = nm > 0 ? "{/:Italic " . of . "} / nm" : axis_of(table, of, "{/:Italic " . of . "}", "{/:Italic " . of . "} / {/:Italic λ}")

# Radius and centre of an obstacle; 0 without one.
obstacle(n) = real(system(sprintf("awk '/\"obstacle_centre\":/ { sub(/.*\\[/, \"\"); split($0, centre, \",\") } \
    /\"obstacle_radius\":/ { gsub(/[^0-9.eE-]/, \"\", $2); radius = $2 } \
    END { print %d ? centre[%d] + 0 : radius + 0 }' used.json", n, n)))

# How many there are of each type, in the order of their rows, and their names: "large 10 small 20".
types = system("awk 'sub(/^# types: /, \"\") { gsub(/[^A-Za-z0-9_ ]/, \"\"); print; exit }'" . from(table))
mixed = words(types) > 0

# Hard particles without radii have 0.5; those that repel each other touch at the cutoff. Others are
# drawn as large as leaves most of the box free.
free = 0.35 * (edge(1) * edge(2) * (dimensions == 3 ? edge(3) : 1) / rows)**(1.0 / dimensions)
usual = real(system(sprintf("awk '/\"conservative\":/ { inside = 1; next } /}/ { inside = 0 } \
    /\"event-driven\"/ { radius = 0.5 } inside && /\"soft-repulsion\"/ { repels = 1 } \
    inside && repels && /\"cutoff\":/ { gsub(/[^0-9.eE-]/, \"\", $2); radius = $2 / 2 } \
    END { print radius ? radius : %g }' used.json", free)))

# The box and the rows of both tables, as the programs below need them. The nearest image counts.
both = sprintf("awk -v deep=%d -v X=%g -v Y=%g -v Z=%g ", dimensions == 3, edge(1), edge(2), dimensions == 3 ? edge(3) : 1)
places = "function near(d, edge) { return d - edge * int(d / edge + (d < 0 ? -0.5 : 0.5)) } \
    /^#/ { next } NR == FNR { row++; x[row] = $1; y[row] = $2; z[row] = deep ? $3 : 0 } "
tables = table . (with_bonds ? " " . bonds : "")
# Beads are small enough to see their bonds: a fifth of their mean length.
fifth = !with_bonds ? 1e300 : real(system(both . "'" . places . "NR > FNR { count++; \
    sum += sqrt(near(x[$2] - x[$1], X)^2 + near(y[$2] - y[$1], Y)^2 + near(z[$2] - z[$1], Z)^2) } \
    END { print sum / count / 5 }' " . tables))
size = low(usual, fifth)

# Behind what covers the box once nothing is to be seen: so deep is the slab, if the box is not shallower.
depth = dimensions == 3 ? edge(3) : 1
area = real(system(sprintf("awk '!/^#/ { r = %d ? $%d : %g; sum += 3.141592653589793 * r * r } END { print sum }'", radius, radius, size) . from(table)))
slab = dimensions == 3 ? low(depth, depth * edge(1) * edge(2) / area) : depth

# Layers from the bottom up, so that bonds are behind what is in front of them. Of one that lies in
# the part number `layer` of the depth:
# x, y, radius, and the orientation as a part of a turn or the number of the type; the highest last;
layers = with_bonds && dimensions == 3 ? 12 : 1
shades = sprintf("BEGIN { n = split(\"%s\", t, \" \"); for (k = 2; k <= n; k += 2) end[k / 2] = (total += t[k]) } \
    function here(z) { z -= %g; if (z < 0) return 0; k = int(%d * z / %g); return (k < %d ? k : %d) == layer } \
    NR == FNR { while (row > end[type + 1] && type + 1 < n / 2) type++; turn = %d ? $%d / 6.283185307179586 : 0; \
    shade[row] = %d ? turn - int(turn) + (turn < int(turn)) : %d ? $%d : type + 0 } ", types, depth - slab, layers, slab, layers, layers - 1, angle, angle, angle, stiffness, stiffness)
discs(layer) = "< " . both . sprintf("-v layer=%d '", layer) . places . shades . \
    sprintf("here(z[row]) { print $1, $2, %d ? $%d : %g, shade[row], z[row] }' ", radius, radius, size) . table . \
    (dimensions == 3 ? " | sort -s -g -k 5" : "")
# x, y and the way to the middle of the bond, the same shade, and the depth: half a bond from each bead.
halves(layer) = "< " . both . sprintf("-v layer=%d '", layer) . places . shades . \
    "function half(a, b, c) { c = near(z[b] - z[a], Z) / 2; \
    if (here(z[a] + c / 2)) print x[a], y[a], near(x[b] - x[a], X) / 2, near(y[b] - y[a], Y) / 2, shade[a], z[a] + c / 2 } \
    NR > FNR { half($1, $2); half($2, $1) }' " . tables . " | sort -s -g -k 6"
# Each once more before, white and a little larger, where there are few enough to see it.
outlined(layer) = discs(layer) . (rows <= 5000 ? " | awk '{ print $0, -1; print $0, 0 }'" : " | awk '{ print $0, 0 }'")
rim = 0.3
# Of what is behind the rest the colour is a sixth, of what is in front all of it.
strength(z) = dimensions == 3 ? (1 + 5 * low(1, high(0, 1 - (depth - z) / slab))) / 6 : 1
part(colour, shift, share) = int(255 - share * (255 - ((colour >> shift) & 255))) << shift
faded(colour, share) = part(colour, 16, share) + part(colour, 8, share) + part(colour, 0, share)
# Viridis (S. van der Walt and N. Smith, 2015), joined by straight lines, as films have it.
anchors = "#440154 #414487 #2a788e #22a884 #7ad151 #fde725"
channel(k, shift) = (int("0x" . substr(word(anchors, k), 2, 7)) >> shift) & 255
between(x, k, shift) = int(channel(k, shift) + (x - k + 1) * (channel(k + 1, shift) - channel(k, shift))) << shift
at_place(x) = between(x, int(low(4, x)) + 1, 16) + between(x, int(low(4, x)) + 1, 8) + between(x, int(low(4, x)) + 1, 0)
paint(shade) = angle > 0 ? hsv2rgb(shade, 0.75, 0.85) : stiffness > 0 ? at_place(5.0 * (shade - K_min) / (K_max - K_min)) : int("0x" . substr(colour_of(int(shade)), 2, 7))

# Pixels of the figure, of its margins and of a length of 1; circles as polygons would be large files.
left = 78
right = angle > 0 || stiffness > 0 ? 115 : mixed ? 120 : 24
top = 22
bottom = 74
across = 640
tall = high(180, low(1200, (across - left - right) * edge(2) / edge(1) + top + bottom))
scale = low((across - left - right) / edge(1), (tall - top - bottom) / edge(2))
# Discs at an edge of the box reach so far beyond it: the figure grows by that, the scale stays.
if (radius > 0) { stats table using radius name "RADIUS" nooutput } else { RADIUS_max = size }
beyond = low(RADIUS_max, low(edge(1), edge(2)) / 4)
across = ceil(across + 2 * beyond * scale)
tall = ceil(tall + 2 * beyond * scale)
# What pointsize makes a point of so many pixels' radius: measured.
pointsize_of(kind, pixels) = kind eq "svg" ? pixels / 4.875 : high(0.05, (2 * pixels - 1) / 6)

# The bonds and the beads of each layer.
drawn_halves(layer) = !with_bonds ? "" : sprintf(", halves(%d) using 1:2:3:4:(faded(paint($5), strength($6))) " . \
    "with vectors nohead linewidth %g linecolor rgb variable", layer, high(0.5, 0.9 * size * scale))
drawn_discs(layer) = sprintf(", outlined(%d) using 1:2:(pointsize_of(kind, $3 * scale - (1 + $6) * rim)):($6 < 0 ? 0xffffff : faded(paint($4), strength($5))) " . \
    "with points pointtype 7 pointsize variable linecolor rgb variable", layer)
drawn(layer) = layer == layers ? "" : drawn_halves(layer) . drawn_discs(layer) . drawn(layer + 1)

do for [kind in kinds] {
    eval open(kind, "configuration", across, tall)
    set lmargin at screen left / real(across)
    set rmargin at screen 1 - right / real(across)
    set bmargin at screen bottom / real(tall)
    set tmargin at screen 1 - top / real(tall)
    set size ratio -1
    set border 3
    unset grid
    set xrange [-beyond:edge(1) + beyond]
    set yrange [-beyond:edge(2) + beyond]
    # The box itself, as a frame.
    set object 1 rectangle from 0, 0 to edge(1), edge(2) front fillstyle empty border rgb ink linewidth 0.8
    if (obstacle(0) > 0) { set object 2 circle at obstacle(1), obstacle(2) size obstacle(0) behind fillstyle solid 1 border rgb ink fillcolor rgb 0xd9d9d9 }
    set xlabel axis("x") . (dimensions < 3 ? "" : slab < depth ? \
        sprintf("  (a slab of %.2g %s along {/:Italic z}; pale: its back)", nm > 0 ? nm * slab : slab, nm > 0 ? "nm" : "{/:Italic λ}") : "  (pale: far along {/:Italic z})")
    set ylabel axis("y")
    if (nm > 0) {
        step = step_of(low(edge(1), edge(2)) * nm / 3)
        set xtics ("0" 0)
        set ytics ("0" 0)
        do for [k = 1:int(edge(1) * nm / step)] { set xtics add (sprintf("%g", k * step) k * step / nm) }
        do for [k = 1:int(edge(2) * nm / step)] { set ytics add (sprintf("%g", k * step) k * step / nm) }
    }
    set palette model HSV functions gray, 0.75, 0.85
    set cbrange [0:1]
    set cbtics ("0" 0, "{/:Italic π}" 0.5, "2{/:Italic π}" 1)
    set cblabel "orientation"
    if (stiffness > 0) {
        set palette model RGB defined (0 word(anchors, 1), 1 word(anchors, 2), 2 word(anchors, 3), 3 word(anchors, 4), 4 word(anchors, 5), 5 word(anchors, 6))
        set cbrange [K_min:K_max]
        set cbtics autofreq
        set cblabel "stiffness" offset 1.2
    }
    set key on outside right top vertical Left reverse noautotitle
    if (angle > 0 || stiffness > 0) { set colorbox } else { unset colorbox }
    eval "plot NaN with points palette, " . \
        "for [k = 1:words(types) / 2] NaN with points pointtype 7 linecolor rgb colour_of(k - 1) title word(types, 2 * k - 1)" . \
        drawn(0)
    eval close
}
