// SPDX-License-Identifier: GPL-3.0-or-later
//
// The virial along each axis is what the energy says of a box that is stretched along it,
// −∂U/∂ε of x → (1 + ε) x.
#include "dynamics/simulation_look.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

enum { COUNT = 200 };

/// U of a fluid that is stretched along an axis.
static double stretched_energy(const struct simulation_setup *setup,
                               const struct simulation *simulation, int axis, double strain) {
    struct simulation_setup own = *setup;
    static struct simulation stretched;
    static double position[3][COUNT];
    struct simulation_start start = {{NULL}, {NULL}};
    for (int d = 0; d < 3; d++) {
        const double scale = d == axis ? 1 + strain : 1;
        for (size_t k = 0; k < COUNT; k++)
            position[d][k] = scale * simulation->particles.position[d][k];
        own.box.length[d] *= scale;
        start.position[d] = position[d];
    }
    own.placement.kind = PLACEMENT_FILE;
    assert_ok(mf_simulation_init(&stretched, &own, &start));
    assert_ok(mf_simulation_compute_potential(&stretched));
    const double energy = stretched.sums.energy;
    mf_simulation_clear(&stretched);
    return energy;
}

static void check(struct simulation_setup *setup) {
    static const double strain = 1e-4;
    static struct simulation simulation;
    double virial[3][3], trace = 0;
    setup->precision = PAIR_DOUBLE;
    assert_ok(mf_simulation_init(&simulation, setup, NULL));
    assert_ok(mf_simulation_run(&simulation, 20));
    const double before = simulation.particles.force[0][7];
    assert_ok(mf_simulation_look_virial(&simulation, virial));
    for (int axis = 0; axis < setup->box.dimensions; axis++) {
        const double slope = (stretched_energy(setup, &simulation, axis, strain) -
                              stretched_energy(setup, &simulation, axis, -strain)) /
                             (2 * strain);
        assert_close(virial[axis][axis], -slope, 1e-3 * fabs(slope));
        trace += virial[axis][axis];
        for (int other = 0; other < 3; other++)
            assert_close(virial[axis][other], virial[other][axis], 1e-6 * fabs(slope));
    }
    assert_identical(simulation.particles.force[0][7], before);
    assert_ok(mf_simulation_compute_potential(&simulation));
    assert_close(trace, simulation.sums.virial, 1e-9 * fabs(trace));
    mf_simulation_clear(&simulation);
}

static void test_virial_along_each_axis_is_that_of_the_strain(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, COUNT, 0.03);
    fluid.setup.box.length[1] *= 1.2;
    fluid.setup.box.length[2] *= 1.5;
    check(&fluid.setup);
    fluid_clear(&fluid);
    fluid_soft_discs(&fluid, COUNT, 0.03);
    fluid.setup.box.length[1] *= 1.4;
    check(&fluid.setup);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_virial_along_each_axis_is_that_of_the_strain),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
