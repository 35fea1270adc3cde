# SPDX-License-Identifier: GPL-3.0-or-later
#
# One row of table.tsv from lines "key value" of one fit.

{
    key = $1
    sub(/^[^ ]* */, "")
    value[key] = $0
}

function number(key) { return value[key] ~ /^-?[0-9]/ ? value[key] + 0 : "nan" }

function ratio(key, of) {
    return number(key) == "nan" || number(of) == "nan" || number(of) == 0 ? "nan" : sprintf("%.3g", value[key] / value[of])
}

# Percent by which a temperature is above that of the scene, or its error.
function percent(key, less) {
    return number(key) == "nan" ? "nan" : sprintf("%.3g", 100 * (value[key] / value["wanted"] - less))
}

function text(key, format) { return number(key) == "nan" ? "nan" : sprintf(format, value[key]) }

# How far the pressure is from the true one, in what is left open and the errors of both.
function openings(    missing) {
    if (number("pressure") == "nan" || number("true_pressure") == "nan")
        return "nan"
    missing = value["pressure"] - value["true_pressure"]
    return sprintf("%.2f", missing / sqrt(value["pressure_left_open"] ^ 2 + value["pressure_error"] ^ 2 + value["true_pressure_error"] ^ 2))
}

function status() {
    if (value["code"] == 2 || value["code"] == 3)
        return "refused"
    # Ended by the limit of processor time, which the system says by a signal.
    if (value["code"] > 128)
        return value["code"] == 152 ? "timeout" : "crashed"
    return "status" in value ? value["status"] : "crashed"
}

END {
    iterations = number("iterations") == "nan" ? number("passed") : number("iterations")
    printf "%s\t%s\t%s\t%.0f\t%.0f", name, status(), iterations, value["wall"], value["processor"]
    printf "\t%s\t%s\t%s\t%s", ratio("rdf_rmse", "rdf_noise"), ratio("bond_lengths_rmse", "bond_lengths_noise"),
        ratio("bond_angles_rmse", "bond_angles_noise"), ratio("dihedral_angles_rmse", "dihedral_angles_noise")
    printf "\t%s\t%s\t%s\t%s", percent("temperature", 1), percent("temperature_error", 0),
        percent("temperature_configurational", 1), percent("temperature_configurational_error", 0)
    printf "\t%s\t%s\t%s", text("pressure", "%.5g"), text("pressure_error", "%.2g"), text("pressure_left_open", "%.2g")
    printf "\t%s", openings()
    printf "\t%s\t%s\t%s", number("z"), number("z_without_way"), number("z_bonded")
    printf "\t%s\t%s\t%s\t%s\n", ratio("rdf_rmse_error", "rdf_noise"), ratio("bond_lengths_rmse_error", "bond_lengths_noise"),
        ratio("bond_angles_rmse_error", "bond_angles_noise"), ratio("dihedral_angles_rmse_error", "dihedral_angles_noise")
}
