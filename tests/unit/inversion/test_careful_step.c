// SPDX-License-Identifier: GPL-3.0-or-later
//
// The steps far from the targets: to first order they meet a pressure that is asked for, of one
// type and of several, and of molecules whose structure is not known they are Boltzmann
// inversion's.
#include "inversion/inversion.h"
#include "inversion/inversions.h"
#include "inversion/method_steps.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

enum { PARTICLES = 300, BINS = 20, MAX_PAIRS = 6, TYPES = 3 };

static void ignore(void *context, const struct inverse_progress *progress) {
    (void)context, (void)progress;
}

/// One iteration from −k_B T ln g, of a target that is softer than the fluid's.
static void iterate(struct inversion *inversion, const struct inverse_method *method,
                    const struct simulation_setup *scene, const double *pressure) {
    static double g[MAX_PAIRS * BINS], error[MAX_PAIRS * BINS], pressure_error = 0.1;
    const struct inverse_listener listener = {ignore, NULL};
    const struct rdf_bins bins = {0, 0.05, BINS};
    const size_t count = (size_t)mf_composition_pairs(&scene->composition) * BINS;
    for (size_t n = 0; n < count; n++) {
        const double r = mf_rdf_bins_centre(&bins, n % BINS);
        g[n] = 1 - 0.8 * exp(-4 * r * r);
        error[n] = 1e-4;
    }
    static struct inverse_problem problem;
    problem = (struct inverse_problem){
        .targets = {.bins = bins,
                    .target[TARGET_RDF] = {.count = count, .value = g, .error = error},
                    .target[TARGET_PRESSURE] = {.count = pressure ? 1 : 0,
                                                .value = pressure,
                                                .error = &pressure_error}},
        .unknown[UNKNOWN_POTENTIAL] = {.wanted = true},
        .scene = *scene,
        .core_threshold = 1e-3,
        .core_stiffness = 2000,
        .seed = 5,
        .threads = 2};
    struct inversion_parameters settings = {.replicas = 4,
                                            .equilibration = 10,
                                            .samples = 40,
                                            .every = 1,
                                            .iterations = 3,
                                            .damping = 1,
                                            .precision = 1,
                                            .start = INVERSION_FROM_MEAN_FORCE,
                                            .sampler = SAMPLER_AUTO};
    struct inverse_step step;
    *inversion = (struct inversion){0};
    assert_ok(mf_inversion_create(inversion, method, &problem, &settings));
    assert_ok(mf_inversion_iterate(inversion, &step, &listener));
    assert_true(inversion->course.progress.best.distance[TARGET_RDF].rms > 0.01);
}

static void check_pressure(const struct inverse_method *method,
                           const struct simulation_setup *scene) {
    static struct inversion inversion;
    static const double wanted = 20;
    double change = 0;
    iterate(&inversion, method, scene, &wanted);
    const struct inversion_state *state = inversion.state;
    const struct potential_grid *grid = &state->grid;
    for (size_t a = 0; a < grid->known; a++)
        change += state->bulk.slope[a] * inversion.course.best.step[grid->known_point[a]];
    print_message("%s of %zu pair types: from %.3f to %.3f\n", method->name, grid->pairs,
                  state->bulk.value, state->bulk.value + change);
    assert_true(fabs(state->bulk.value - wanted) > 1);
    assert_close(state->bulk.value + change, wanted, 1e-6);
    mf_inversion_destroy(&inversion);
}

static void test_careful_steps_meet_the_pressure(void **state) {
    (void)state;
    struct fluid fluid;
    fluid_groot_warren(&fluid, PARTICLES, 0.01);
    check_pressure(&mf_ibi, &fluid.setup);
    check_pressure(&mf_hnc, &fluid.setup);
    check_pressure(&mf_automatic, &fluid.setup);
    fluid_clear(&fluid);
    fluid_mixture(&fluid, PARTICLES, 0.01);
    check_pressure(&mf_automatic, &fluid.setup);
    fluid_clear(&fluid);
}

/// Without Ω, S of the hypernetted chain is that of single beads.
static void
test_careful_step_of_molecules_that_are_not_known_is_boltzmann_inversions(void **state) {
    static const struct molecules_number bond[] = {{"k", 120}, {"length", 0.6}, {NULL, 0}};
    static const int type[] = {0, 0, 0, 0, 0, 0};
    static struct inversion inversion;
    static struct molecules molecules;
    double step[BINS + 1] = {0};
    struct fluid fluid;
    (void)state;
    const struct composition composition =
        molecules_topology(&molecules.topology, molecules_chain(PARTICLES / 6, type, 6, 0, 2),
                           (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&molecules, BONDED_BOND, &mf_bond_harmonic, bond);
    fluid_groot_warren(&fluid, PARTICLES, 0.004);
    molecules_enter(&fluid.setup, &molecules, &composition);
    iterate(&inversion, &mf_automatic, &fluid.setup, NULL);
    const struct potential_grid *grid = &inversion.state->grid;
    const struct inversion_rule *rule = mf_automatic.own;
    for (int knows = 1; knows >= 0; knows--) {
        double off = 0, extra[INVERSION_OWN_COLUMNS] = {0};
        inversion.state->inside.min *= knows;
        assert_ok(rule->update(&inversion, extra));
        mf_ibi_step(inversion.state, step);
        for (size_t a = 0; a < grid->known; a++)
            off = fmax(off, fabs(inversion.course.step[grid->known_point[a]] -
                                 step[grid->known_point[a]]));
        assert_true(knows ? off > 0.01 : off < 1e-12);
    }
    mf_inversion_destroy(&inversion);
    mf_molecules_clear(&molecules);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_careful_steps_meet_the_pressure),
        cmocka_unit_test(test_careful_step_of_molecules_that_are_not_known_is_boltzmann_inversions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
