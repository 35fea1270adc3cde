# SPDX-License-Identifier: GPL-3.0-or-later
# Which time step goes with which friction and with which stiffness, a panel an integrator: how far the
# temperature that is farther off is from where it should be, or without friction how much the energy
# scatters, over k_B T; grey beyond the thick line, where runs end as unstable.
# Reads the table that MESOFIT_TABLE names, a block a map and integrator: map, integrator, row, column,
# strength, time_step, …, off (11), unstable (12). Draws figures/MESOFIT_FIGURE.svg and .png.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

set datafile separator tab
names = system("awk -F '\t' '!/^#/ && NF > 1 && !seen[$2]++ { gsub(/ /, \"~\", $2); print $2 }' < \"$MESOFIT_TABLE\"")
kinds_of_map = system("awk -F '\t' '!/^#/ && NF > 1 && !seen[$1]++ { print $1 }' < \"$MESOFIT_TABLE\"")
steps = system("awk -F '\t' '!/^#/ && NF > 1 && !seen[$4]++ { print $6 }' < \"$MESOFIT_TABLE\"")
strengths(map) = system("awk -F '\t' '$1 == \"" . map . "\" && !seen[$3]++ { printf ($5 >= 10 ? \"%.0f\\n\" : \"%.2g\\n\"), $5 }' < \"$MESOFIT_TABLE\"")
# Of potentials "× 4".
times(map) = system("echo '" . strengths(map) . "' | sed 's/^/×/'")
N = words(names)
M = words(kinds_of_map)
rows = words(strengths(word(kinds_of_map, 1)))
columns = words(steps)

# The line between what ends and what is unstable, from row to row: x of the first unstable column.
line_of(block) = sprintf("< awk -F '\t' -v wanted=%d 'NF < 2 && !/^#/ { blank++ } /^#/ { next } NF > 1 { if (blank > 1) block++; blank = 0; \
    if (block == wanted) { if (!($3 in first)) { first[$3] = %d; n++ } if ($12 == 1 && $4 < first[$3]) first[$3] = $4 } } \
    END { for (r = 0; r < n; r++) print first[r] - 0.5 \"\t\" r - 0.5 \"\\n\" first[r] - 0.5 \"\t\" r + 0.5 }'", block, columns) . " < \"$MESOFIT_TABLE\""

pixels = 150
left = 84
right = 108
top = 34
panel = 175
bottom = 66
across = left + N * pixels + (N - 1) * 8 + right
tall = top + M * panel + (M - 1) * 20 + bottom
tic_text(list, every, offset) = system(sprintf("echo '%s' | awk '{ gsub(/\\n/, \" \"); for (k = 1; k <= NF; k++) if ((k - 1 - %d) %% %d == 0) printf \"%%s\\\"%%s\\\" %%d\", n++ ? \", \" : \"\", $k, k - 1 }' RS=''", list, offset, every))

do for [kind in kinds] {
    eval open(kind, figure, across, tall)
    set multiplot
    set palette defined (0 "#f3f7fb", 1 "#cfe3f2", 2 "#fde9a9", 3 "#f5a24c", 4 "#d55e00", 5 "#7a1f00")
    set cbrange [-2:0]
    set cbtics ("≤ 1 %%" -2, "3 %%" -1.5, "10 %%" -1, "30 %%" -0.5, "≥ 100 %%" 0)
    set xrange [-0.5:columns - 0.5]
    set yrange [-0.5:rows - 0.5]
    unset grid
    set border 15 linewidth 0.8
    do for [m = 1:M] {
        map = word(kinds_of_map, m)
        do for [i = 1:N] {
            x = left + (i - 1) * (pixels + 8)
            set lmargin at screen x / real(across)
            set rmargin at screen (x + pixels) / real(across)
            set tmargin at screen 1 - (top + (m - 1) * (panel + 20)) / real(tall)
            set bmargin at screen 1 - (top + (m - 1) * (panel + 20) + panel) / real(tall)
            set title (m == 1 ? system("echo '" . word(names, i) . "' | tr '~' ' '") : "") font ",11" offset 0, -0.6
            unset xlabel
            if (m == M) { eval "set xtics (" . tic_text(steps, 2, 1) . ") rotate by 90 right font ',10'" } else { set xtics ("" 0) scale 0 }
            if (i == 1) { eval "set ytics (" . tic_text(map eq "friction" ? strengths(map) : times(map), 1, 0) . ") font ',10'" } else { set ytics ("" 0) scale 0 }
            unset label
            if (i == 1) { set label 1 (map eq "friction" ? "friction {/:Italic ω}^2 / ({/:Italic μ}/{/:Italic τ})" : "potential, times its own") at screen 16.0 / across, graph 0.5 center rotate }
            if (m == M && i == 1) { set label 2 "time step / {/:Italic τ}" at screen (left + N * (pixels + 8) / 2.0) / across, screen 14.0 / tall center }
            if (m == 1 && i == N) { set colorbox user origin 1 - 96.0 / across, 0.3 size 14.0 / across, 0.5 } else { unset colorbox }
            if (m == 1 && i == N) { set label 3 "off by" at screen 1 - 98.0 / across, screen 0.9 font ",10" }
            if (m == 1 && i == N) { set label 4 "unstable" at screen 1 - 98.0 / across, screen 0.18 font ",10"; set object 1 rectangle from screen 1 - 98.0 / across, screen 0.12 to screen 1 - 74.0 / across, screen 0.155 fillcolor rgb "#9a9a9a" fillstyle solid border rgb ink } else { unset object 1 }
            block = (m - 1) * N + i - 1
            plot table index block using 4:3:(0.5):(0.5):($12 == 1 ? NaN : high(-2, low(0, log10($11 + 1e-9)))) \
                    with boxxyerror linecolor palette fillstyle solid noborder, \
                table index block using ($12 == 1 ? $4 : NaN):3:(0.5):(0.5) \
                    with boxxyerror linecolor rgb "#9a9a9a" fillstyle solid noborder, \
                line_of(block) using 1:2 with lines linewidth 2.5 linecolor rgb ink
        }
    }
    unset multiplot
    eval close
}
