// SPDX-License-Identifier: GPL-3.0-or-later
//
// What acts beside the pairs: forces against energies, its state through a restart, and the state
// of an integrator.
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/restart.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>

enum { COUNT = 81 };

/// Numbers of an interaction as its fields say: each has a default, or is set here.
struct numbers {
    double value[16];
};

/// The parameters of an interaction: lengths and numbers from 1.5 on, choices as they are.
static void fill(const struct interaction *kind, struct numbers *numbers) {
    assert_true(kind->parameters_size <= sizeof *numbers);
    *numbers = (struct numbers){{0}};
    mf_fields_set_defaults(kind->fields, numbers);
    double next = 1.5;
    for (const struct field *field = kind->fields; field->name; field++)
        for (int d = 0; d < 3; d++, next += 0.25)
            if (field->type == FIELD_LENGTHS || (field->type == FIELD_NUMBER && d == 0))
                memcpy((char *)numbers + field->offset + (size_t)d * sizeof next, &next,
                       sizeof next);
}

static void begin(struct fluid *fluid, struct simulation *simulation,
                  const struct interaction *kind, const void *parameters) {
    fluid_groot_warren(fluid, COUNT, 0.01);
    fluid->setup.omega = NULL;
    fluid->setup.integrator = &mf_velocity_verlet;
    fluid->setup.precision = PAIR_DOUBLE;
    fluid->setup.interaction[0] = (struct interaction_choice){kind, parameters};
    fluid->setup.interactions = 1;
    assert_ok(mf_simulation_init(simulation, &fluid->setup, NULL));
}

static double energy_at(struct simulation *simulation) {
    assert_ok(mf_simulation_compute_potential(simulation));
    return simulation->sums.energy;
}

static void test_interaction_forces_are_minus_the_slope_of_their_energy(void **state) {
    (void)state;
    static const double h = 1e-5, tolerance = 1e-5;
    for (size_t n = 0; mf_interaction_list[n]; n++) {
        if (mf_interaction_list[n]->oriented)
            continue; // no potential
        struct fluid fluid;
        struct simulation simulation;
        struct numbers numbers;
        if (mf_interaction_list[n] == &mf_soft_discs || // in two dimensions: test_soft_discs
            mf_interaction_list[n] == &mf_shear_wave)   // no potential, either
            continue;
        fill(mf_interaction_list[n], &numbers);
        begin(&fluid, &simulation, mf_interaction_list[n], &numbers);
        for (int d = 0; d < 3; d++)
            for (size_t k = 0; k < COUNT; k += 20) {
                double *x = &simulation.particles.position[d][k];
                const double here = *x;
                *x = here + h;
                const double above = energy_at(&simulation);
                *x = here - h;
                const double below = energy_at(&simulation);
                *x = here;
                energy_at(&simulation);
                assert_close_relative(simulation.particles.force[d][k], (below - above) / (2 * h),
                                      tolerance);
            }
        mf_simulation_clear(&simulation);
        fluid_clear(&fluid);
    }
}

