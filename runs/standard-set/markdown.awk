# SPDX-License-Identifier: GPL-3.0-or-later
#
# table.tsv as Markdown, and what it comes to.

BEGIN {
    FS = "\t"
    print "| system | status | iterations | wall s | processor s | g | lengths | angles | dihedrals | T off % | T_conf off % | pressure | left open by | z of Φ | z without the open way | z of bonded U |"
    print "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
}

function shown(text) { return text == "nan" ? "" : text }

# A value with its error in brackets, as written.
function both(text, error) { return text == "nan" ? "" : error == "nan" ? text : text " ± " error }

/^#/ { next }

{
    printf "| %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s |\n", $1, $2, shown($3), shown($4), shown($5),
        shown($6), shown($7), shown($8), shown($9), both($10, $11), both($12, $13), both($14, $15), shown($16), shown($17),
        shown($18), shown($19)
    systems++
    if ($2 != "-") {
        run++
        converged += $2 == "converged"
        wall += $4
        processor += $5
        longest = $4 > longest ? $4 : longest
    }
}

END {
    printf "\n%d of %d systems run, %d converged; %.0f s of wall, %.0f s of processor time, the longest %.0f s.\n", run, systems,
        converged, wall, processor, longest
}
