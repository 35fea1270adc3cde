// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/rng.h"
#include "curves/formula.h"
#include "inversion/inversion.h"
#include "inversion/inversions.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdlib.h>

enum { BINS = 125 };

static const double noise = 0.02;

struct made {
    struct fluid fluid;
    double g[BINS], error[BINS], exact[BINS];
    struct inverse_problem problem;
    struct inversion_parameters settings;
    struct inversion inversion;
};

/// A target exp(−Φ/k_B T), as of a gas, with normal noise of 2 % and its error.
static void make(struct made *made, int start) {
    *made = (struct made){0};
    fluid_lennard_jones(&made->fluid, 500, 0.004);
    made->fluid.setup.box = mf_box_cube(500 / 0.1);
    const struct rdf_bins bins = {0, 2.5 / BINS, BINS};
    const double temperature = made->fluid.setup.temperature;
    for (int k = 0; k < BINS; k++) {
        double normal[4];
        mf_rng_normal4(mf_rng_philox(5, RNG_INITIAL, (uint32_t)k, 0, 0), normal);
        mf_table_evaluate(&made->fluid.potential, mf_rdf_bins_centre(&bins, (size_t)k),
                          &made->exact[k], NULL, NULL);
        const double g = exp(-made->exact[k] / temperature);
        made->g[k] = g * (1 + noise * normal[0]);
        made->error[k] = noise * g;
    }
    made->problem =
        (struct inverse_problem){.targets = {.bins = bins,
                                             .target[TARGET_RDF] = {.count = BINS,
                                                                    .value = made->g,
                                                                    .error = made->error,
                                                                    .weight = 0}},
                                 .unknown[UNKNOWN_POTENTIAL] = {.wanted = true},
                                 .scene = made->fluid.setup,
                                 .core_threshold = 1e-3,
                                 .core_stiffness = 2000,
                                 .seed = 5,
                                 .threads = 1};
    made->settings = (struct inversion_parameters){.replicas = 2,
                                                   .equilibration = 10,
                                                   .samples = 8,
                                                   .every = 1,
                                                   .iterations = 2,
                                                   .damping = 1,
                                                   .precision = 1,
                                                   .start = start};
}

static void clear(struct made *made) {
    mf_inversion_destroy(&made->inversion);
    fluid_clear(&made->fluid);
}

static void test_inversion_start_is_smooth_within_the_errors_of_the_target(void **state) {
    (void)state;
    struct made made;
    double off = 0, rough = 0, raw = 0;
    make(&made, INVERSION_FROM_MEAN_FORCE);
    assert_ok(mf_inversion_create(&made.inversion, &mf_imc, &made.problem, &made.settings));
    const struct inversion *inversion = &made.inversion;
    const double temperature = made.problem.scene.temperature;
    // Beyond the minimum, where the truth itself is nearly straight within three bins.
    for (size_t k = 75; k + 1 < BINS; k++) {
        const double *phi = inversion->course.phi + k;
        const double *g = made.g + k;
        rough += pow(phi[-1] - 2 * phi[0] + phi[1], 2);
        raw += pow(temperature * log(g[-1] * g[1] / (g[0] * g[0])), 2);
    }
    for (size_t a = 0; a < inversion->state->grid.known; a++) {
        const size_t bin = inversion->state->grid.known_bin[a];
        off += pow(
            (inversion->course.phi[bin] + temperature * log(made.g[bin])) / temperature / noise, 2);
    }
    off = sqrt(off / (double)inversion->state->grid.known);
    print_message("off by %.2f standard errors, rough %.3g of the raw\n", off, sqrt(rough / raw));
    assert_true(off > 0.5 && off < 1.1);
    // Measured: 0.236, and the square of it here.
    assert_true(rough < 0.1 * raw);
    clear(&made);
}

