// SPDX-License-Identifier: GPL-3.0-or-later
//
// The coarse part of a step: of an ideal response it is Boltzmann inversion's, of many samples
// Newton's, and what coefficients cannot make is left as it is.
#include "base/rng.h"
#include "inversion/inversion_low_rank.h"
#include "inversion/inversion_state.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_eigen.h>
#include <math.h>

enum { BINS = 12, CORE = 2, KNOWN = BINS - CORE };

/// An inversion of one potential whose samples have a covariance C = D^½(1 + w wᵀ)D^½ scaled by
/// `softness`, with D the counts of the target.
struct made {
    struct inverse_problem problem;
    struct inversion_state state;
    double g[BINS], counts[BINS], error[BINS], covariance[KNOWN * KNOWN], step[BINS + 1];
};

static void make(struct made *made, size_t coefficients, double samples, double softness,
                 double collective) {
    struct inversion_state *state = &made->state;
    *made = (struct made){
        .problem = {.scene = {.temperature = 1.5}, .core_threshold = 1e-3, .core_stiffness = 2000}};
    for (size_t k = 0; k < BINS; k++) {
        made->g[k] = k < CORE ? 0 : 1;
        made->counts[k] = 5 + (double)(k * k);
    }
    made->problem.targets.bins = (struct rdf_bins){0, 0.1, BINS};
    made->problem.targets.target[TARGET_RDF] = (struct target){.count = BINS, .value = made->g};
    assert_ok(mf_potential_grid_init(&state->grid, &made->problem));
    assert_int_equal(state->grid.known, KNOWN);
    for (size_t a = 0; a < KNOWN; a++)
        for (size_t b = 0; b < KNOWN; b++)
            made->covariance[a * KNOWN + b] =
                softness * sqrt(made->counts[a + CORE] * made->counts[b + CORE]) *
                ((a == b) + collective * cos((double)a) * cos((double)b));
    state->problem = &made->problem;
    state->response.sampled = made->covariance;
    state->target.counts = made->counts;
    state->target.error = made->error;
    state->inefficiency = 1;
    state->replicas.counts.count = samples;
    assert_ok(mf_inversion_basis_init(&state->low_rank, &state->grid,
                                      &(struct inversion_basis_size){(int64_t)coefficients, 1}));
    for (size_t k = CORE; k <= BINS; k++)
        made->step[k] = sin(1.7 * (double)k);
}

static void clear(struct made *made) {
    mf_inversion_basis_clear(&made->state.low_rank);
    mf_potential_grid_clear(&made->state.grid);
}

/// C = S*: nothing is changed, of however few samples.
static void test_coarse_step_of_an_ideal_response_is_that_of_boltzmann_inversion(void **state) {
    (void)state;
    static struct made made;
    static const double samples[] = {1, 10, 1e6};
    for (size_t n = 0; n < sizeof samples / sizeof *samples; n++) {
        make(&made, 4, samples[n], 1, 0);
        assert_ok(mf_inversion_low_rank_respond(&made.state, made.step));
        for (size_t k = CORE; k < BINS; k++)
            assert_close(made.step[k], sin(1.7 * (double)k), 1e-6);
        clear(&made);
    }
}

/// A coefficient for each bin: C x = S* u.
static void test_coarse_step_of_many_samples_is_newtons(void **state) {
    (void)state;
    static struct made made;
    make(&made, 100, 1e16, 0.3, 0.4);
    assert_ok(mf_inversion_low_rank_respond(&made.state, made.step));
    for (size_t a = 0; a < KNOWN; a++) {
        double response = 0;
        for (size_t b = 0; b < KNOWN; b++)
            response += made.covariance[a * KNOWN + b] * made.step[CORE + b];
        assert_close(response, made.counts[CORE + a] * sin(1.7 * (double)(CORE + a)), 1e-4);
    }
    clear(&made);
}

/// m coefficients of a response of a tenth go a step of 1/(λ + (1 − λ)/10); at m = n, λ = 1/2 and
/// the step is 1.82 times u. What they cannot make keeps the length 1.
static void test_coarse_step_of_few_samples_is_short(void **state) {
    (void)state;
    static struct made made;
    make(&made, 100, KNOWN, 0.1, 0);
    assert_ok(mf_inversion_low_rank_respond(&made.state, made.step));
    for (size_t k = CORE; k < BINS; k++)
        assert_close(made.step[k], sin(1.7 * (double)k) / 0.55, 1e-6);
    clear(&made);

    make(&made, 3, 1e16, 0.1, 0);
    assert_ok(mf_inversion_low_rank_respond(&made.state, made.step));
    const struct inversion_basis *low_rank = &made.state.low_rank;
    for (size_t k = 0; k < low_rank->count; k++) {
        double before = 0, after = 0;
        for (size_t a = 0; a < KNOWN; a++) {
            const double weight = low_rank->value[a * low_rank->count + k] * made.counts[CORE + a];
            before += weight * sin(1.7 * (double)(CORE + a));
            after += weight * made.step[CORE + a];
        }
        assert_close(after, 10 * before, 1e-4 * fabs(before) + 1e-4);
    }
    clear(&made);
}

