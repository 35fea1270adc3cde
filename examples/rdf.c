/* SPDX-License-Identifier: GPL-3.0-or-later
 * Simulate the fluid of Groot and Warren and print its g(r). */
#include <mesofit.h>
#include <stdio.h>

enum { BINS = 50 };

static int fail(void) {
    fprintf(stderr, "%s\n", mesofit_message());
    return 1;
}

int main(void) {
    struct mesofit_scene scene = mesofit_scene_default();
    scene.conservative.text = "{\"law\": \"soft-repulsion\", \"a\": 25}";
    scene.dissipative.text = "{\"law\": \"power\", \"sigma\": 2.12}";
    struct mesofit_simulation *simulation = mesofit_simulation_create(&scene);
    if (simulation == NULL)
        return fail();

    struct mesofit_rdf_plan plan = mesofit_rdf_plan_default();
    plan.bins = BINS;
    plan.range = 2.5;
    plan.samples = 50;
    double r[BINS], g[BINS], error[BINS];
    if (mesofit_simulation_run(simulation, 500) != MESOFIT_OK ||
        mesofit_simulation_rdf(simulation, &plan, r, g, error) != MESOFIT_OK)
        return fail();
    puts("# r\tg\tg_error");
    for (int k = 0; k < BINS; k++)
        printf("%.3f\t%.4f\t%.4f\n", r[k], g[k], error[k]);
    mesofit_simulation_free(simulation);
    return 0;
}