static void test_inversion_start_is_the_target_as_it_stands_without_errors(void **state) {
    (void)state;
    struct made made;
    make(&made, INVERSION_FROM_MEAN_FORCE);
    made.error[BINS - 1] = 0;
    assert_ok(mf_inversion_create(&made.inversion, &mf_imc, &made.problem, &made.settings));
    for (size_t k = 60; k < BINS; k++)
        assert_float_equal(made.inversion.course.phi[k],
                           -made.problem.scene.temperature * log(made.g[k]), 1e-12);
    clear(&made);
}

static void test_inversion_start_is_poor_when_it_is_of_no_use_or_leads_away(void **state) {
    (void)state;
    struct made made;
    make(&made, INVERSION_FROM_HNC);
    assert_ok(mf_inversion_create(&made.inversion, &mf_imc, &made.problem, &made.settings));
    const struct inversion *inversion = &made.inversion;
    struct inversion_progress *progress = &made.inversion.course.progress;
    assert_false(mf_inversion_start_is_poor(inversion, true));
    made.inversion.assessment.useless = true;
    assert_true(mf_inversion_start_is_poor(inversion, false));
    progress->iteration = 1; // a step to where samples do not settle says nothing of the start
    assert_false(mf_inversion_start_is_poor(inversion, false));
    made.inversion.assessment.useless = false;
    assert_false(mf_inversion_start_is_poor(inversion, false)); // another step is in reserve
    progress->damping = 0.5;
    assert_true(mf_inversion_start_is_poor(inversion, false));
    made.inversion.assessment.useless = true;
    assert_false(mf_inversion_start_is_poor(inversion, false));
    made.inversion.assessment.useless = false;
    assert_false(mf_inversion_start_is_poor(inversion, true));
    progress->second_start = true; // it is the other one
    assert_false(mf_inversion_start_is_poor(inversion, false));
    progress->second_start = false;
    progress->iteration = 2;
    assert_false(mf_inversion_start_is_poor(inversion, false));
    progress->iteration = 1;
    made.inversion.parameters.start = INVERSION_FROM_MEAN_FORCE;
    assert_false(mf_inversion_start_is_poor(inversion, false));
    clear(&made);
}

/// Samples of S that scatter about the target's, and their C.
static void sample(struct inversion_state *state, uint32_t seed) {
    enum { SAMPLES = 40 };
    struct comoments *counts = &state->replicas.counts;
    double *numbers = calloc(state->replicas.numbers, sizeof *numbers);
    assert_non_null(numbers);
    mf_comoments_reset(counts);
    for (uint32_t k = 0; k < SAMPLES; k++) {
        for (size_t n = 0; n < state->bins; n++) {
            double normal[4];
            mf_rng_normal4(mf_rng_philox(seed, RNG_INITIAL, (uint32_t)n, k, 0), normal);
            numbers[n] = state->target.counts[n] + sqrt(state->target.ideal[n]) * normal[0];
        }
        mf_comoments_add(counts, numbers);
    }
    state->inefficiency = 1;
    assert_ok(mf_inversion_response_add(state));
    free(numbers);
}