/// Of many samples a response of 50 is one.
static void test_coarse_step_along_a_large_response_is_short(void **state) {
    (void)state;
    static struct made made;
    make(&made, 100, 1e16, 50, 0);
    assert_ok(mf_inversion_low_rank_respond(&made.state, made.step));
    for (size_t k = CORE; k < BINS; k++)
        assert_close(made.step[k], sin(1.7 * (double)k) / 50, 1e-6);
    clear(&made);
}

/// C of so many samples of normal numbers, one of which has the variance `large`, in units of D.
/// @param[out] vector  its eigenvector of the largest eigenvalue
static void sample(struct made *made, int64_t samples, double large, uint32_t trial,
                   double vector[KNOWN]) {
    double scaled[KNOWN * KNOWN] = {0};
    gsl_matrix *vectors = gsl_matrix_alloc(KNOWN, KNOWN);
    gsl_vector *values = gsl_vector_alloc(KNOWN);
    gsl_eigen_symmv_workspace *workspace = gsl_eigen_symmv_alloc(KNOWN);
    gsl_matrix_view matrix = gsl_matrix_view_array(scaled, KNOWN, KNOWN);
    for (uint32_t n = 0; n < samples; n++) {
        double x[KNOWN + 2];
        for (uint32_t k = 0; k < KNOWN; k += 4)
            mf_rng_normal4(mf_rng_philox(5, RNG_EVALUATION, trial, n, k), x + k);
        x[0] *= sqrt(large);
        for (size_t a = 0; a < KNOWN; a++)
            for (size_t b = 0; b < KNOWN; b++)
                scaled[a * KNOWN + b] += x[a] * x[b] / (double)samples;
    }
    for (size_t a = 0; a < KNOWN; a++)
        for (size_t b = 0; b < KNOWN; b++)
            made->covariance[a * KNOWN + b] =
                scaled[a * KNOWN + b] * sqrt(made->counts[CORE + a] * made->counts[CORE + b]);
    gsl_eigen_symmv(&matrix.matrix, values, vectors, workspace);
    for (size_t a = 0; a < KNOWN; a++)
        vector[a] = gsl_matrix_get(vectors, a, gsl_vector_max_index(values));
    gsl_matrix_free(vectors);
    gsl_vector_free(values);
    gsl_eigen_symmv_free(workspace);
}

/// Along the largest eigenvector of what was sampled the step is, on average, the one of which the
/// response that the samples came from leaves least.
static void test_coarse_step_along_a_sampled_response_leaves_least(void **state) {
    (void)state;
    static struct made made;
    static const struct {
        int64_t samples;
        double large, tolerance;
    } of[] = {{10, 10, 0.05}, {20, 6, 0.05}, {80, 6, 0.015}, {1000, 1.5, 0.015}};
    enum { TRIALS = 200 };
    for (size_t n = 0; n < sizeof of / sizeof *of; n++) {
        double along = 0, square = 0, step = 0;
        make(&made, 100, (double)of[n].samples, 1, 0);
        for (uint32_t trial = 0; trial < TRIALS; trial++) {
            double vector[KNOWN];
            sample(&made, of[n].samples, of[n].large, trial, vector);
            for (size_t a = 0; a < KNOWN; a++)
                made.step[CORE + a] = vector[a] / sqrt(made.counts[CORE + a]);
            assert_ok(mf_inversion_low_rank_respond(&made.state, made.step));
            for (size_t a = 0; a < KNOWN; a++) {
                const double response = (a == 0 ? of[n].large : 1) * vector[a];
                along += vector[a] * response;
                square += response * response;
                step += vector[a] * made.step[CORE + a] * sqrt(made.counts[CORE + a]) / TRIALS;
            }
        }
        assert_close(step, along / square, of[n].tolerance);
        clear(&made);
    }
}

/// What the true response of a step leaves of `asked`, with so many times the part of the step that
/// is across the vector.
static double find_left(const struct made *made, double large, const double vector[KNOWN],
                        const double asked[KNOWN], double times) {
    double along = 0, left = 0;
    for (size_t a = 0; a < KNOWN; a++)
        along += vector[a] * made->step[CORE + a] * sqrt(made->counts[CORE + a]);
    for (size_t a = 0; a < KNOWN; a++) {
        const double step = made->step[CORE + a] * sqrt(made->counts[CORE + a]);
        const double changed = along * vector[a] + times * (step - along * vector[a]);
        left += pow((a == 0 ? large : 1) * changed - asked[a], 2);
    }
    return left;
}

