# SPDX-License-Identifier: GPL-3.0-or-later
# One simulation: its radial distribution function, and how it came to equilibrium.
# Reads thermodynamics.tsv: step, time or sweeps, temperature, potential_energy, pressure,
# temperature_configurational, perhaps total_energy (nan where they were not measured or do not exist), perhaps the same in ps, kJ/mol, bar,
# and, if they are there, rdf.tsv or, in a mixture, rdf_A-A.tsv, rdf_A-B.tsv, …: r, g, g_error.

load system("printf %s \"$MESOFIT_PLOTS\"") . "/style.gp"

ps = factor_of("thermodynamics.tsv", "time[ps]", 2)
kJ = factor_of("thermodynamics.tsv", "potential_energy[kJ/mol]", 4)
bar = factor_of("thermodynamics.tsv", "pressure[bar]", 5)
# Columns without another in physical units are in them, too: k_B T_0 in kJ/mol tells T_0 in K.
K = kJ == 1 ? 1 : kJ / 8.31446261815324e-3
axis_T = kJ == 1 ? axis_of("thermodynamics.tsv", "temperature", "{/:Italic T}", "{/:Italic T} / {/:Italic T}_0") : "{/:Italic T} / K"
axis_E = kJ == 1 ? axis_of("thermodynamics.tsv", "total_energy", "{/:Italic E}", "{/:Italic E} / {/:Italic k}_B{/:Italic T}_0") : "{/:Italic E} / (kJ/mol)"
rdfs = system("ls | grep -E '^rdf(_[A-Za-z0-9_]+-[A-Za-z0-9_]+)?[.]tsv$'")
with_rdf = words(rdfs) > 0
nm = with_rdf ? factor_of(word(rdfs, 1), "r[nm]", 1) : 1
g_top = 0
g_far = 0
do for [file in rdfs] {
    stats file using (nm * $1) name "R" nooutput
    stats file using ($2 + known(3)) name "G" nooutput
    g_top = high(g_top, G_max)
    stats file using (nm * $1 > 0.5 * R_max ? $2 + known(3) : NaN) name "F" nooutput
    g_far = high(g_far, F_max)
}
# The pair type that a table is of: nothing, or A-B.
pair_of(file) = strlen(file) > 7 ? file[5:strlen(file) - 4] : ""
stats "thermodynamics.tsv" using (ps * $2) name "T" nooutput
stats "thermodynamics.tsv" using (K * (valid(6) ? (valid(3) ? low($3, $6) : $6) : valid(3) ? $3 : 0)) name "L" nooutput
stats "thermodynamics.tsv" using (K * (valid(6) ? (valid(3) ? high($3, $6) : $6) : valid(3) ? $3 : 0)) name "H" nooutput
stats "thermodynamics.tsv" using (kJ * $4) name "U" nooutput
stats "thermodynamics.tsv" using (bar * $5) name "P" nooutput
has_numbers(column) = int(system(sprintf( \
    "awk '!/^#/ && $%d ~ /[0-9]/ { found = 1 } END { print found + 0 }' thermodynamics.tsv", column)))
kinetic = has_numbers(3)
configurational = has_numbers(6)

total = column_of("thermodynamics.tsv", "total_energy")
panels = total > 0 ? 4 : 3
if (total > 0) { stats "thermodynamics.tsv" using (kJ * column(total)) name "V" nooutput }

# Numbers as 5.82·10⁸ want room.
largest = high(high(abs(L_min), abs(H_max)), high(high(abs(U_min), abs(U_max)), high(abs(P_min), abs(P_max))))
left = (with_rdf ? 0.61 : 0.16) + (largest < 1e5 ? 0 : 0.05)
label = with_rdf ? 0.512 : 0.03
# The legend of a mixture stands above the curves of the right half.
rows = words(rdfs) < 2 ? 0 : words(rdfs) < 6 ? words(rdfs) : 6
step_of_panels = panels == 4 ? 0.2066 : 0.275
ceiling(panel) = 0.93 - step_of_panels * panel
begin_panel(panel) = sprintf("set tmargin at screen %g; set bmargin at screen %g", \
    ceiling(panel), ceiling(panel) - step_of_panels + (panels == 4 ? 0.03 : 0.035))
