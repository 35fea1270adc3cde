/* SPDX-License-Identifier: GPL-3.0-or-later
 * A pair potential and an external force of one's own: beads in a harmonic trap. */
#include <math.h>
#include <mesofit.h>
#include <stdio.h>

/* Phi(r) of a Gaussian core [k_B T_0]. */
static double gaussian_core(const void *height, double r) {
    return *(const double *)height * exp(-r * r);
}

/* F = -k (x - centre), along the first axis alone. */
static double trap(void *stiffness, size_t count, const uint32_t *id, const double *const *position,
                   double *const *force) {
    const double k = *(const double *)stiffness;
    double energy = 0;
    (void)id;
    for (size_t n = 0; n < count; n++) {
        const double x = position[0][n] - 5;
        force[0][n] -= k * x;
        energy += 0.5 * k * x * x;
    }
    return energy;
}

int main(void) {
    double height = 2, stiffness = 4, squares = 0;
    struct mesofit_scene scene = mesofit_scene_default();
    scene.particles = 200;
    scene.conservative =
        (struct mesofit_law){.value = gaussian_core, .context = &height, .cutoff = 3};
    scene.dissipative.text = "{\"law\": \"power\", \"sigma\": 3}";
    struct mesofit_simulation *simulation = mesofit_simulation_create(&scene);
    if (simulation == NULL) {
        fprintf(stderr, "%s\n", mesofit_message());
        return 1;
    }
    mesofit_simulation_set_force(simulation, trap, &stiffness);
    if (mesofit_simulation_run(simulation, 5000) != MESOFIT_OK) {
        fprintf(stderr, "%s\n", mesofit_message());
        return 1;
    }
    const double *x = mesofit_simulation_positions(simulation, 0);
    for (size_t n = 0; n < mesofit_simulation_count(simulation); n++)
        squares += (x[n] - 5) * (x[n] - 5) / (double)scene.particles;
    printf("T = %.2f, width of the cloud %.2f, %.2f without the pair forces\n",
           mesofit_simulation_temperature(simulation), sqrt(squares), sqrt(1 / stiffness));
    mesofit_simulation_free(simulation);
    return 0;
}
