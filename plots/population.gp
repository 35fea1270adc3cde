# SPDX-License-Identifier: GPL-3.0-or-later
# The potentials of the last generation, and what was found among and by them.
# Reads population_potential.tsv, which MESOFIT_TABLE names: r, then one column a candidate, the best
# first; and potential.tsv: r, phi, force, phi_error, perhaps r[nm], phi[kJ/mol]. Of a mixture those of
# one pair type.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

all = table
table = "./" . all[strlen("./population_") + 1:strlen(all)]
columns = int(system("awk -F '\t' '/^# *r/ { print NF; exit }'" . from(all)))
nm = factor_of(table, "r[nm]", 1)
kJ = factor_of(table, "phi[kJ/mol]", 2)
phi_axis = in_units(table, "phi[kJ/mol]", phi_name . " / (kJ/mol)", phi_label)

# The candidates may go a little beyond the result.
stats table using 1 name "R" nooutput
view = potential_view(table, 4)
top = real(word(view, 1))
begin = real(word(view, 2))
bottom = low(0, real(word(view, 3)))
lowest = 2 * bottom - 0.3 * top
do for [k = 2:columns] {
    stats all using k name "H" nooutput
    bottom = low(bottom, high(lowest, H_min))
}
bottom = bottom - 0.06 * (top - bottom)

do for [kind in kinds] {
    eval open(kind, figure, 720, 480)
    set lmargin at screen 0.13
    set rmargin at screen 0.97
    set tmargin at screen part eq "" ? 0.97 : 0.91
    eval part_title(0.955)
    set bmargin at screen 0.14
    set xrange [nm * begin:above(nm * begin, nm * R_max)]
    set yrange [kJ * bottom:kJ * top]
    set xlabel r_axis_of(table)
    eval name_axis(phi_axis, 0.024)
    set key at graph 0.985, graph 0.97 right top
    plot for [k = columns:2:-1] all using ($1 * nm):(column(k) * kJ) with lines \
            linewidth 0.8 linecolor rgb sky title (k == 2 ? "last generation" : ""), \
        table using ($1 * nm):($2 * kJ) with lines linewidth 2.6 linecolor rgb blue \
            title "found"
    eval close
}