/// Steps to anywhere: half or twice as long across the sampled vector they leave more, and of few
/// samples of a large response all of them leave less than was asked for.
static void test_coarse_step_across_a_sampled_response_leaves_least(void **state) {
    (void)state;
    static struct made made;
    static const struct {
        int64_t samples;
        double large;
    } of[] = {{12, 27}, {20, 27}, {40, 60}, {200, 10}};
    static const double times[] = {1, 0.5, 2};
    enum { TRIALS = 300 };
    for (size_t n = 0; n < sizeof of / sizeof *of; n++) {
        double left[3] = {0};
        make(&made, 100, (double)of[n].samples, 1, 0);
        for (uint32_t trial = 0; trial < TRIALS; trial++) {
            double vector[KNOWN], asked[KNOWN + 2];
            sample(&made, of[n].samples, of[n].large, trial, vector);
            for (uint32_t k = 0; k < KNOWN; k += 4)
                mf_rng_normal4(mf_rng_philox(6, RNG_EVALUATION, trial, 0, k), asked + k);
            for (size_t a = 0; a < KNOWN; a++)
                made.step[CORE + a] = asked[a] / sqrt(made.counts[CORE + a]);
            assert_ok(mf_inversion_low_rank_respond(&made.state, made.step));
            for (int k = 0; k < 3; k++)
                left[k] += find_left(&made, of[n].large, vector, asked, times[k]) / TRIALS;
        }
        print_message(
            "%d samples, a response of %g: %.2f of %d is left; half and twice as far %.2f "
            "and %.2f\n",
            (int)of[n].samples, of[n].large, left[0], KNOWN, left[1], left[2]);
        assert_true(left[0] < left[1] && left[0] < left[2]);
        assert_true(left[0] < KNOWN);
        clear(&made);
    }
}

/// Bins that are empty in the target leave coefficients that no pair sees.
static void test_coarse_step_of_a_target_with_a_hole_is_finite(void **state) {
    (void)state;
    static struct made made;
    make(&made, 8, 100, 1, 0.3);
    for (size_t k = CORE + 1; k < CORE + 6; k++) {
        made.counts[k] = 0;
        for (size_t a = 0; a < KNOWN; a++)
            made.covariance[a * KNOWN + k - CORE] = made.covariance[(k - CORE) * KNOWN + a] = 0;
    }
    assert_ok(mf_inversion_low_rank_respond(&made.state, made.step));
    for (size_t k = CORE; k < BINS; k++)
        assert_true(fabs(made.step[k]) < 10);
    clear(&made);
}

/// Samples that are a twentieth above their target, whose factor may be off by a tenth, and a wave
/// besides: the potential is asked for the wave alone.
static void test_coarse_step_leaves_what_the_factor_of_a_target_explains(void **state) {
    (void)state;
    static struct made made;
    static const double prior = 0.1, factor = 1.05, wave = 0.02;
    double mean[BINS], unit[BINS], min[BINS] = {0}, excess[KNOWN], variance[KNOWN], common[KNOWN];
    make(&made, 4, 1e16, 1, 0);
    struct inversion_state *const of = &made.state;
    made.problem.targets.target[TARGET_RDF].factor_error = &prior;
    for (size_t k = 0; k < BINS; k++) {
        // Of a wave that is orthogonal to the factor where all bins are known alike.
        mean[k] = made.counts[k] * (factor + wave * (k % 2 ? 1 : -1));
        unit[k] = 1;
    }
    for (size_t a = 0; a < KNOWN; a++) {
        const double counts = made.counts[CORE + a];
        excess[a] = mean[CORE + a] - counts;
        variance[a] = pow(1e-3 * counts, 2);
        common[a] = prior * counts;
    }
    of->target.ideal = of->target.unit = unit;
    of->target.min = min;
    of->target.common = common;
    of->replicas.counts.mean = mean;
    of->excess = excess;
    of->variance = variance;
    of->assessment.sections = 1;
    of->assessment.section[0] =
        (struct inversion_section){.kind = TARGET_RDF, .known_count = KNOWN, .rms = 1, .noise = 0};
    assert_ok(mf_inversion_low_rank_step(of, made.step));
    for (size_t k = CORE; k < BINS; k++)
        assert_close(made.step[k], 1.5 * (k % 2 ? 1 : -1) * wave / factor, 2e-3);
    clear(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_coarse_step_of_an_ideal_response_is_that_of_boltzmann_inversion),
        cmocka_unit_test(test_coarse_step_of_many_samples_is_newtons),
        cmocka_unit_test(test_coarse_step_of_few_samples_is_short),
        cmocka_unit_test(test_coarse_step_along_a_large_response_is_short),
        cmocka_unit_test(test_coarse_step_along_a_sampled_response_leaves_least),
        cmocka_unit_test(test_coarse_step_across_a_sampled_response_leaves_least),
        cmocka_unit_test(test_coarse_step_of_a_target_with_a_hole_is_finite),
        cmocka_unit_test(test_coarse_step_leaves_what_the_factor_of_a_target_explains),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
