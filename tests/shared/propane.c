// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/propane.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TARGET(pair, range)                                                                        \
    "\"" pair "\": {\"file\": \"" pair                                                             \
    ".dist.tgt\", \"format\": \"votca\", \"normalisation\": 1" range "}"
#define RUN(box, count, range)                                                                     \
    "{\"units\": \"nm-ps\", \"target\": {\"rdf\": {\n" TARGET("A-A", range) ",\n" TARGET(          \
        "A-B", range) ",\n" TARGET("B-B",                                                          \
                                   range) "}},\n"                                                  \
                                          "\"scene\": {\"box\": " box ", \"temperature\": 200,\n"  \
                                          "\"particles\": {\"mass\": 14.7}, \"bonds\": "           \
                                          "{\"bond\": {\"law\": \"harmonic\", \"k\": 50000, "      \
                                          "\"length\": 0.17}},\n"                                  \
                                          "\"molecules\": {\"propane\": {\"count\": " count        \
                                          ", \"chain\": {\"beads\": [\"A\", \"B\", "               \
                                          "\"A\"], \"bond\": \"bond\"}}}}}\n"

const char propane_run[] = RUN("[4.96337, 5.13917, 4.52386]", "1000", "");
const char propane_run_small[] = RUN(PROPANE_SMALL_BOX, "300", ", \"cutoff\": 1.5");

void propane_write_target(struct temporary_folder *folder, const char *root, int pair,
                          double factor) {
    static const char names[PROPANE_PAIRS][16] = {"A-A.dist.tgt", "A-B.dist.tgt", "B-B.dist.tgt"};
    char file[1024], *rest;
    snprintf(file, sizeof file, "%s/targets/propane/%s", root, names[pair]);
    char *text = temporary_folder_read(file), *scaled = calloc(2, strlen(text)), *end = scaled;
    for (char *row = strtok_r(text, "\n", &rest); row; row = strtok_r(NULL, "\n", &rest)) {
        double r, g;
        if (sscanf(row, "%lf %lf", &r, &g) == 2)
            end += sprintf(end, "%.6f %.6f i\n", r, factor * g);
    }
    temporary_folder_write(folder, names[pair], scaled, strlen(scaled));
    free(scaled);
    free(text);
}
