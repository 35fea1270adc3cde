// SPDX-License-Identifier: GPL-3.0-or-later
//
// What samples scatter by along what g hardly sees, of samples that are made up: the steps of many
// fits, each with samples of its own, scatter by what the band says of them.
#include "base/statistics.h"
#include "inversion/inversion.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_linalg.h>
#include <gsl/gsl_randist.h>
#include <math.h>
#include <string.h>

enum { BINS = 12, REPLICAS = 8, COUNT = 320, DRAWS = 2000 };

static const double width = 0.1, temperature = 1.2;

/// One state of one type of beads with an exact target: the counts of samples scatter by 1, each by
/// itself.
struct made {
    struct inverse_problem problem;
    struct inversion_state state;
    struct inversion inversion;
    double g[BINS], exact[BINS], response[BINS * BINS], excess[BINS], variance[BINS], slope[BINS],
        phi[BINS + 1], reference[BINS + 1], weight[BINS], inefficiency[BINS], open[BINS];
    double block[REPLICAS][REPLICAS_BLOCKS * BINS], mean[BINS], comoment[BINS * BINS];
};

static void fill(struct made *made) {
    made->problem.scene.temperature = temperature;
    made->problem.targets.bins = (struct rdf_bins){0, width, BINS};
    made->problem.targets.target[TARGET_RDF] = (struct target){.count = BINS, .value = made->g};
    for (size_t k = 0; k < BINS; k++) {
        made->g[k] = made->inefficiency[k] = 1;
        made->weight[k] = 1 - ((double)k + 0.5) / BINS;
        made->variance[k] = 1.0 / COUNT;
        made->comoment[k * (BINS + 1)] = COUNT;
        for (size_t l = 0; l < BINS; l++)
            made->response[k * BINS + l] = (k == l) - (k + 1 == l ? 0.9 : 0);
    }
}

static void make(struct made *made) {
    struct inversion_state *state = &made->state;
    *made = (struct made){0};
    fill(made);
    assert_ok(mf_potential_grid_init(&state->grid, &made->problem));
    assert_int_equal(state->grid.known, BINS);
    state->problem = &made->problem;
    state->response.covariance = made->response;
    state->response.independent = 1;
    state->target.error = made->exact;
    state->excess = made->excess;
    state->variance = made->variance;
    state->inefficiency = 1;
    state->bin_inefficiency = made->inefficiency;
    state->bulk.slope = made->slope;
    state->open.weight = made->open;
    state->replicas = (struct replicas){
        .bins = BINS,
        .numbers = BINS,
        .count = REPLICAS,
        .counts = {.size = BINS, .count = COUNT, .mean = made->mean, .comoment = made->comoment}};
    for (size_t k = 0; k < REPLICAS; k++)
        state->replicas.member[k].block = made->block[k];
    made->inversion =
        (struct inversion){.problem = &made->problem,
                           .state = state,
                           .states = 1,
                           .course = {.phi = made->phi, .reference = made->reference}};
    assert_ok(mf_inversion_band_init(&made->inversion.course.band, BINS, BINS + 1));
    assert_ok(mf_inversion_equations_init(&made->inversion.equations, state, 1));
}

static void clear(struct made *made) {
    mf_inversion_equations_clear(&made->inversion.equations);
    mf_inversion_band_clear(&made->inversion.course.band);
    mf_potential_grid_clear(&made->state.grid);
}

/// Samples of all replicas, whose counts share a slow number of this size along the ramp: it stays
/// as it is within a replica.
static void draw(struct made *made, gsl_rng *rng, double slow) {
    memset(made->mean, 0, sizeof made->mean);
    for (size_t k = 0; k < REPLICAS; k++) {
        const double own = gsl_ran_gaussian(rng, slow);
        for (size_t n = 0; n < REPLICAS_BLOCKS * BINS; n++) {
            const double quick = sqrt(REPLICAS * REPLICAS_BLOCKS / (double)COUNT);
            made->block[k][n] = gsl_ran_gaussian(rng, quick) + own * made->weight[n % BINS];
            made->mean[n % BINS] += made->block[k][n] / (REPLICAS * REPLICAS_BLOCKS);
        }
    }
    memcpy(made->excess, made->mean, sizeof made->excess);
}

/// A of the step that the excess asks for, by elimination of the normal equations.
static double find_step(const struct made *made) {
    int sign;
    double ramp = 0;
    gsl_matrix *prior = gsl_matrix_alloc(2 * BINS - 1, BINS), *all = gsl_matrix_calloc(BINS, BINS);
    gsl_vector *right = gsl_vector_calloc(BINS), *x = gsl_vector_alloc(BINS);
    gsl_permutation *order = gsl_permutation_alloc(BINS);
    mf_imc_solve_prior(&made->inversion.equations.system, prior);
    for (size_t k = 0; k < BINS; k++)
        for (size_t l = 0; l < BINS; l++) {
            double sum = 0;
            for (size_t n = 0; n < BINS; n++)
                sum += made->response[n * BINS + k] * made->response[n * BINS + l] * COUNT;
            for (size_t n = 0; n < 2 * BINS - 1; n++)
                sum += gsl_matrix_get(prior, n, k) * gsl_matrix_get(prior, n, l);
            gsl_matrix_set(all, k, l, sum / (temperature * temperature));
            *gsl_vector_ptr(right, k) +=
                made->response[l * BINS + k] * made->excess[l] * COUNT / temperature;
        }
    gsl_linalg_LU_decomp(all, order, &sign);
    gsl_linalg_LU_solve(all, order, right, x);
    for (size_t k = 0; k < BINS; k++)
        ramp += made->weight[k] * gsl_vector_get(x, k);
    gsl_matrix_free(prior);
    gsl_matrix_free(all);
    gsl_vector_free(right);
    gsl_vector_free(x);
    gsl_permutation_free(order);
    return ramp;
}