/// A start is left when its samples do not settle, or its first step is too long; where the other
/// one is much farther from the target the fit goes back to it.
static void test_inversion_goes_back_to_a_start_that_was_much_nearer(void **state) {
    static const double first = 0.03, second[] = {0.1, 1.9};
    (void)state;
    for (int k = 0; k < 2; k++) {
        struct made made;
        make(&made, INVERSION_FROM_HNC);
        assert_ok(mf_inversion_create(&made.inversion, &mf_imc, &made.problem, &made.settings));
        struct inversion_progress *progress = &made.inversion.course.progress;
        struct target_distance *distance = made.inversion.assessment.distance;
        const double *phi = made.inversion.course.phi;
        const size_t well = 75;
        const double from_hnc = phi[well];
        progress->iteration = 0;
        made.inversion.assessment.useless = true;
        progress->best.distance[TARGET_RDF] = (struct target_distance){.rms = first, .noise = 0.01};
        assert_ok(mf_inversion_course_go_on(&made.inversion, false));
        const double from_mean_force = phi[well];
        assert_true(fabs(from_mean_force - from_hnc) > 1e-3 * fabs(from_hnc));
        progress->iteration = 2;
        distance[TARGET_RDF] = (struct target_distance){.rms = second[k], .noise = 0.01};
        progress->best.distance[TARGET_RDF] = distance[TARGET_RDF];
        // A second one that does not settle either is lost only if it is not farther.
        const double rms = progress->best.distance[TARGET_RDF].rms;
        bool kept;
        sample(made.inversion.state, 1);
        mf_inversion_assess(made.inversion.state);
        distance[TARGET_RDF] = (struct target_distance){.rms = second[k], .noise = 0.01};
        assert_ok(mf_inversion_equations_fill(&made.inversion.equations, 1));
        made.inversion.assessment.useless = true;
        progress->best.distance[TARGET_RDF].rms = INFINITY;
        assert_ok(mf_inversion_course_accept(&made.inversion, &kept));
        assert_true(!kept && progress->lost == (k == 0));
        made.inversion.assessment.useless = false;
        progress->best.distance[TARGET_RDF].rms = rms;
        assert_ok(mf_inversion_course_go_on(&made.inversion, true));
        assert_true(isinf(progress->best.distance[TARGET_RDF].rms) == (k == 1));
        if (k == 1)
            assert_float_equal(phi[well], from_hnc, 1e-9 * fabs(from_hnc));
        clear(&made);
    }
}

/// A start is smoothed in the memory of C. What stands there afterwards is of no samples, and C
/// after the next ones is theirs alone.
static void test_inversion_second_start_begins_with_no_response_and_no_drifts(void **unused) {
    (void)unused;
    struct made made;
    make(&made, INVERSION_FROM_HNC);
    assert_ok(mf_inversion_create(&made.inversion, &mf_imc, &made.problem, &made.settings));
    struct inversion_state *state = made.inversion.state;
    struct inversion_progress *progress = &made.inversion.course.progress;
    const size_t known = state->grid.known;
    sample(state, 1);
    assert_float_equal(state->response.independent, 40, 1e-12);
    made.inversion.assessment.useless = true; // so that another start is tried
    progress->drifts.near = progress->drifts.met = 1;
    assert_ok(mf_inversion_course_go_on(&made.inversion, false));
    assert_true(progress->second_start);
    assert_int_equal(progress->drifts.near, 0);
    assert_int_equal(progress->drifts.met, 0);
    sample(state, 2);
    for (size_t a = 0; a < known; a++) {
        const size_t bin = state->grid.known_bin[a];
        const double own = mf_comoments_covariance(&state->replicas.counts, bin, bin);
        assert_float_equal(state->response.sampled[a * known + a], own, 1e-9 * own);
    }
    clear(&made);
}

static void test_inversion_create_refuses_a_hole_beyond_the_core(void **state) {
    (void)state;
    struct made made;
    make(&made, INVERSION_FROM_HNC);
    made.g[70] = made.g[71] = 0;
    assert_fails(mf_inversion_create(&made.inversion, &mf_imc, &made.problem, &made.settings),
                 STATUS_BAD_INPUT, "empty at r = 1.41");
    clear(&made);
}

/// What is only to be refused or not needs no more than one sampler.
static void test_inversion_create_makes_one_sampler_for_a_trial(void **state) {
    (void)state;
    struct made made;
    for (int trial = 0; trial <= 1; trial++) {
        make(&made, INVERSION_FROM_MEAN_FORCE);
        made.problem.trial = trial;
        assert_ok(mf_inversion_create(&made.inversion, &mf_imc, &made.problem, &made.settings));
        assert_int_equal(made.inversion.state->replicas.count, trial ? 1 : made.settings.replicas);
        clear(&made);
    }
}

static void ignore(void *context, const struct inverse_progress *progress) {
    (void)context, (void)progress;
}

