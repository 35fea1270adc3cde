/* SPDX-License-Identifier: GPL-3.0-or-later
 * An optimiser of one's own (a (1+1) evolution strategy) looks for a potential: it asks the fit for
 * the error of each candidate. Usage: own_optimiser RUN.json */
#include <math.h>
#include <mesofit.h>
#include <stdio.h>
#include <stdlib.h>

/* Normal enough: the sum of twelve uniform numbers. */
static double normal(void) {
    double sum = -6;
    for (int k = 0; k < 12; k++)
        sum += rand() / (RAND_MAX + 1.0);
    return sum;
}

int main(int count, char **arguments) {
    enum { TRIALS = 30 };
    double step = 0.05, best_error, error;
    struct mesofit_fit *fit = count == 2 ? mesofit_fit_open(arguments[1], 1, NULL, NULL) : NULL;
    if (fit == NULL) {
        fprintf(stderr, "%s\n", count == 2 ? mesofit_message() : "usage: own_optimiser RUN.json");
        return 2;
    }
    const size_t n = mesofit_fit_coefficients(fit);
    double *best = malloc(2 * n * sizeof *best), *trial = best + n;
    if (best == NULL || mesofit_fit_start(fit, best) != MESOFIT_OK ||
        mesofit_fit_evaluate(fit, best, 1, &best_error, NULL) != MESOFIT_OK)
        return 1;
    printf("%zu coefficients; the start is off by %.4f\n", n, best_error);
    for (int k = 0; k < TRIALS; k++) {
        for (size_t c = 0; c < n; c++)
            trial[c] = fmin(1, fmax(0, best[c] + step * normal()));
        if (mesofit_fit_evaluate(fit, trial, 1, &error, NULL) != MESOFIT_OK)
            return 1;
        step *= error < best_error ? 1.5 : 0.9;
        for (size_t c = 0; error < best_error && c < n; c++)
            best[c] = trial[c];
        best_error = fmin(best_error, error);
    }
    printf("after %d trials %.4f\n", TRIALS, best_error);
    free(best);
    mesofit_fit_free(fit);
    return 0;
}