# A value that never changes still gets a range.
pad(a, b) = b > a ? 0.06 * (b - a) : 0.1 + 0.1 * abs(a)
value_range(a, b) = sprintf("; set yrange [%.10g:%.10g]; set ytics %g", \
    a - pad(a, b), b + pad(a, b), step_of((b - a + 2 * pad(a, b)) / 2))

do for [kind in kinds] {
    eval open(kind, "simulation", with_rdf ? 980 : 560, panels == 4 ? 620 : 500)
    set multiplot
    if (with_rdf) {
        set lmargin at screen 0.085
        set rmargin at screen 0.485
        set tmargin at screen 0.93
        set bmargin at screen 0.14
        set xrange [0:above(0, R_max)]
        set xtics autofreq
        set ytics autofreq
        set yrange [0:g_top > 0 ? 1.08 * high(g_top, g_far / (1 - 0.075 * rows)) : 1]
        set format x "%h"
        set xlabel r_axis_of(word(rdfs, 1))
        eval name_axis(g_label, 0.014)
        set key on inside right top vertical maxrows 6 noautotitle
        plot for [i = 1:words(rdfs)] word(rdfs, i) using (nm * $1):($2 - $3):($2 + $3) \
                with filledcurves @band linecolor rgb colour_of(i - 1), \
            for [i = 1:words(rdfs)] word(rdfs, i) using (nm * $1):2 with lines title pair_of(word(rdfs, i)) \
                linewidth 2.2 linecolor rgb colour_of(i - 1)
    }
    set lmargin at screen left
    set rmargin at screen 0.975
    set xrange [T_min < T_max ? T_min : T_min - 1:T_max]
    if (T_min < T_max && T_max >= 1000) { set xtics step_of((T_max - T_min) / 2) } # sweeps are many
    set format x ""
    unset xlabel

    eval begin_panel(0) . value_range(L_min, H_max)
    eval name_axis(axis_T, label)
    set key on at graph 1, graph 1.22 right top vertical maxrows 1 noautotitle
    plot for [i = 1:kinetic] seen("thermodynamics.tsv", 3) using (ps * $2):(K * $3) with lines title "kinetic" \
            linewidth 1.2 linecolor rgb blue, \
        for [i = 1:configurational] seen("thermodynamics.tsv", 6) using (ps * $2):(K * $6) with points title "configurational" \
            pointtype 7 pointsize 0.5 linecolor rgb vermillion

    eval begin_panel(1) . value_range(U_min, U_max)
    eval name_axis(in_units("thermodynamics.tsv", "potential_energy[kJ/mol]", \
        "{/:Italic U} / (kJ/mol)", "{/:Italic U} / {/:Italic k}_B{/:Italic T}_0"), label)
    set key off
    plot seen("thermodynamics.tsv", 4) using (ps * $2):(kJ * $4) with lines linewidth 1.2 linecolor rgb green

    if (total > 0) {
        eval begin_panel(2) . value_range(V_min, V_max)
        eval name_axis(axis_E, label)
        plot seen("thermodynamics.tsv", total) using (ps * $2):(kJ * column(total)) with lines linewidth 1.2 linecolor rgb ink
    }

    eval begin_panel(panels - 1) . value_range(P_min, P_max)
    eval name_axis(in_units("thermodynamics.tsv", "pressure[bar]", \
        "{/:Italic p} / bar", sprintf("{/:Italic p λ}^%d / {/:Italic k}_B{/:Italic T}_0", dimensions)), label)
    set format x "%h"
    set xlabel t_axis_of("thermodynamics.tsv")
    plot seen("thermodynamics.tsv", 5) using (ps * $2):(bar * $5) with lines linewidth 1.2 linecolor rgb purple
    unset multiplot
    eval close
}
