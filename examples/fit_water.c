/* SPDX-License-Identifier: GPL-3.0-or-later
 * Find the potential of water, one bead a molecule, from arrays in memory.
 * Usage: fit_water < table of r, g and errors of g */
#include <mesofit.h>
#include <stdio.h>

enum { MAX_BINS = 400 };

static int fail(void) {
    fprintf(stderr, "%s\n", mesofit_message());
    return 1;
}

int main(void) {
    static double r[MAX_BINS], g[MAX_BINS], error[MAX_BINS];
    size_t bins = 0;
    while (bins < MAX_BINS && scanf("%lf %lf %lf", &r[bins], &g[bins], &error[bins]) == 3)
        bins++;

    struct mesofit_fit_options options = mesofit_fit_options_default();
    for (int axis = 0; axis < 3; axis++)
        options.scene.box[axis] = 9.428;
    options.scene.particles = 2744;
    options.scene.time_step = 0.005;
    options.scene.threads = 2;
    options.rdf.count = bins;
    options.rdf.r = r;
    options.rdf.g = g;
    options.rdf.error = error;
    options.settings = "{\"particles\": 729, \"precision\": 0.003}";
    struct mesofit_fit *fit = mesofit_fit_create(&options);
    if (fit == NULL)
        return fail();

    struct mesofit_fit_state state = {0};
    while (!state.finished) {
        if (mesofit_fit_iterate(fit, &state) != MESOFIT_OK)
            return fail();
        fprintf(stderr, "iteration %u: g is off by %.4f, %.4f by statistics\n", state.iteration,
                state.error, state.noise);
    }
    const struct mesofit_curve phi = mesofit_fit_curve(fit, MESOFIT_POTENTIAL);
    puts("# r\tpotential\tpotential_error");
    for (size_t k = 0; k < phi.count; k++)
        printf("%.5f\t%.6f\t%.4f\n", phi.r[k], phi.value[k], phi.error[k]);
    mesofit_fit_free(fit);
    return state.converged ? 0 : 1;
}
