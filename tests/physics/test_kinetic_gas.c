// SPDX-License-Identifier: GPL-3.0-or-later
//
// The kinetic gas: pressure by collisions and by walls, rates and free path against the equations
// of state, Maxwell's distribution from any start, equipartition, energy after ten million events.
#include "observe/hard_theory.h"
#include "observe/maxwell.h"
#include "shared/hard_gases.h"
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/testing.h"

#include <math.h>

/// Run until each particle has had so many collisions, in steps of about one.
static void run(struct simulation *simulation, double collisions) {
    const struct hard_gas *gas = hard_gases_of(simulation);
    const double begin = (double)gas->now.tally.collisions;
    while (2 * ((double)gas->now.tally.collisions - begin) < collisions * gas->count)
        assert_ok(mf_simulation_run(simulation, 1));
}

static double mean_speed(const struct particles *p) {
    double sum = 0;
    for (size_t k = 0; k < p->count; k++)
        sum += sqrt(pow(p->velocity[0][k], 2) + pow(p->velocity[1][k], 2) +
                    (p->box.dimensions == 3 ? pow(p->velocity[2][k], 2) : 0));
    return sum / (double)p->count;
}

struct measured {
    double factor, rate, path;
};

/// Z and rate over a run in pieces, with the mean speed at the end of each for the free path.
static struct measured measure(struct simulation *simulation, double collisions) {
    enum { PIECES = 50 };
    const struct hard_gas *gas = hard_gases_of(simulation);
    const struct hard_gas_tally before = gas->now.tally;
    const uint64_t first = simulation->step;
    const double n = gas->count;
    double speed = 0;
    for (int k = 0; k < PIECES; k++) {
        run(simulation, collisions / PIECES);
        speed += mean_speed(&simulation->particles) / PIECES;
    }
    const double time = (double)(simulation->step - first) * simulation->setup.time_step;
    const double virial = gas->now.tally.virial - before.virial;
    const double rate = 2 * (double)(gas->now.tally.collisions - before.collisions) / (n * time);
    return (struct measured){(n - 1) / n + virial / (gas->dimensions * n * time), rate,
                             speed / rate};
}

static struct hard_theory theory_of(const struct simulation *simulation) {
    enum { MAX = 5000 };
    static double radius[MAX], mass[MAX];
    const struct hard_gas *gas = hard_gases_of(simulation);
    for (int k = 0; k < gas->count; k++) {
        radius[k] = gas->body[k].radius;
        mass[k] = gas->label[k].mass;
    }
    return mf_hard_theory(gas->dimensions, mf_box_volume(&simulation->setup.box), 1, radius, mass,
                          (size_t)gas->count);
}

static void hold(const struct simulation *simulation, struct measured m, const char *what) {
    const struct hard_theory theory = theory_of(simulation);
    const double part = length_is_long() ? 1 : 2;
    print_message(
        "%s: Z = %.4f, theory %.4f (%+.2f %%); rate %+.2f %%, free path %+.2f %%\n", what, m.factor,
        theory.compressibility_factor, 100 * (m.factor / theory.compressibility_factor - 1),
        100 * (m.rate / theory.collision_rate - 1), 100 * (m.path / theory.mean_free_path - 1));
    assert_close_relative(m.factor, theory.compressibility_factor, part * 0.003);
    assert_close_relative(m.rate, theory.collision_rate, part * 0.01);
    assert_close_relative(m.path, theory.mean_free_path, part * 0.01);
}

/// Standard errors of Z are 0.05 % and less, so that 0.3 % is more than four of them beyond what
/// the equations are off: below one false alarm in 10,000 seeds. In short both are twice as much.
static void test_kinetic_gas_has_the_equations_of_state(void **state) {
    (void)state;
    static const double eta[4][3] = {{0}, {0}, {0.1, 0.3, 0.5}, {0.1, 0.3, 0.45}};
    for (int dimensions = 2; dimensions <= 3; dimensions++)
        for (int n = 0; n < 3; n++) {
            struct hard_gas_scene scene;
            struct simulation simulation;
            char what[32];
            hard_gases_make(&scene, dimensions, 4000, eta[dimensions][n]);
            assert_ok(mf_simulation_init(&simulation, &scene.setup, NULL));
            run(&simulation, 100);
            const struct measured measured =
                measure(&simulation, (n == 2 ? 1500 : 600) / (length_is_long() ? 1 : 4));
            snprintf(what, sizeof what, "%dD, eta %.2f", dimensions, eta[dimensions][n]);
            hold(&simulation, measured, what);
            mf_simulation_clear(&simulation);
        }
}

/// Two sizes and two masses, not those of equilibrium at first: it shares the energy out.
static void test_kinetic_gas_of_two_species_has_theirs_and_shares_its_energy(void **state) {
    (void)state;
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        struct hard_gas_scene scene;
        struct simulation simulation;
        char what[32];
        hard_gases_make_mixture(&scene, dimensions, 4000, 0.3, (const double[2]){1, 0.5},
                                (const double[2]){4, 1});
        scene.setup.placement.speeds = PARTICLES_NORMAL;
        assert_ok(mf_simulation_init(&simulation, &scene.setup, NULL));
        run(&simulation, 100);
        double share[2] = {0};
        const struct hard_gas *gas = hard_gases_of(&simulation);
        enum { SAMPLES = 40 };
        for (int sample = 0; sample < SAMPLES; sample++) {
            run(&simulation, 5);
            for (int k = 0; k < gas->count; k++)
                for (int d = 0; d < dimensions; d++)
                    share[gas->label[k].mass > 2 ? 0 : 1] +=
                        gas->label[k].mass * pow(gas->body[k].velocity[d], 2);
        }
        const double numbers = SAMPLES * 2000.0 * dimensions;
        print_message("%dD, masses 4 and 1: temperatures %.4f and %.4f\n", dimensions,
                      share[0] / numbers, share[1] / numbers);
        // Standard error sqrt(2/160,000)/sqrt(2) = 0.25 %: four of them, one alarm in 16,000 seeds.
        assert_close(share[0] / share[1], 1, 4 * 2 * sqrt(2 / numbers) / sqrt(2));
        const struct measured measured = measure(&simulation, 400);
        snprintf(what, sizeof what, "%dD, two species", dimensions);
        hold(&simulation, measured, what);
        mf_simulation_clear(&simulation);
    }
}

