// SPDX-License-Identifier: GPL-3.0-or-later
//
// The bath of each bead that other engines have: free beads by Ornstein's formula, the fluid at its
// temperature, the same bits through threads and restarts.
#include "dynamics/langevin.h"
#include "observe/measure.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/restart.h"
#include "shared/testing.h"

#include <math.h>

/// A false alarm in 150,000.
static const double deviations = 4.5;

static const struct langevin_parameters parameters = {.rate = 4};

static void take(struct fluid *fluid) {
    fluid->setup.omega = NULL;
    fluid->setup.integrator = &mf_langevin;
    fluid->setup.integrator_parameters = &parameters;
}

/// L. S. Ornstein, Proc. R. Acad. Amsterdam 21, 96 (1919): along an axis the MSD is 2 T/(m g²)
/// (g t − 1 + exp(−g t)) and ⟨v(0) v(t)⟩ is (T/m) exp(−g t), from equal mass m and rate g.
static void test_free_beads_move_by_ornsteins_formula(void **state) {
    (void)state;
    enum { COUNT = 4000, STEPS = 100, MASSES = 2 };
    static const double masses[MASSES] = {1, 5};
    const double temperature = 1.5, time_step = 0.005, rate = parameters.rate;
    const double time = STEPS * time_step, numbers = 3.0 * COUNT;
    for (int m = 0; m < MASSES; m++) {
        struct fluid fluid;
        struct simulation simulation;
        static double place[COUNT][3], velocity[COUNT][3];
        double squares = 0, products = 0;
        fluid_ideal_gas(&fluid, 3, COUNT, time_step);
        take(&fluid);
        fluid.setup.temperature = temperature;
        fluid.setup.attribute[ATTRIBUTES_MASS] =
            (struct attributes_source){1, {{masses[m], masses[m]}}, NULL};
        assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
        const struct particles *particles = &simulation.particles;
        for (size_t k = 0; k < COUNT; k++)
            for (int d = 0; d < 3; d++) {
                place[particles->id[k]][d] =
                    particles->position[d][k] + particles->image[d][k] * particles->box.length[d];
                velocity[particles->id[k]][d] = particles->velocity[d][k];
            }
        assert_ok(mf_simulation_run(&simulation, STEPS));
        for (size_t k = 0; k < COUNT; k++)
            for (int d = 0; d < 3; d++) {
                const double now =
                    particles->position[d][k] + particles->image[d][k] * particles->box.length[d];
                squares += pow(now - place[particles->id[k]][d], 2);
                products += particles->velocity[d][k] * velocity[particles->id[k]][d];
            }
        const double thermal = temperature / masses[m];
        const double msd = 2 * thermal / (rate * rate) * (rate * time - 1 + exp(-rate * time));
        const double vacf = thermal * exp(-rate * time);
        print_message("m %g: MSD %.5f, by Ornstein %.5f; VACF %.5f, %.5f\n", masses[m],
                      squares / numbers, msd, products / numbers, vacf);
        assert_close(squares / numbers, msd, deviations * msd * sqrt(2 / numbers));
        assert_close(products / numbers, vacf, deviations * thermal * sqrt(2 / numbers));
        mf_simulation_clear(&simulation);
        fluid_clear(&fluid);
    }
}

/// The velocities are the bath's, whatever the forces: kinetic energies of 300 beads vary by
/// sqrt(2/900) of it, and a hundred times apart by more than 1/rate count as independent.
static void test_fluid_has_the_temperature_of_the_bath(void **state) {
    (void)state;
    enum { COUNT = 300, SAMPLES = 100, EVERY = 50 };
    struct fluid fluid;
    struct simulation simulation;
    double sum = 0;
    fluid_groot_warren(&fluid, COUNT, 0.01);
    take(&fluid);
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    assert_ok(mf_simulation_run(&simulation, 200));
    for (int k = 0; k < SAMPLES; k++) {
        assert_ok(mf_simulation_run(&simulation, EVERY));
        sum += mf_simulation_temperature(&simulation);
    }
    const double error = sqrt(2.0 / (3.0 * COUNT) / SAMPLES);
    print_message("T %.4f(%.4f)\n", sum / SAMPLES, error);
    assert_close(sum / SAMPLES, 1, deviations * error + 0.002); // and of (Ω Δt)²/4
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void test_langevin_has_the_same_bits_through_threads_and_restarts(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation whole, pieces;
    fluid_groot_warren(&fluid, 2500, 0.01);
    take(&fluid);
    assert_ok(mf_simulation_init(&whole, &fluid.setup, NULL));
    fluid.setup.threads = 2;
    assert_ok(mf_simulation_init(&pieces, &fluid.setup, NULL));
    assert_ok(mf_simulation_run(&whole, 20));
    assert_ok(mf_simulation_run(&pieces, 9));
    restart_simulation(&pieces);
    assert_ok(mf_simulation_run(&pieces, 11));
    restart_assert_same(&whole, &pieces);
    mf_simulation_clear(&whole);
    mf_simulation_clear(&pieces);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_free_beads_move_by_ornsteins_formula),
        cmocka_unit_test(test_fluid_has_the_temperature_of_the_bath),
        cmocka_unit_test(test_langevin_has_the_same_bits_through_threads_and_restarts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
