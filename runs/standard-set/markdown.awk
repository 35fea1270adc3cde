# SPDX-License-Identifier: GPL-3.0-or-later
#
# table.tsv as Markdown, and what it comes to.

BEGIN {
    FS = "\t"
    print "| system | status | iterations | wall s | processor s | g | lengths | angles | dihedrals | T off % | T_conf off % | pressure | left open by | of which off | z of Φ | z without the open way | z of bonded U |"
    print "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
}

function shown(text) { return text == "nan" ? "" : text }

# The largest that is a number; 0 if none is.
function most(a, b, c, d,    part, k, top) {
    split(a " " b " " c " " d, part, " ")
    for (k in part)
        if (part[k] != "nan" && part[k] + 0 > top)
            top = part[k] + 0
    return top + 0
}

# A value with its error in brackets, as written.
function both(text, error) { return text == "nan" ? "" : error == "nan" ? text : text " ± " error }

/^#/ { next }

{
    printf "| %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s |\n", $1, $2, shown($3), shown($4), shown($5),
        shown($6), shown($7), shown($8), shown($9), both($10, $11), both($12, $13), both($14, $15), shown($16), shown($17),
        shown($18), shown($19), shown($20)
    systems++
    if ($2 != "-") {
        run++
        converged += $2 == "converged"
        wall += $4
        processor += $5
        longest = $4 > longest ? $4 : longest
    }
    # Systems that have such a number, and those whose every one is within the bar.
    known[1] += has = most($6, $7, $8, $9) > 0
    met[1] += has && most($6, $7, $8, $9) <= 2
    known[2] += has = $10 != "nan"
    met[2] += has && $10 <= 1 && $10 >= -1
    known[3] += has = most($18, $20, 0, 0) > 0
    met[3] += has && most($18, $20, 0, 0) <= 1.3
    known[4] += has = $17 != "nan"
    met[4] += has && $17 <= 2.5 && $17 >= -2.5
}

END {
    printf "\n%d of %d systems run, %d converged; %.0f s of wall, %.0f s of processor time, the longest %.0f s.\n", run, systems,
        converged, wall, processor, longest
    printf "Distributions within 2 times their statistics: %d of %d that have any; temperature within 1 %%: %d of %d; z within 1.3: %d of %d; pressure within 2.5 of what is left open: %d of %d.\n",
        met[1], known[1], met[2], known[2], met[3], known[3], met[4], known[4]
}
