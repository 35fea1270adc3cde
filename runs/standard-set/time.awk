# SPDX-License-Identifier: GPL-3.0-or-later
#
# A row of time.sh from timing.tsv, history.tsv and summary.json of one fit.

FNR == 1 { part++ }

# Columns by their names, without units.
part <= 2 && /^#/ {
    delete column
    for (k = 2; k <= NF; k++) {
        word = $k
        sub(/\[.*/, "", word)
        column[word] = k - 1
    }
    next
}

part == 1 {
    if (!("equilibration" in column)) {
        print "time.sh: timing.tsv of " name " is of a version before 0.3.0" >"/dev/stderr"
        failed = 2
        exit failed
    }
    before = samples
    samples = $column["samples"]
    processor = $column["processor_seconds"]
    equilibration = $column["equilibration"]
    lost = $column["lost_samples"]
    algebra = $column["algebra"]
    verification = $column["verification"]
    figures = $column["figures"]
    iterations++
}

part == 2 && "inefficiency" in column { inefficiency = $column["inefficiency"] }

part == 3 && match($0, /"(rdf|bond_lengths|etd|vacf)_(rmse|rmse_error|noise)":/) {
    key = substr($0, RSTART + 1, RLENGTH - 3)
    sub(/^rdf_|^bond_lengths_|^etd_|^vacf_/, "", key)
    number = $0
    gsub(/^.*:[ \t]*|,$/, "", number)
    if (!(key in found))
        found[key] = number + 0
}

function shown(key, format) { return key in found ? sprintf(format, found[key]) : "" }

END {
    if (failed)
        exit failed
    # Of the last iteration alone, if each of its samples were independent.
    ideal = inefficiency > 0 ? (samples - before) / inefficiency : 0
    rest = processor - equilibration - samples - lost - algebra
    printf "| %s | %d | %.1f | %.1f | %.1f | %.1f | %.1f | %.1f", name, iterations, processor + verification + figures, equilibration,
        samples, lost, algebra, rest
    printf " | %.1f | %.1f | %s | %s%s | %s | %s |\n", verification, figures, (inefficiency > 0 ? sprintf("%.1f", inefficiency) : ""),
        shown("rmse", "%.4f"), shown("rmse_error", " ± %.4f"), shown("noise", "%.4f"),
        (ideal > 0 ? sprintf("%.0f", (processor + verification) / ideal) : "")
}