/// Without a prior the errors would be as many times larger as sqrt(χ²), here 3.
static void test_inversion_band_widens_when_more_than_noise_is_left(void **state) {
    (void)state;
    struct made made;
    struct inverse_step step;
    const struct inverse_listener listener = {ignore, NULL};
    double error[2] = {0}; // mean of all bins
    make(&made, INVERSION_FROM_MEAN_FORCE);
    made.settings.samples = 200; // enough for the data to say more than the prior
    assert_ok(mf_inversion_create(&made.inversion, &mf_imc, &made.problem, &made.settings));
    struct inversion *inversion = &made.inversion;
    assert_ok(mf_inversion_iterate(inversion, &step, &listener));
    for (int left = 0; left < 2; left++) {
        // Of alternating signs, which no ramp removes.
        const double noises = left ? 3 : 0.5;
        for (size_t a = 0; a < inversion->state->grid.known; a++)
            inversion->state->excess[a] =
                (a % 2 ? noises : -noises) * sqrt(inversion->state->variance[a]);
        inversion->assessment.misfit = noises * noises;
        assert_ok(mf_inversion_band_find(inversion));
        const struct potential_grid *grid = &inversion->state->grid;
        for (size_t a = 0; a < grid->known; a++)
            error[left] += inversion->course.band.error[grid->known_point[a]] / (double)grid->known;
    }
    print_message("errors of %.4f and %.4f\n", error[0], error[1]);
    assert_true(error[1] > 1.2 * error[0] && error[1] < 3.01 * error[0]);
    clear(&made);
}

/// An excess that the response makes of a ramp asks for it back, and its errors are not less.
static void test_inversion_band_counts_the_ramp_that_is_asked_for(void **state) {
    (void)state;
    struct made made;
    struct inverse_step step;
    const struct inverse_listener listener = {ignore, NULL};
    const double ramp = 1.5;
    make(&made, INVERSION_FROM_MEAN_FORCE);
    made.settings.samples = 200;
    assert_ok(mf_inversion_create(&made.inversion, &mf_imc, &made.problem, &made.settings));
    struct inversion *inversion = &made.inversion;
    const struct potential_grid *grid = &inversion->state->grid;
    assert_ok(mf_inversion_iterate(inversion, &step, &listener));
    for (size_t a = 0; a < grid->known; a++) {
        inversion->state->excess[a] = 0;
        for (size_t b = 0; b < grid->known; b++)
            inversion->state->excess[a] +=
                inversion->state->response.covariance[a * grid->known + b] * ramp *
                mf_potential_grid_ramp(grid, grid->known_point[b]) / made.problem.scene.temperature;
    }
    // As exact a target and as many samples that the data, and not the prior, know the ramp.
    for (size_t a = 0; a < grid->known; a++) {
        inversion->state->variance[a] /= 100;
        inversion->state->target.error[grid->known_bin[a]] /= 10;
    }
    // The prior asks for nothing.
    memcpy(inversion->course.reference, inversion->course.phi, grid->points * sizeof(double));
    assert_ok(mf_inversion_equations_fill(&inversion->equations, 1));
    inversion->assessment.misfit = 1;
    assert_ok(mf_inversion_band_find(inversion));
    const struct inverse_ramp found = inversion->course.band.ramp;
    print_message("ramp %.3f, asked for %.3f, error %.3f\n", ramp, found.drift, found.error);
    assert_true(fabs(found.drift - ramp) < 0.2 * ramp);
    assert_true(found.error > fabs(found.drift));
    // What the way is compared with is what the data know of it, whatever they ask for: twice the
    // excess asks for twice the way, but for the end, at which the potential has a jump.
    const struct inversion_band_drifts once = inversion->course.band.drifts;
    for (size_t a = 0; a < grid->known; a++)
        inversion->state->excess[a] *= 2;
    assert_ok(mf_inversion_band_find(inversion));
    const struct inversion_band_drifts twice = inversion->course.band.drifts;
    print_message("way %.3f of %.3f, and %.3f of %.3f\n", once.ramp.drift, once.ramp.open,
                  twice.ramp.drift, twice.ramp.open);
    assert_close_relative(twice.ramp.drift, 2 * once.ramp.drift, 0.03);
    assert_close_relative(twice.ramp.open, once.ramp.open, 1e-6);
    assert_close_relative(twice.bulk[0].drift, 2 * once.bulk[0].drift, 0.03);
    assert_close_relative(twice.bulk[0].open, once.bulk[0].open, 1e-6);
    clear(&made);
}

