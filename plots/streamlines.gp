# SPDX-License-Identifier: GPL-3.0-or-later
# The obstacle and the streamlines of flow_field.tsv, for the figures of a flow: $streamlines, on which the
# stream function is the same, outside the obstacle. Before: width, nx, `lines` and the stats S of column 7.

# Centre and radius of the obstacle; all 0: there is none.
obstacle = system("awk '/\"obstacle_centre\":/ { sub(/.*:/, \"\"); gsub(/[^0-9.eE, -]/, \"\"); split($0, c, \",\") } \
    /\"obstacle_radius\":/ { gsub(/[^0-9.eE-]/, \"\", $2); r = $2 } \
    END { print c[1] + 0, c[2] + 0, r + 0 }' used.json")
centre_x = real(word(obstacle, 1))
centre_y = real(word(obstacle, 2))
radius = real(word(obstacle, 3))
turn(x) = x - width * floor(x / width + 0.5)
is_fluid(x, y) = turn(x - centre_x)**2 + (y - centre_y)**2 > radius**2

set table $streamlines
set contour base
unset surface
# Not at the middle, where flow that an obstacle halves is at rest behind it.
spacing = S_max > S_min ? (S_max - S_min) / lines : 1
set cntrparam levels incremental S_min + 0.5 * spacing, spacing, S_max
set cntrparam bspline
set cntrparam points 4
splot "< awk -v n=" . nx . " '{ if (!/^#/) { print; if (++k % n == 0) print \"\" } }' flow_field.tsv" \
    using 1:2:($5 > 0 && is_fluid($1, $2) ? $7 : NaN) with lines
unset table
unset contour
set surface
