# SPDX-License-Identifier: GPL-3.0-or-later
# What all figures share: terminals, fonts, colours, grid, axes and the texts beside them.

set encoding utf8
set minussign

# What the program tells: the table, where a script draws one of several, and what the figure is to be
# called. A name that begins with < or | would be a command.
table = "./" . system("printf %s \"$MESOFIT_TABLE\"")
figure = system("printf %s \"$MESOFIT_FIGURE\"")
# While a figure is drawn, its file's name ends so.
partial = system("printf %s \"$MESOFIT_PARTIAL\"")

# A figure is drawn once for each kind, between eval open(…) and eval close: its file is
# figures/<name>.<kind>, width and height count pixels of the SVG. The PNG has twice as many, for
# print.
kinds = "svg png"
svg(width, height) = sprintf("set terminal svg size %d,%d font 'Helvetica,13' " . \
    "background '#ffffff' round; ", width, height)
png(width, height) = sprintf("set terminal pngcairo size %d,%d font 'Liberation Sans,13' " . \
    "fontscale 2 linewidth 2 pointscale 2 background '#ffffff' rounded; ", 2 * width, 2 * height)
# The name stays in a variable: as a part of the command it could be one itself.
open(kind, name, width, height) = (figure_file = sprintf("figures/%s.%s", name, kind) . partial, \
    (kind eq "svg" ? svg(width, height) : png(width, height)) . "set output figure_file")
close = "set output"

# Colours that stay apart for every common form of colour blindness, after M. Okabe and K. Ito,
# Color Universal Design (2008), without their yellow, which is too light for lines.
ink        = "#222222"
faint      = "#8a8a8a"
blue       = "#0072b2"
vermillion = "#d55e00"
green      = "#009e73"
purple     = "#aa4499"
orange     = "#e69f00"
sky        = "#56b4e9"
colour_of(i) = word("#0072b2 #d55e00 #009e73 #aa4499 #e69f00 #56b4e9 #882255 #7a7a1f", i % 8 + 1)
band = "fillstyle transparent solid 0.22"
true_line = "linewidth 1.8 dashtype 2 linecolor rgb ink"

set format "%h"
set border 3 linewidth 0.8 linecolor rgb ink
set tics nomirror out scale 0.6
set grid xtics ytics linetype 1 linewidth 0.5 linecolor rgb "#e4e4e4"
set key noautotitle noenhanced samplen 2.2 spacing 1.25 textcolor rgb ink
set style fill solid noborder

# The pair of types, or the group, of which a figure is one of several, as "A-B" of "rdf_A-B": symbols
# have it as an index, with a blank for _, and the figure as its title, by eval part_title(height of its
# middle). Nothing where there is one alone.
part = system("printf %s \"$MESOFIT_FIGURE\" | sed -nE 's/^((intermolecular_)?rdf|potential|population|bond_lengths|bond_angles|dihedral_angles|bonds|angles|dihedrals|many_body)_([A-Za-z0-9_-]+)$/\\3/p'")
index_of_part = part eq "" ? "" : "_{" . system("printf %s '" . part . "' | tr _ ' '") . "}"
part_title(y) = part eq "" ? "" : sprintf("set label 3 part at graph 0, screen %g left noenhanced font ',16'", y)

r_label   = "{/:Italic r} / {/:Italic λ}"
g_label   = "{/:Italic g}" . index_of_part . "({/:Italic r})"
phi_name  = "{/:Italic Φ}" . index_of_part . "({/:Italic r})"
phi_label = phi_name . " / {/:Italic k}_B{/:Italic T}"
omega_label = "{/:Italic ω}({/:Italic r}) / ({/:Italic μ}/{/:Italic τ})^{1/2}"
t_label   = "{/:Italic t} / {/:Italic τ}"
E_label   = "{/:Italic E}({/:Italic t}, {/:Italic r}_0)"

# "set key on" forgets noautotitle, so it says so again wherever it stands.

# Command that names the vertical axis of a panel, x from the figure's edge: the names of all
# panels stand in one line.
name_axis(text, x) = (axis_name = text, \
    sprintf("set label 1 axis_name at screen %g, graph 0.5 center rotate", x))

low(a, b)  = a < b ? a : b
high(a, b) = a > b ? a : b

