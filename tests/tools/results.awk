# SPDX-License-Identifier: GPL-3.0-or-later
# Rows of a table, "| name | value(error) |", of the numbers `wanted` of a summary.json; a number of the
# summary itself before one of the same name within it, as the unit "pressure".
function digits(value, error,   power) {
    if (!(error > 0))
        return sprintf(value == int(value) ? "%.0f" : "%.3g", value)
    power = int(log(error) / log(10)) - (log(error) < 0)
    if (error / 10 ^ power < 1.95)
        power--
    if (power >= 0)
        return sprintf("%.0f(%.0f)", value, error)
    return sprintf("%.*f(%.0f)", -power, value, error / 10 ^ power)
}
match($0, /"[a-z_0-9]+":/) {
    key = substr($0, RSTART + 1, RLENGTH - 3)
    text = substr($0, RSTART + RLENGTH)
    gsub(/[ \t,"]/, "", text)
    if (!(key in number) || /^\t"/)
        number[key] = text
}
END {
    count = split(wanted, name, " ")
    for (k = 1; k <= count; k++)
        printf "| `%s` | %s |\n", name[k], !(name[k] in number) ? "–" : number[name[k]] ~ /^-?[0-9]/ ? digits(number[name[k]] + 0, number[name[k] "_error"] + 0) : number[name[k]]
}
