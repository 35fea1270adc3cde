# SPDX-License-Identifier: GPL-3.0-or-later
# Courses of fits by method, out/METHOD-SEED/course.tsv, as bands of seeds: time in column 2, error in 3.

# Of the seeds of a method, the k-th points: mean time; least, mean and largest error. Seeds of fewer points end earlier.
band(method) = "< awk -F '\t' '!/^#/ { k = FNR; if (k > last) last = k; n[k]++; t[k] += log($2); s[k] += log($3); \
    if (n[k] == 1 || $3 < low[k]) low[k] = $3; if (n[k] == 1 || $3 > high[k]) high[k] = $3; if (FILENAME != file) files++; file = FILENAME } \
    END { for (k = 2; k <= last; k++) if (n[k] == files) print exp(t[k] / n[k]) \"\t\" low[k] \"\t\" exp(s[k] / n[k]) \"\t\" high[k] }' " . \
    system("echo out/".method."-[0-9]/course.tsv")