# Columns that may hold nan, which makes every expression around it undefined, or inf, of candidates
# that failed: 0 where the number is not known, and, for the lower end of a logarithmic axis, the
# numbers that it can show.
known(n) = valid(n) ? (abs(column(n)) < 1e300 ? column(n) : 0) : 0
positive(n) = known(n) > 0 ? column(n) : 1e300

# Ends of the 95 % band of column n with the standard errors of column m; nan where not known.
band_low(n, m)  = column(n) - 1.96 * column(m)
band_high(n, m) = column(n) + 1.96 * column(m)

# Ends of the band that a figure has room for: whole, but where it is wider than `most` to a side the
# data say nothing, and it would squeeze the curve into a line; there it may leave the figure.
shown_error(m, most)   = 1.96 * known(m) > most ? 0 : 1.96 * known(m)
shown_low(n, m, most)  = column(n) - shown_error(m, most)
shown_high(n, m, most) = column(n) + shown_error(m, most)

# Input of a command from a file, whatever its name: quoted, with each ' as '\\''.
escape(text) = strstrt(text, "'") == 0 ? text : \
    text[1:strstrt(text, "'") - 1] . "'\\''" . escape(text[strstrt(text, "'") + 1:strlen(text)])
from(file) = " < '" . escape(file) . "'"

# 1 if a file is there.
has(file) = int(system("test -r '" . escape(file) . "' && echo 1 || echo 0"))

# Number of the first column of that name, 0 if there is none; 1 if a column has a number but 0.
column_of(file, name) = !has(file) ? 0 : int(system(sprintf("awk -F '\t' '/^#/ && NF > 1 { sub(/^# */, \"\"); \
    for (k = 1; k <= NF; k++) { sub(/\\[.*/, \"\", $k); if ($k == \"%s\" && !found) found = k } } \
    END { print found + 0 }'", name) . from(file)))
has_numbers(file, column) = !has(file) ? 0 : int(system(sprintf("awk -F '\t' '!/^#/ && $%d ~ /[1-9]/ { found = 1 } \
    END { print found + 0 }'", column) . from(file)))

# What one of the column called `name`, with a physical unit as in "r[nm]", is in units of column n;
# 1 where the table has no such column. in_units(…) chooses the axis's text by the same.
factor_of(file, name, n) = real(system(sprintf("awk -F '\t' '/^#/ && NF > 1 { sub(/^# */, \"\"); \
    for (k = 1; k <= NF; k++) if ($k == \"%s\") found = k; next } \
    found && $%d + 0 != 0 { factor = $found / $%d } \
    END { printf \"%%.10g\", factor ? factor : 1 }'", name, n, n) . from(file)))
# Where the first column of that name is itself in another physical unit, as "r[angstrom]", the axis
# has that one.
in_units(file, name, physical, reduced) = system(sprintf("awk -F '\t' -v name='%s' -v physical='%s' -v reduced='%s' '\
    BEGIN { label = reduced; split(name, wanted, \"[\") } \
    /^#/ && NF > 1 { sub(/^# */, \"\"); for (k = 1; k <= NF; k++) { \
        if ($k == name) { label = physical; exit } \
        split($k, own, \"[\"); \
        if (own[1] == wanted[1] && own[2] && !seen++) { spoken = own[2]; sub(/\\]$/, \"\", spoken) } } } \
    END { if (label == reduced && spoken && spoken !~ /^1$|lambda|tau|k_B|T_0|mu/) { \
            gsub(/angstrom/, \"Å\", spoken); gsub(/\\./, \" \", spoken); \
            half = sub(/^sqrt/, \"\", spoken) ? \"^{1/2}\" : \"\"; \
            if (!half && spoken ~ /\\//) spoken = \"(\" spoken \")\"; \
            label = physical; sub(/ \\/ .*/, \" / \" spoken half, label) } \
        print label }'", name, physical, reduced) . from(file))
# The same of a column that is in physical units only if the file is.
axis_of(file, name, symbol, reduced) = in_units(file, name . "[]", symbol . " / ", reduced)
r_axis_of(file) = in_units(file, "r[nm]", "{/:Italic r} / nm", r_label)
t_axis_of(file) = in_units(file, "sweeps[1]", "sweeps", in_units(file, "time[ps]", "{/:Italic t} / ps", t_label))