/// w·Σ w.
static double find_variance(const struct made *made) {
    double variance = 0;
    for (size_t a = 0; a < BINS; a++)
        for (size_t b = 0; b < BINS; b++)
            variance += made->weight[a] * made->weight[b] *
                        made->inversion.course.band.covariance[a * BINS + b];
    return variance;
}

/// What the samples add to the variance of A.
static double add(struct made *made) {
    struct inversion_band *band = &made->inversion.course.band;
    assert_ok(mf_inversion_equations_fill(&made->inversion.equations, 1));
    assert_ok(mf_inversion_band_covariance(&made->inversion.equations.system, 1, band->inverse,
                                           &band->ramp.directions));
    for (size_t a = 0; a < BINS; a++)
        for (size_t b = 0; b < BINS; b++)
            band->covariance[a * BINS + b] = a == b;
    made->state.work.memory = 3;
    const double before = find_variance(made);
    assert_ok(mf_inversion_band_add_samples(&made->inversion, 1, made->weight));
    return find_variance(made) - before;
}

/// Of many fits: how A scatters, what the samples add to its variance on average, and the memory.
struct seen {
    double scatter, added, memory;
};

static struct seen look(double slow) {
    struct made made;
    struct running_mean ramps = {0}, added = {0}, memory = {0};
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    make(&made);
    for (int k = 0; k < DRAWS; k++) {
        draw(&made, rng, slow);
        mf_statistics_add(&ramps, find_step(&made));
        mf_statistics_add(&added, add(&made));
        mf_statistics_add(&memory, made.state.work.memory);
    }
    clear(&made);
    gsl_rng_free(rng);
    return (struct seen){ramps.squares / (ramps.count - 1), added.mean, memory.mean};
}

static void test_band_has_the_scatter_of_slow_samples(void **unused) {
    (void)unused;
    const struct seen quick = look(0), slow = look(0.5);
    print_message(
        "variance of A: %.3g of quick samples, of which %.3g is added; %.3g of slow ones, "
        "%.3g; memory %.3g, %.3g\n",
        quick.scatter, quick.added, slow.scatter, slow.added, quick.memory, slow.memory);
    assert_true(slow.scatter > 5 * quick.scatter); // else the case is none
    // The larger of two scatters of quick samples is found, by 7 and by 31 degrees of freedom.
    const double needless = quick.added / quick.scatter;
    assert_true(needless > 0.1 && needless < 0.3);
    assert_close_relative(quick.scatter + slow.added, slow.scatter, 0.07);
    assert_true(quick.memory < 2 * 3 && slow.memory > 4 * 3);
}

/// All samples together, those of iterations before with the present ones, scatter by less.
static void test_pooled_samples_scatter_by_less(void **unused) {
    (void)unused;
    struct made made;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    make(&made);
    draw(&made, rng, 0.5);
    const double alone = add(&made);
    const double noise = mf_inversion_band_noise(&made.state).noise;
    assert_close_relative(noise, made.state.open.samples / made.state.open.rest, 1e-9);
    made.state.pool.samples = 2 * COUNT;
    assert_close(add(&made), alone / 2, 1e-9);
    made.state.pool.samples = COUNT; // before the samples are added to it
    assert_close_relative(mf_inversion_band_noise(&made.state).noise * made.state.open.rest,
                          made.state.open.samples, 1e-9);
    clear(&made);
    gsl_rng_free(rng);
}

/// Each replica has seen its slow number once: more samples are wanted as long as these leave half
/// of what all else does.
static void test_what_each_replica_has_seen_once_wants_more_samples(void **unused) {
    static const double ratio[] = {0.8, 0.4};
    (void)unused;
    struct made made;
    gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
    make(&made);
    draw(&made, rng, 5);
    add(&made);
    for (size_t k = 0; k < 2; k++) {
        made.state.open.rest *= mf_inversion_band_noise(&made.state).noise / ratio[k];
        const struct inverse_doubling found = mf_inversion_band_noise(&made.state);
        assert_close_relative(found.noise, ratio[k], 1e-9);
        assert_true((found.wanted < found.noise) == (ratio[k] > 0.5));
    }
    clear(&made);
    gsl_rng_free(rng);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_band_has_the_scatter_of_slow_samples),
        cmocka_unit_test(test_pooled_samples_scatter_by_less),
        cmocka_unit_test(test_what_each_replica_has_seen_once_wants_more_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
