// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/integrals.h"

#include "shared/results.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void integrals_tilt(struct temporary_folder *folder, const char *pair, double factor,
                    double error) {
    char name[64], out[8192] = "";
    snprintf(name, sizeof name, "truth/rdf_%s.tsv", pair);
    char *text = temporary_folder_read(name);
    size_t length = 0;
    for (const char *line = text; line && *line; line = strchr(line, '\n')) {
        double r, g;
        line += *line == '\n';
        if (sscanf(line, "%lf %lf", &r, &g) == 2)
            length += (size_t)snprintf(out + length, sizeof out - length, "%g %g %g\n", r,
                                       g * factor, error);
    }
    snprintf(name, sizeof name, "g_%s.tsv", pair);
    temporary_folder_write(folder, name, out, length);
    free(text);
}

static double read_of(const char *folder, const char *what, const char *pair) {
    char file[64], key[96];
    snprintf(file, sizeof file, "%s/summary.json", folder);
    snprintf(key, sizeof key, "%s_%s", what, pair);
    return results_number(file, key);
}

void integrals_of_truth(const struct integrals *integrals, double error, char *text, size_t size) {
    int length = 0;
    for (size_t k = 0; k < integrals->pairs; k++)
        length += snprintf(text + length, size - (size_t)length,
                           "%s\"%s\": {\"value\": %.6g, \"error\": %g}", k ? ", " : "",
                           integrals->pair[k],
                           read_of("truth", "kirkwood_buff", integrals->pair[k]), error);
}

double integrals_farthest(const struct integrals *integrals, const char *folder) {
    double farthest = 0;
    for (size_t k = 0; k < integrals->pairs; k++) {
        const char *pair = integrals->pair[k];
        const double found = read_of(folder, "kirkwood_buff", pair);
        const double wanted = read_of(folder, "target_kirkwood_buff", pair);
        const double error = read_of(folder, "kirkwood_buff_error", pair);
        print_message("%s: G of %s = %.3f(%.3f), truth %.3f\n", folder, pair, found, error, wanted);
        farthest = fmax(farthest, fabs(found - wanted) / hypot(error, integrals->error));
    }
    return farthest;
}