# What a figure shows of a table with a row for each time: all of it, or, of a long one, as many groups
# of rows as the axis has pixels, each by its first row and those where column n is lowest and highest. A
# line through them covers the same pixels as one through all rows.
groups_of_rows = 1000
rows_of(file) = int(system("grep -vc '^#' " . from(file) . " || true"))
seen(file, n) = rows_of(file) <= 4 * groups_of_rows ? file : \
    "< awk -v n=" . n . " -v each=" . (rows_of(file) / groups_of_rows + 1) . " '\
    function show() { if (count == 0) return; print first; if (!known) return; \
        if (lowest <= highest) { print low; print high } else { print high; print low } } \
    /^#/ { next } \
    count % each == 0 { show(); first = $0; known = 0 } \
    { count++ } \
    $n ~ /[0-9]/ { v = $n + 0; if (!known || v < least) { least = v; low = $0; lowest = count } \
        if (!known || v > most) { most = v; high = $0; highest = count } known = 1 } \
    END { show() }'" . from(file)

# The unit of column n as a text, "nm^{-1}" for "1/nm", or "" where there is none.
unit_of(file, n) = system(sprintf("awk -F '\t' '/^#/ && NF > 1 { h = $%d; if (!sub(/^[^[]*\\[/, \"\", h)) h = \"1]\"; sub(/\\].*/, \"\", h); \
    if (h == \"1\") h = \"\"; if (sub(/^1\\//, \"\", h)) h = h \"^{-1}\"; gsub(/angstrom/, \"Å\", h); \
    if (h ~ /\\//) h = \"(\" h \")\"; sub(/\\^d/, \"^%d\", h); gsub(/k_B[.]T_0/, \"{/:Italic k}_B{/:Italic T}_0\", h); \
    gsub(/lambda/, \"{/:Italic λ}\", h); gsub(/tau/, \"{/:Italic τ}\", h); print h; exit }'", n, dimensions) . from(file))
per_unit(symbol, file, n) = unit_of(file, n) eq "" ? symbol : symbol . " / " . unit_of(file, n)
# How the first column of a molecule's table is called.
symbol_of(first) = first eq "theta" ? "{/:Italic θ}" : first eq "phi" ? "{/:Italic φ}" : first eq "time" ? "{/:Italic t}" : first eq "rho" ? "{/:Italic ρ}" : "{/:Italic r}"
# The first word of a table's heads, without its unit.
first_of(file) = system("awk -F '\t' '/^#/ && NF > 1 { sub(/^# */, \"\"); sub(/\\[.*/, \"\", $1); print $1; exit }'" . from(file))

# Dimensions of the scene whose results these are.
dimensions = has("used.json") && int(system("grep -c '\"dimensions\":.*2' used.json || true")) ? 2 : 3

# What a target is called, and the unit of its error.
target_label(target) = target eq "rdf" ? "{/:Italic g}" : target eq "etd" ? "{/:Italic E}" : \
    target eq "vacf" ? "VACF" : target eq "msd" ? "MSD" : \
    target eq "diffusion" ? "{/:Italic D}" : target eq "pressure" ? "{/:Italic p}" : \
    target eq "density" ? "{/:Italic ρ}" : target
target_unit(target) = target eq "vacf" ? " / ({/:Italic λ}^2/{/:Italic τ}^2)" : \
    target eq "msd" ? " / {/:Italic λ}^2" : target eq "diffusion" ? " / ({/:Italic λ}^2/{/:Italic τ})" : \
    target eq "pressure" ? sprintf(" / ({/:Italic k}_B{/:Italic T}_0/{/:Italic λ}^%d)", dimensions) : \
    target eq "density" ? sprintf(" {/:Italic λ}^%d", dimensions) : ""
rmse_of(target) = "rmse of " . target_label(target) . target_unit(target)

# What the column "error" of a fit is, from the targets that used.json says are fitted.
fitted = !has("used.json") ? "" : system("awk '/\"[a-z_]+\":[ \t]*\\{/ { \
    split($0, part, /\"/); kind = part[2] } /\"fitted\":.*\"yes\"/ && !seen[kind]++ { printf \" %s\", kind }' used.json")
error_label = words(fitted) > 1 ? "weighted error" : \
    rmse_of(words(fitted) == 1 ? word(fitted, 1) : "rdf")

# The largest of 1, 2 or 5 times a power of ten that is not above x: a distance of tics.
power(x) = 10**floor(log10(x))
step_of(x) = x <= 0 ? 1 : power(x) * (x >= 5 * power(x) ? 5 : x >= 2 * power(x) ? 2 : 1)