static void test_uniform_force_accelerates_all_and_conserves_the_energy(void **state) {
    (void)state;
    enum { STEPS = 400 };
    static const struct { double force[3]; } gravity = {{0.5, -0.25, 0}};
    struct fluid fluid;
    struct simulation simulation;
    begin(&fluid, &simulation, &mf_uniform_force, &gravity);
    double energy[2];
    for (int n = 0; n < 2; n++) {
        simulation.wants = PAIR_FORCES_AND_SUMS;
        assert_ok(mf_simulation_run(&simulation, n == 0 ? 1 : STEPS - 1));
        energy[n] =
            simulation.sums.energy + 0.5 * mf_particles_square_velocities(&simulation.particles);
    }
    const double time = STEPS * fluid.setup.time_step;
    for (int d = 0; d < 3; d++) {
        double momentum = 0;
        for (size_t k = 0; k < COUNT; k++)
            momentum += simulation.particles.velocity[d][k];
        assert_close(momentum, COUNT * gravity.force[d] * time, 1e-10 * COUNT);
    }
    // Each has got 2.5 k_B T_0 of work, most of them on a way through the boundary; the fluid alone
    // keeps its energy to 0.01 of it at this time step.
    assert_close(energy[1] / COUNT, energy[0] / COUNT, 0.01);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// Free particles at rest: each is accelerated as the wave says, and all together not at all.
static void test_shear_wave_accelerates_by_a_cosine_and_conserves_the_momentum(void **state) {
    (void)state;
    static const double acceleration = 0.7;
    struct fluid fluid;
    struct simulation simulation;
    double momentum = 0, mean = 0;
    begin(&fluid, &simulation, &mf_shear_wave, &acceleration);
    struct particles *particles = &simulation.particles;
    const double edge = fluid.setup.box.length[2];
    simulation.setup.potential = simulation.law.potential = NULL;
    assert_ok(mf_simulation_compute_forces(&simulation, 0));
    for (size_t k = 0; k < COUNT; k++)
        mean += acceleration * cos(2 * M_PI * particles->position[2][k] / edge) / COUNT;
    for (size_t k = 0; k < COUNT; k++) {
        momentum += particles->force[0][k];
        assert_close(particles->force[0][k],
                     acceleration * cos(2 * M_PI * particles->position[2][k] / edge) - mean, 1e-12);
        assert_identical(particles->force[2][k], 0);
    }
    assert_close(momentum, 0, 1e-12);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// A push that grows with every step: it has a state.
struct push {
    double size;
};

static enum status add_push(const void *parameters, void *state,
                            const struct interaction_pass *pass) {
    const double *growth = parameters;
    struct push *push = state;
    push->size += *growth;
    for (size_t k = 0; k < pass->particles->count; k++)
        pass->particles->force[0][k] += push->size * (pass->particles->id[k] % 2 ? 1 : -1);
    return STATUS_OK;
}

static size_t push_spans(void *state, struct memory_span *spans) {
    spans[0] = (struct memory_span){state, sizeof(struct push)};
    return 1;
}

static const struct interaction growing_push = {.name = "growing-push",
                                                .state_size = sizeof(struct push),
                                                .add = add_push,
                                                .spans = push_spans};

/// Velocity Verlet whose particles are also turned, by an angle that grows: it has a state, too.
static enum status turn(struct simulation *simulation) {
    double *angle = simulation->integrator_state;
    struct particles *particles = &simulation->particles;
    *angle += 1e-3;
    mf_simulation_kick_and_drift(simulation);
    TRY(mf_simulation_compute_forces(simulation, 0));
    mf_simulation_kick(simulation);
    for (size_t k = 0; k < particles->count; k++) {
        const double x = particles->velocity[0][k], y = particles->velocity[1][k];
        particles->velocity[0][k] = x * cos(*angle) - y * sin(*angle);
        particles->velocity[1][k] = x * sin(*angle) + y * cos(*angle);
    }
    return STATUS_OK;
}

static size_t angle_spans(void *state, struct memory_span *spans) {
    spans[0] = (struct memory_span){state, sizeof(double)};
    return 1;
}

static const struct field no_fields[] = {FIELD_END};
static const struct integrator turning = {.name = "turning",
                                          .fields = no_fields,
                                          .state_size = sizeof(double),
                                          .spans = angle_spans,
                                          .step = turn};

/// Both go on, one of them after having been saved and loaded.
static void check_restart(const struct simulation_setup *setup) {
    struct simulation whole, pieces;
    assert_ok(mf_simulation_init(&whole, setup, NULL));
    assert_ok(mf_simulation_init(&pieces, setup, NULL));
    assert_ok(mf_simulation_run(&whole, 60));
    assert_ok(mf_simulation_run(&pieces, 25));
    restart_simulation(&pieces);
    assert_ok(mf_simulation_run(&pieces, 35));
    restart_assert_same(&whole, &pieces);
    mf_simulation_clear(&whole);
    mf_simulation_clear(&pieces);
}

static void test_restart_goes_on_with_the_same_bits_when_an_interaction_has_state(void **state) {
    (void)state;
    static const double growth = 0.01;
    struct fluid fluid;
    fluid_groot_warren(&fluid, COUNT, 0.01);
    fluid.setup.interaction[0] = (struct interaction_choice){&growing_push, &growth};
    fluid.setup.interactions = 1;
    check_restart(&fluid.setup);
    fluid_clear(&fluid);
}

static void test_restart_goes_on_with_the_same_bits_when_an_integrator_has_state(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, COUNT, 0.01);
    fluid.setup.omega = NULL;
    fluid.setup.integrator = &turning;
    check_restart(&fluid.setup);
    fluid_clear(&fluid);
}

static void test_pairs_come_first_and_too_many_interactions_are_refused(void **state) {
    (void)state;
    static const double growth = 0;
    const struct interaction_choice choice = {&growing_push, &growth};
    struct fluid fluid;
    struct simulation simulation;
    char refusal[64];
    snprintf(refusal, sizeof refusal, "growing-push: there are %d interactions",
             SIMULATION_MAX_INTERACTIONS);
    fluid_groot_warren(&fluid, COUNT, 0.01);
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    assert_int_equal(simulation.interactions, 1);
    assert_ptr_equal(simulation.interaction[0].choice.kind, &mf_pairs);
    while (simulation.interactions < SIMULATION_MAX_INTERACTIONS)
        assert_ok(mf_simulation_add_interaction(&simulation, &choice));
    assert_fails(mf_simulation_add_interaction(&simulation, &choice), STATUS_BAD_INPUT, refusal);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// Counts the pairs within a range of its own, by the list.
static double wide(const void *parameters) {
    return *(const double *)parameters;
}

static void count_batch(void *context, const float *squared, size_t count) {
    (void)squared;
    *(size_t *)context += count;
}

static enum status count_pairs(const void *parameters, void *state,
                               const struct interaction_pass *pass) {
    size_t *pairs = state;
    *pairs = 0;
    mf_neighbours_visit_distances(pass->neighbours, pass->particles, wide(parameters), count_batch,
                                  pairs);
    return STATUS_OK;
}

static const struct interaction counting = {
    .name = "counting", .state_size = sizeof(size_t), .range = wide, .add = count_pairs};

static size_t count_by_double_loop(const struct particles *particles, double range) {
    size_t pairs = 0;
    for (size_t i = 0; i < particles->count; i++)
        for (size_t j = 0; j < i; j++) {
            double square = 0;
            for (int d = 0; d < 3; d++)
                square += pow(box_nearest(particles->position[d][i] - particles->position[d][j],
                                          particles->box.length[d]),
                              2);
            pairs += square < range * range;
        }
    return pairs;
}

/// Farther than the pairs, nearer than them, and without any.
static void test_list_is_complete_for_the_range_of_an_interaction(void **state) {
    (void)state;
    static const double ranges[] = {1.7, 0.6, 1.7};
    for (int n = 0; n < 3; n++) {
        struct fluid fluid;
        struct simulation simulation;
        fluid_groot_warren(&fluid, 375, 0.01);
        if (n == 2)
            fluid.setup.potential = fluid.setup.omega = NULL;
        const double without = mf_simulation_range(&fluid.setup);
        fluid.setup.interaction[0] = (struct interaction_choice){&counting, &ranges[n]};
        fluid.setup.interactions = 1;
        assert_close(mf_simulation_range(&fluid.setup), fmax(without, ranges[n]), 0);
        assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
        for (int piece = 0; piece < 20; piece++) {
            assert_ok(mf_simulation_run(&simulation, 5));
            assert_int_equal(*(const size_t *)simulation.interaction[1].state,
                             count_by_double_loop(&simulation.particles, ranges[n]));
        }
        mf_simulation_clear(&simulation);
        fluid_clear(&fluid);
    }
}

/// A simulation that blows up says so if a potential from outside is why, and only then.
static void test_unstable_names_the_interaction_that_most_of_the_force_is_from(void **state) {
    (void)state;
    const struct {
        double stiffness, time_step;
        const char *words;
    } cases[] = {
        {0.1, 1, "soften the potential"}, // at most 0.2 of forces of the pairs of about 100
        {5000, 0.01, "most of it from \"harmonic-trap\""},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct fluid fluid;
        struct simulation simulation;
        const struct numbers numbers = {
            {cases[k].stiffness, cases[k].stiffness, cases[k].stiffness}};
        begin(&fluid, &simulation, &mf_harmonic_trap, &numbers);
        simulation.setup.time_step = cases[k].time_step;
        assert_fails(mf_simulation_run(&simulation, 20), STATUS_UNSTABLE, cases[k].words);
        mf_simulation_clear(&simulation);
        fluid_clear(&fluid);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_interaction_forces_are_minus_the_slope_of_their_energy),
        cmocka_unit_test(test_uniform_force_accelerates_all_and_conserves_the_energy),
        cmocka_unit_test(test_shear_wave_accelerates_by_a_cosine_and_conserves_the_momentum),
        cmocka_unit_test(test_restart_goes_on_with_the_same_bits_when_an_interaction_has_state),
        cmocka_unit_test(test_restart_goes_on_with_the_same_bits_when_an_integrator_has_state),
        cmocka_unit_test(test_pairs_come_first_and_too_many_interactions_are_refused),
        cmocka_unit_test(test_list_is_complete_for_the_range_of_an_interaction),
        cmocka_unit_test(test_unstable_names_the_interaction_that_most_of_the_force_is_from),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
