// SPDX-License-Identifier: GPL-3.0-or-later
//
// What pairs exchange, against what becomes of Σ x p: in a drop that touches no edge of its box
// nothing else changes it, whatever the forces are.
#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/remembering.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { EDGE = 6, COUNT = EDGE * EDGE * EDGE, STEPS = 40 };
enum { ALL = REMEMBERING_SLOW | REMEMBERING_RATTLE | REMEMBERING_ACROSS };

/// A lattice in the middle of a large box, a little out of order.
static void place(double (*position)[COUNT]) {
    for (uint32_t k = 0; k < COUNT; k++)
        for (uint32_t d = 0, n = k; d < 3; d++, n /= EDGE)
            position[d][k] = 8 + 0.7 * (n % EDGE) +
                             0.2 * 0x1p-32 * mf_rng_philox(5, RNG_INITIAL, k, d, 0).word[0];
}

static void begin(struct simulation *simulation, struct simulation_setup *setup) {
    double position[3][COUNT];
    const struct simulation_start start = {{position[0], position[1], position[2]}, {NULL}};
    place(position);
    setup->box = (struct box){3, {20, 20, 20}};
    setup->placement.kind = PLACEMENT_FILE;
    assert_ok(mf_simulation_init(simulation, setup, &start));
}

/// Σ x p, and Σ p p Δt/2, with which a step begins and ends.
static void measure(const struct particles *particles, double time_step, double moment[3][3],
                    double carried[3][3]) {
    memset(moment, 0, 9 * sizeof **moment);
    memset(carried, 0, 9 * sizeof **carried);
    for (size_t k = 0; k < COUNT; k++)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++) {
                const double v = particles->velocity[b][k];
                moment[a][b] += particles->position[a][k] * v;
                carried[a][b] += 0.5 * time_step * particles->velocity[a][k] * v;
            }
}

static void check(struct simulation_setup *setup, int threads, double tolerance) {
    struct simulation simulation;
    static struct transfer transfer;
    double before[3][3], after[3][3], first[3][3], last[3][3];
    double largest = 0, size = 0;
    memset(&transfer, 0, sizeof transfer);
    setup->threads = threads;
    begin(&simulation, setup);
    assert_ok(mf_simulation_run(&simulation, 1));
    measure(&simulation.particles, setup->time_step, before, first);
    simulation.transfer = &transfer;
    assert_ok(mf_simulation_run(&simulation, STEPS));
    measure(&simulation.particles, setup->time_step, after, last);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) {
            const double told = transfer.sum[a][b] + first[a][b] - last[a][b];
            largest = fmax(largest, fabs(told - (after[a][b] - before[a][b])));
            size = fmax(size, fabs(after[a][b] - before[a][b]));
        }
    print_message("%s, %d threads: off by %.2g of %.3g\n", setup->integrator->name, threads,
                  largest, size);
    assert_close(largest, 0, tolerance * size);
    mf_simulation_clear(&simulation);
}

/// A step of aboba drifts, and gives impulses at rest: only rounding is left, of the mixed
/// precision, too.
static void test_transfer_is_what_becomes_of_the_moments_of_a_drop(void **state) {
    (void)state;
    struct remembering r;
    remembering_make(&r, COUNT, 0.01, ALL);
    check(&r.fluid.setup, 1, 1e-5);
    check(&r.fluid.setup, 2, 1e-5);
    remembering_clear(&r);
}

/// Integrators that drift with velocities of the middle of a step differ by its square.
static void test_transfer_is_told_by_all_integrators_that_say_so(void **state) {
    (void)state;
    int tested = 0;
    for (size_t k = 0; mf_integrator_list[k]; k++) {
        struct fluid fluid;
        if (!mf_integrator_list[k]->records_momentum_transfer)
            continue;
        fluid_groot_warren(&fluid, COUNT, 0.0005);
        fluid.setup.integrator = mf_integrator_list[k];
        if (!mf_integrator_list[k]->dissipative)
            fluid.setup.omega = NULL;
        check(&fluid.setup, 1, 0.01);
        fluid_clear(&fluid);
        tested++;
    }
    assert_int_equal(tested, 5);
}

/// Who asks gets the bits of who does not.
static void test_transfer_changes_nothing(void **state) {
    (void)state;
    struct remembering r;
    struct simulation asked, silent;
    static struct transfer transfer;
    remembering_make(&r, 1500, 0.02, ALL);
    assert_ok(mf_simulation_init(&asked, &r.fluid.setup, NULL));
    assert_ok(mf_simulation_init(&silent, &r.fluid.setup, NULL));
    asked.transfer = &transfer;
    assert_ok(mf_simulation_run(&asked, 20));
    assert_ok(mf_simulation_run(&silent, 20));
    for (int d = 0; d < 3; d++)
        assert_memory_equal(asked.particles.velocity[d], silent.particles.velocity[d],
                            1500 * sizeof(double));
    mf_simulation_clear(&asked);
    mf_simulation_clear(&silent);
    remembering_clear(&r);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_transfer_is_what_becomes_of_the_moments_of_a_drop),
        cmocka_unit_test(test_transfer_is_told_by_all_integrators_that_say_so),
        cmocka_unit_test(test_transfer_changes_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