# End of an axis from 0 to x, with a little room.
end_of(x) = x > 0 ? 1.04 * x : 1

# End of an axis from a to b, which may be one value alone: no axis is empty.
above(a, b) = b > a ? b : a + (a == 0 ? 1 : 0.1 * abs(a))

# Commands for a logarithmic axis with a little room around the values a to b, labelled at 1, 2 and
# 5 times the powers of ten, or at the powers only when there are many.
decade(p, many) = many ? sprintf("%g, ", p) : sprintf("%g, %g, %g, ", p, 2 * p, 5 * p)
decades(p, b, many) = p > b ? "" : decade(p, many) . decades(10 * p, b, many)
log_tics(axis, a, b) = sprintf("set %stics (%s%g)", axis, \
    decades(power(a), b, log10(b / a) > 2.2), 10**ceil(log10(b)))
log_axis(axis, a, b) = sprintf("set logscale %s; set %srange [%g:%g]; ", axis, axis, a, b) . \
    log_tics(axis, a, b)
# Where none of these is near, the end itself is labelled.
log_range(axis, a, b) = a > b ? log_axis(axis, 0.1, 1) : log_axis(axis, a / 1.4, b * 1.4) . \
    (step_of(1.4 * b) < a / 1.4 ? sprintf("; set %stics (%g)", axis, a) : "")

# k_B T_0 in the units of column 2 of a potential's table, by the temperature at the top of used.json.
energy_of(file) = real(system("awk -F '\t' '/^#/ && NF > 1 && !k { k = $2 ~ /kcal/ ? 0.0019872 : $2 ~ /kJ/ ? 0.0083145 : 0 } \
    END { print k + 0 }'" . \
    from(file)))
kelvins = !has("used.json") ? 300 : real(system("awk -F '[:,]' '/\"temperature\":/ && !T { T = $2 } END { print T + 0 }' used.json"))
thermal_energy(file) = energy_of(file) > 0 ? energy_of(file) * high(1, kelvins) : 1

# Where a potential's axes begin and end: "top begin lowest" in the table's own units, of all blocks
# of a file with r and Φ in columns 1 and 2 and Φ's errors in column `errors`. A soft core, up to
# 20 k_B T_0, is shown whole. A core that no particle enters would squeeze everything else into a line:
# it is cut off above the highest barrier behind it, and at three depths of the well; but not so low
# that less than 85 % of the way from 20 k_B T_0 to the cutoff were to be seen. Above a flat one there
# is room for k_B T_0.
potential_view(file, errors) = system(sprintf("awk -v e=%d -v u=%g -v n=0 '\
    function high(a, b) { return a > b ? a : b } function low(a, b) { return a < b ? a : b } \
    /^#/ || NF < 2 || $2 !~ /[0-9]/ { next } \
    { r[n] = $1 + 0; p[n] = $2 + 0 } \
    n == 0 { end = r[0]; lowest = p[0]; highest = p[0] } \
    n == 0 || r[n] <= r[n - 1] { entered = 0; inside = 0 } \
    { end = high(end, r[n]); lowest = low(lowest, p[n]); highest = high(highest, p[n]) } \
    p[n] <= 20 * u { \
        if (!entered && (!known || r[n] < core)) { core = r[n]; known = 1 } \
        least = entered ? low(least, p[n]) : p[n]; entered = 1; \
        margin = $e ~ /[0-9]/ ? low(1.96 * $e, 0.5 * p[n]) : 0; \
        if (p[n] > 0 && p[n] - least > 0.1 * p[n]) barrier = high(barrier, p[n] + margin) } \
    { n++ } \
    END { \
        top = highest; begin = 0; \
        if (highest > 20 * u) { \
            top = high(high(u, 1.1 * barrier), low(4 * u, -3 * lowest)); \
            limit = core + 0.15 * (end - core); \
            for (k = 1; k < n; k++) if (r[k] >= limit && r[k - 1] < limit) top = high(top, p[k]); \
            top = low(top, 20 * u); begin = end; \
            for (k = 0; k < n; k++) if (p[k] < top) begin = low(begin, r[k]); \
            begin = high(0, begin - 0.05 * (end - begin)) } \
        if (top <= lowest) top = lowest + u; \
        print top, begin, lowest }'", errors, thermal_energy(file)) . from(file))
