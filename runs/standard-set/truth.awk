# SPDX-License-Identifier: GPL-3.0-or-later
#
# How far the found potentials of one system are from the known laws of its truth.json, in their stated standard
# errors. Prints "z N", the rms over all bins of pairs that have an error; "z_without_way N", the same without the
# ramp A (1 - r/r_c), A by least squares and common to all pair types, in the errors that hold if A is known; and
# "z_bonded N" of bonds, angles and dihedrals, each less its mean.
#
# awk -v member=NAME -f truth.awk potential*.tsv bonds_*.tsv angles_*.tsv dihedrals_*.tsv

function lennard_jones(r, epsilon, sigma) { return 4 * epsilon * ((sigma / r) ^ 12 - (sigma / r) ^ 6) }

function repulsive(r, sigma) { return r < 1.122462048 * sigma ? lennard_jones(r, 1, sigma) + 1 : 0 }

# Cut and shifted; the laws of truth.json.
function law(pair, r) {
    if (member ~ /^gaussian-core/)
        return r < 1.6 ? 3 * exp(-(r / 0.8) ^ 2) - 3 * exp(-4) : 0
    if (member == "wca" || member == "two-dimensions-wca")
        return repulsive(r, 1)
    if (member == "yukawa")
        return r < 4 ? 10 * exp(-2 * (r - 1)) / r - 10 * exp(-6) / 4 : 0
    if (member ~ /^two-dimensions-shoulder/)
        return r < 3 ? 1 / r ^ 14 + 1 / (1 + exp(20 * (r - 2.5))) - 1 / 3 ^ 14 - 1 / (1 + exp(10)) : 0
    if (member == "argon")
        return r < 8.5125 ? lennard_jones(r, 0.238065, 3.405) - lennard_jones(8.5125, 0.238065, 3.405) : 0
    if (member == "polymer-solvent")
        return r < 1 ? (pair == "S-P" ? 22 : 25) / 2 * (1 - r) ^ 2 : 0
    if (member == "mixture-sizes-repulsive")
        return repulsive(r, pair == "A-A" ? 1 : pair == "A-B" ? 1.3 : 1.6)
    if (member == "kremer-grest" || member == "ring-melt")
        return repulsive(r, 1)
    if (member ~ /^shoulder/)
        return r < 2.5 ? 1 / r ^ 14 + 1 / (1 + exp(20 * (r - 1.35))) - 1 / 2.5 ^ 14 - 1 / (1 + exp(23)) : 0
    if (member == "hertzian")
        return r < 1 ? 50 * (1 - r) ^ 2.5 : 0
    if (member == "star-polymer")
        return r < 4 ? star_polymer(r) - star_polymer(4) : 0
    if (member == "double-well")
        return r < 2.5 ? hilly(r) - hilly(2.5) : 0
    return r < 2.5 ? mixed(pair, r) - mixed(pair, 2.5) : 0
}

function hilly(r) { return lennard_jones(r, 1, 1) + exp(-((r - 1.5) / 0.2) ^ 2) }

# Of ten arms: f = 10.
function star_polymer(r,    h) {
    h = sqrt(10) / 2
    return 5 / 18 * 10 ^ 1.5 * (r < 1 ? 1 / (1 + h) - log(r) : exp(-h * (r - 1)) / (1 + h) / r)
}

function mixed(pair, r) {
    if (member == "mixture-solute" && pair == "A-B")
        return lennard_jones(r, 1.2, 1.2)
    if (member == "mixture-dilute") {
        if (pair == "A-B") return lennard_jones(r, 1.2, 0.95)
        if (pair == "B-B") return lennard_jones(r, 0.8, 0.9)
        if (pair == "A-C") return lennard_jones(r, 1.1, 1.1)
        if (pair == "B-C") return lennard_jones(r, 0.9, 1.05)
        if (pair == "C-C") return lennard_jones(r, 1, 1.2)
    }
    if (member == "mixture-sizes-attractive")
        return lennard_jones(r, 1, pair == "A-A" ? 1 : pair == "A-B" ? 0.85 : 0.7)
    return lennard_jones(r, 1, 1)
}