/// Of two states with other slopes of the pressure the band tells of the one that is farther from
/// having settled, whichever is the first.
static void test_inversion_band_looks_at_the_pressures_of_all_states(void **state) {
    (void)state;
    struct made made;
    struct inverse_step step;
    const struct inverse_listener listener = {ignore, NULL};
    static struct inversion_state states[2];
    struct inversion_band_drift farthest[2], drifts[2];
    bool kept;
    make(&made, INVERSION_FROM_MEAN_FORCE);
    made.settings.samples = 200;
    assert_ok(mf_inversion_create(&made.inversion, &mf_imc, &made.problem, &made.settings));
    struct inversion *inversion = &made.inversion;
    struct inversion_state *first = inversion->state;
    const size_t known = first->grid.known;
    double *other = calloc(known, sizeof *other);
    assert_non_null(other);
    assert_ok(mf_inversion_iterate(inversion, &step, &listener));
    for (size_t a = 0; a < known; a++) {
        first->bulk.slope[a] = mf_potential_grid_ramp(&first->grid, first->grid.known_point[a]);
        other[a] = a == known / 2;
    }
    double *slope[2] = {first->bulk.slope, other};
    states[0] = states[1] = *first;
    states[1].bins = 0; // room is for the samples of one
    inversion->state = states;
    inversion->states = 2;
    for (int n = 0; n < 2; n++) {
        states[0].bulk.slope = slope[n];
        states[1].bulk.slope = slope[1 - n];
        assert_ok(mf_inversion_band_find(inversion));
        drifts[n] = inversion->course.band.drifts.bulk[0];
        farthest[n] = mf_inversion_band_farthest(inversion);
    }
    // A verification judges each state by the noise of its own samples.
    states[0].assessment.distance[TARGET_RDF].noise = 0.01;
    states[1].assessment.distance[TARGET_RDF].noise = 0.03;
    assert_ok(mf_inversion_course_accept(inversion, &kept));
    assert_close(inversion->course.progress.best.noise[0], 0.01, 1e-15);
    assert_close(inversion->course.progress.best.noise[1], 0.03, 1e-15);
    inversion->state = first;
    inversion->states = 1;
    free(other);
    const double ratio[2] = {fabs(drifts[0].drift) / drifts[0].open,
                             fabs(drifts[1].drift) / drifts[1].open};
    const int farther = ratio[1] > ratio[0];
    print_message("ways of %.3f and %.3f errors\n", ratio[0], ratio[1]);
    for (int n = 0; n < 2; n++) {
        assert_close(farthest[n].drift, drifts[farther].drift, 1e-9);
        assert_close(farthest[n].open, drifts[farther].open, 1e-9);
    }
    clear(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_inversion_start_is_smooth_within_the_errors_of_the_target),
        cmocka_unit_test(test_inversion_start_is_the_target_as_it_stands_without_errors),
        cmocka_unit_test(test_inversion_start_is_poor_when_it_is_of_no_use_or_leads_away),
        cmocka_unit_test(test_inversion_band_widens_when_more_than_noise_is_left),
        cmocka_unit_test(test_inversion_band_counts_the_ramp_that_is_asked_for),
        cmocka_unit_test(test_inversion_goes_back_to_a_start_that_was_much_nearer),
        cmocka_unit_test(test_inversion_second_start_begins_with_no_response_and_no_drifts),
        cmocka_unit_test(test_inversion_create_refuses_a_hole_beyond_the_core),
        cmocka_unit_test(test_inversion_create_makes_one_sampler_for_a_trial),
        cmocka_unit_test(test_inversion_band_looks_at_the_pressures_of_all_states),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
