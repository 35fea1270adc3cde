/* SPDX-License-Identifier: GPL-3.0-or-later
 * Find the friction weight omega(r) of beads that repel each other from their escape times.
 * Usage: fit_friction RUN.json, the run file of an escape time fit */
#include <mesofit.h>
#include <stdio.h>

static int show(void *context, uint32_t iteration, uint64_t done, uint64_t total) {
    (void)context;
    fprintf(stderr, "\riteration %u: %u of %u simulations ", iteration, (unsigned)done,
            (unsigned)total);
    return 0; /* anything else stops the fit */
}

int main(int count, char **arguments) {
    struct mesofit_fit *fit = count == 2 ? mesofit_fit_open(arguments[1], 2, show, NULL) : NULL;
    if (fit == NULL) {
        fprintf(stderr, "%s\n", count == 2 ? mesofit_message() : "usage: fit_friction RUN.json");
        return 2;
    }
    struct mesofit_fit_state state = {0};
    while (!state.finished)
        if (mesofit_fit_iterate(fit, &state) != MESOFIT_OK) {
            fprintf(stderr, "\n%s\n", mesofit_message());
            return 1;
        }
    fprintf(stderr, "\nE(t, r_0) is off by %.4f, %.4f by statistics\n", state.error, state.noise);
    const struct mesofit_curve omega = mesofit_fit_curve(fit, MESOFIT_FRICTION);
    puts("# r\tomega\tomega_error");
    for (size_t k = 0; k < omega.count; k++)
        printf("%.4f\t%.5f\t%.5f\n", omega.r[k], omega.value[k], omega.error[k]);
    mesofit_fit_free(fit);
    return 0;
}