/// The virial of walls, at whose distance centres turn, is that of collisions and of flight:
///   Σ_d I_d (L_d − 2 r)/2 = 2 K t + Σ r·Δp,
/// exact but for what of Σ m r·v has changed, which is below 1e-3 of it here.
static void test_kinetic_gas_presses_on_walls_as_its_collisions_tell(void **state) {
    (void)state;
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        struct hard_gas_scene scene;
        struct simulation simulation;
        hard_gases_make(&scene, dimensions, 1000, 0.3);
        scene.parameters.walls = dimensions == 2 ? 3 : 7;
        assert_ok(mf_simulation_init(&simulation, &scene.setup, NULL));
        run(&simulation, 1000);
        const struct hard_gas_tally *tally = &hard_gases_of(&simulation)->now.tally;
        const double time = (double)simulation.step * scene.setup.time_step;
        double walls = 0;
        for (int d = 0; d < dimensions; d++)
            walls += tally->impulse[d] * (scene.setup.box.length[d] - 1) / 2;
        const double inside =
            2 * mf_particles_kinetic_energy(&simulation.particles) * time + tally->virial;
        print_message("%dD: virial of the walls %.5f of that of flight and collisions\n",
                      dimensions, walls / inside);
        assert_close_relative(walls, inside, 1e-3);
        mf_simulation_clear(&simulation);
    }
}

/// Probability by Kolmogorov and Smirnov of the components of `samples` configurations, twenty
/// collisions apart.
static double maxwell_probability(struct simulation *simulation, int samples) {
    struct maxwell maxwell;
    assert_ok(mf_maxwell_init(&maxwell, (size_t)samples));
    for (int sample = 0; sample < samples; sample++) {
        run(simulation, sample > 0 ? 20 : 0);
        mf_maxwell_sample(&maxwell, &simulation->particles, 1, simulation->setup.seed,
                          simulation->step);
    }
    const double p = mf_maxwell_result(&maxwell).probability;
    mf_maxwell_clear(&maxwell);
    return p;
}

/// False alarms: one in a thousand for each of six tests.
static void test_kinetic_gas_ends_in_the_distribution_of_maxwell_from_three_starts(void **state) {
    (void)state;
    static const enum particles_speeds speeds[] = {PARTICLES_MAXWELL, PARTICLES_UNIFORM,
                                                   PARTICLES_SIGNS};
    for (int dimensions = 2; dimensions <= 3; dimensions++)
        for (int n = 0; n < 3; n++) {
            struct hard_gas_scene scene;
            struct simulation simulation;
            hard_gases_make(&scene, dimensions, 4000, 0.2);
            scene.setup.placement.speeds = (int)speeds[n];
            assert_ok(mf_simulation_init(&simulation, &scene.setup, NULL));
            const double before = maxwell_probability(&simulation, 1);
            run(&simulation, 30);
            const double after = maxwell_probability(&simulation, 10);
            print_message("%dD, start %d: p = %.2g before, %.2g after\n", dimensions, n, before,
                          after);
            assert_true(n == 0 || before < 1e-6);
            assert_true(after > 1e-3);
            mf_simulation_clear(&simulation);
        }
}

static void test_kinetic_gas_keeps_its_energy_for_millions_of_events(void **state) {
    (void)state;
    struct hard_gas_scene scene;
    struct simulation simulation;
    hard_gases_make(&scene, 2, 1000, 0.4);
    assert_ok(mf_simulation_init(&simulation, &scene.setup, NULL));
    const double energy = mf_particles_kinetic_energy(&simulation.particles);
    const uint64_t collisions = length_is_long() ? 10000000 : 1000000;
    double gap = INFINITY;
    while (hard_gases_of(&simulation)->now.tally.collisions < collisions) {
        run(&simulation, 500);
        gap = fmin(gap, hard_gases_smallest_gap(&simulation));
    }
    const struct hard_gas_now *now = &hard_gases_of(&simulation)->now;
    const double off = mf_particles_kinetic_energy(&simulation.particles) / energy - 1;
    print_message("%llu collisions, %llu events: energy off by %.1e, deepest overlap %.1e, "
                  "smallest gap %.1e\n",
                  (unsigned long long)now->tally.collisions, (unsigned long long)now->events, off,
                  now->tally.overlap, gap);
    assert_close(off, 0, 1e-12);
    assert_true(now->tally.overlap < 1e-12 && gap > -1e-12);
    mf_simulation_clear(&simulation);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kinetic_gas_has_the_equations_of_state),
        cmocka_unit_test(test_kinetic_gas_of_two_species_has_theirs_and_shares_its_energy),
        cmocka_unit_test(test_kinetic_gas_presses_on_walls_as_its_collisions_tell),
        cmocka_unit_test(test_kinetic_gas_ends_in_the_distribution_of_maxwell_from_three_starts),
        cmocka_unit_test(test_kinetic_gas_keeps_its_energy_for_millions_of_events),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