# Of bonded beads, which repel each other, too.
function fene(q) { return -33.75 * log(1 - (q / 1.5) ^ 2) + (member == "dumbbells" ? lennard_jones(q, 1, 1) : repulsive(q, 1)) }

# q: a length, or degrees.
function bonded_law(kind, q) {
    if (kind == "dihedrals")
        return 1 + cos(3 * q * degree)
    # The outer beads of an angle repel each other, too; bonds are 0.965 long.
    if (kind == "angles" && member == "kremer-grest")
        return 1.5 * (1 + cos(q * degree)) + repulsive(1.93 * sin(q * degree / 2), 1)
    if (kind == "angles")
        return member == "chain-in-vacuum" ? 15 * ((q - 115) * degree) ^ 2 : 125 * ((q - 114.5916) * degree) ^ 2
    if (member == "polymer-solvent")
        return 50 * (q - 0.6) ^ 2
    if (member == "chain-in-vacuum")
        return 100 * (q - 1) ^ 2
    if (member == "kremer-grest" || member == "dumbbells" || member == "ring-melt")
        return fene(q)
    return 250 * (q - (member == "rings" || member == "lennard-jones-chains" ? 1 : 1.1)) ^ 2
}

# An error that is a number, and not nan, and above 0.
function known(text) { return text ~ /^[0-9]/ && text > 0 }

BEGIN {
    degree = atan2(0, -1) / 180
    n = m = 0
}

FNR == 1 {
    finish_group()
    name = FILENAME
    sub(/^.*\//, "", name)
    sub(/\.tsv$/, "", name)
    kind = name
    sub(/_.*$/, "", kind)
    pair = name
    if (sub(/^[a-z]*_/, "", pair) == 0)
        pair = ""
}

# The names of the columns stand in the last line of comments.
/^#/ {
    for (c = 1; c <= NF; c++) {
        text = $c
        sub(/\[.*/, "", text)
        column[text] = c - 1
    }
    next
}

kind == "potential" {
    if (known($(column["phi_error"]))) {
        place[n] = $1
        phi[n] = $(column["phi"])
        error[n] = $(column["phi_error"])
        narrow[n] = "phi_error_without_ramp" in column ? $(column["phi_error_without_ramp"]) : error[n]
        of[n++] = pair
    }
    cutoff[pair] = $1
    next
}

# The repulsion of outer beads that are so near depends on the lengths of both bonds.
kind == "angles" && member == "kremer-grest" && $1 < 60 { next }

known($(column["energy_error"])) {
    off[m] = $(column["energy"]) - bonded_law(kind, $1)
    size[m] = $(column["energy_error"])
    sum += off[m] / size[m] ^ 2
    weight += 1 / size[m] ^ 2
    m++
}

function finish_group(    k) {
    for (k = 0; k < m; k++)
        bonded += ((off[k] - sum / weight) / size[k]) ^ 2
    bonded_bins += m
    m = sum = weight = 0
}

END {
    finish_group()
    for (k = 0; k < n; k++) {
        delta[k] = phi[k] - law(of[k], place[k]) + law(of[k], cutoff[of[k]])
        ramp[k] = 1 - place[k] / cutoff[of[k]]
        squares += (delta[k] / error[k]) ^ 2
        top += delta[k] * ramp[k] / narrow[k] ^ 2
        bottom += ramp[k] ^ 2 / narrow[k] ^ 2
    }
    for (k = 0; k < n; k++)
        rest += ((delta[k] - top / bottom * ramp[k]) / narrow[k]) ^ 2
    if (n > 0)
        printf "z %.3g\nz_without_way %.3g\n", sqrt(squares / n), sqrt(rest / n)
    if (bonded_bins > 0)
        printf "z_bonded %.3g\n", sqrt(bonded / bonded_bins)
}
