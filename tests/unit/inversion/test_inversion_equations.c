// SPDX-License-Identifier: GPL-3.0-or-later
//
// The equations that several states leave: their least squares are those of all rows, but for bins
// that a state has not seen; and Birge's factor does not widen what pressures say.
#include "inversion/inversion_equations.h"
#include "inversion/inversion_state.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include "base/rng.h"

#include <gsl/gsl_vector.h>
#include <math.h>

enum { BINS = 8, CORE = 2, KNOWN = BINS - CORE, STATES = 2, UNSEEN = 3 };

static const double birge = 4, pressure_error = 0.1, temperature[STATES] = {1, 1.7};

/// Two states with pressures; the second has not seen one of the bins.
struct made {
    struct inverse_problem problem[STATES];
    struct inversion_state state[STATES];
    double g[BINS], pressure[STATES], covariance[STATES][KNOWN * KNOWN], excess[STATES][KNOWN],
        variance[STATES][KNOWN], slope[STATES][KNOWN], exact[BINS];
};

static void make(struct made *made) {
    *made = (struct made){.g = {0}};
    for (size_t k = 0; k < BINS; k++)
        made->g[k] = k >= CORE;
    for (size_t s = 0; s < STATES; s++) {
        struct inversion_state *state = &made->state[s];
        struct targets *targets = &made->problem[s].targets;
        made->problem[s].scene.temperature = temperature[s];
        made->problem[s].core_threshold = 1e-3;
        made->pressure[s] = 3 + (double)s;
        targets->bins = (struct rdf_bins){0, 0.1, BINS};
        targets->target[TARGET_RDF] = (struct target){.count = BINS, .value = made->g};
        targets->target[TARGET_PRESSURE] = (struct target){.count = 1, .value = &made->pressure[s]};
        assert_ok(mf_potential_grid_init(&state->grid, &made->problem[s]));
        assert_int_equal(state->grid.known, KNOWN);
        for (size_t a = 0; a < KNOWN; a++) {
            made->excess[s][a] = sin((double)(a + 5 * s));
            made->variance[s][a] = 0.2 + 0.1 * (double)(a + s);
            made->slope[s][a] = cos((double)(2 * a + s));
            for (size_t b = 0; b < KNOWN; b++)
                made->covariance[s][a * KNOWN + b] =
                    (a == b ? 3 : 0) + 0.5 * cos((double)(a + b + s));
        }
        state->problem = &made->problem[s];
        state->response.covariance = made->covariance[s];
        state->response.functions = KNOWN;
        state->target.error = made->exact;
        state->inefficiency = 1;
        state->excess = made->excess[s];
        state->variance = made->variance[s];
        state->bulk.slope = made->slope[s];
        state->bulk.value = 1;
        state->assessment.bulk_reach = pressure_error;
    }
    made->state[1].grid.seen[UNSEEN] = false;
}

/// Bᵀ B of all rows but those of some bins, with the variances of g larger by a factor; by the
/// definition.
static double normal(const struct made *made, size_t a, size_t b, double factor,
                     const bool *without) {
    double sum = 0;
    for (size_t s = 0; s < STATES; s++) {
        for (size_t n = 0; n < KNOWN; n++)
            if (made->state[s].grid.seen[n] && !without[n])
                sum += made->covariance[s][n * KNOWN + a] * made->covariance[s][n * KNOWN + b] /
                       (temperature[s] * temperature[s] * factor * made->variance[s][n]);
        sum += made->slope[s][a] * made->slope[s][b] / (pressure_error * pressure_error);
    }
    return sum;
}

/// The same of Bᵀ b.
static double right_side(const struct made *made, size_t a, double factor, const bool *without) {
    double sum = 0;
    for (size_t s = 0; s < STATES; s++) {
        for (size_t n = 0; n < KNOWN; n++)
            if (made->state[s].grid.seen[n] && !without[n])
                sum += made->covariance[s][n * KNOWN + a] * made->excess[s][n] /
                       (temperature[s] * factor * made->variance[s][n]);
        sum += made->slope[s][a] * (made->pressure[s] - made->state[s].bulk.value) /
               (pressure_error * pressure_error);
    }
    return sum;
}

static void test_equations_of_states_have_the_same_least_squares(void **state) {
    (void)state;
    static const bool none[KNOWN] = {false};
    static struct made made;
    struct inversion_equations equations = {0};
    make(&made);
    assert_ok(mf_inversion_equations_init(&equations, made.state, STATES));
    assert_ok(mf_inversion_equations_fill(&equations, birge));
    const double *c = equations.system.covariance, unit = equations.system.temperature;
    for (size_t a = 0; a < KNOWN; a++) {
        double asked = 0;
        for (size_t n = 0; n < KNOWN; n++)
            asked += c[n * KNOWN + a] / unit * equations.system.excess[n] / birge;
        assert_close(asked, right_side(&made, a, birge, none), 1e-9);
        for (size_t b = 0; b < KNOWN; b++) {
            double found = 0;
            // As the band has it: all variances, which are 1, larger by Birge's factor.
            for (size_t n = 0; n < KNOWN; n++)
                found += c[n * KNOWN + a] * c[n * KNOWN + b] / (unit * unit * birge);
            assert_close(found, normal(&made, a, b, birge, none), 1e-9);
        }
    }
    mf_inversion_equations_clear(&equations);
    for (size_t s = 0; s < STATES; s++)
        mf_potential_grid_clear(&made.state[s].grid);
}

static void test_equations_without_some_bins_know_nothing_of_them(void **state) {
    (void)state;
    static const bool without[KNOWN] = {[1] = true, [KNOWN - 1] = true};
    static struct made made;
    struct inversion_equations equations = {0};
    gsl_matrix *found = gsl_matrix_alloc(KNOWN, KNOWN);
    gsl_vector *asked = gsl_vector_alloc(KNOWN);
    make(&made);
    assert_ok(mf_inversion_equations_init(&equations, made.state, STATES));
    assert_ok(mf_inversion_equations_fill(&equations, birge));
    assert_ok(mf_inversion_equations_without(&equations, birge, without, found, asked));
    for (size_t a = 0; a < KNOWN; a++) {
        assert_close(gsl_vector_get(asked, a), right_side(&made, a, birge, without), 1e-7);
        for (size_t b = 0; b <= a; b++)
            assert_close(gsl_matrix_get(found, a, b), normal(&made, a, b, birge, without), 1e-7);
    }
    gsl_matrix_free(found);
    gsl_vector_free(asked);
    mf_inversion_equations_clear(&equations);
    for (size_t s = 0; s < STATES; s++)
        mf_potential_grid_clear(&made.state[s].grid);
}

/// Normal numbers of the excess: the samples' part by the correlations of C, n of n + N of them,
/// and that of the target in each bin by itself.
static void draw_excess(const struct made *made, const double *target_variance, uint32_t trial,
                        double *excess) {
    const double *c = made->covariance[0];
    const double part =
        made->state[0].response.independent / (made->state[0].response.independent + (double)KNOWN);
    double factor[KNOWN][KNOWN] = {{0}}, normal[KNOWN][4];
    for (size_t a = 0; a < KNOWN; a++)
        mf_rng_normal4(mf_rng_philox(7, RNG_INITIAL, trial, (uint32_t)a, 0), normal[a]);
    for (size_t a = 0; a < KNOWN; a++) { // Cholesky's factor of the correlations
        excess[a] = sqrt(target_variance[a]) * normal[a][1];
        for (size_t b = 0; b <= a; b++) {
            double left = (a == b ? 1 : part) * c[a * KNOWN + b] /
                          sqrt(c[a * (KNOWN + 1)] * c[b * (KNOWN + 1)]);
            for (size_t k = 0; k < b; k++)
                left -= factor[a][k] * factor[b][k];
            factor[a][b] = a == b ? sqrt(left) : left / factor[b][b];
            excess[a] +=
                sqrt(made->variance[0][a] - target_variance[a]) * factor[a][b] * normal[b][0];
        }
    }
}

/// What Bᵀ L⁻¹ excess scatters by, of an excess whose errors of the target are each bin's own,
/// though the rows take them for those of samples.
static void test_equations_scatter_by_errors_of_each_bin(void **state) {
    (void)state;
    enum { TRIALS = 20000 };
    static struct made made;
    static const double tolerance = 0.05; // 5 sqrt(2/20000), of the diagonal
    struct inversion_equations equations = {0};
    double excess[KNOWN], target_variance[KNOWN], product[KNOWN][KNOWN] = {{0}};
    gsl_matrix *response = gsl_matrix_alloc(KNOWN, KNOWN);
    gsl_vector *whitened = gsl_vector_alloc(KNOWN);
    make(&made);
    made.state[0].response.independent = 50;
    made.problem[0].targets.target[TARGET_PRESSURE].count = 0;
    for (size_t a = 0; a < KNOWN; a++) {
        target_variance[a] = 0.7 * made.variance[0][a];
        made.exact[a + CORE] = sqrt(target_variance[a]);
    }
    made.state[0].replicas.counts.mean = made.g;
    made.state[0].target.counts = made.g;
    assert_ok(mf_inversion_equations_init(&equations, made.state, 1));
    assert_ok(mf_inversion_equations_fill(&equations, 1));
    for (uint32_t trial = 0; trial < TRIALS; trial++) {
        double asked[KNOWN] = {0};
        draw_excess(&made, target_variance, trial, excess);
        struct imc_system system = equations.system;
        system.excess = excess;
        assert_ok(mf_imc_solve_rows(&system, response, whitened));
        for (size_t b = 0; b < KNOWN; b++)
            for (size_t a = 0; a < KNOWN; a++)
                asked[b] += gsl_matrix_get(response, a, b) * gsl_vector_get(whitened, a);
        for (size_t a = 0; a < KNOWN; a++)
            for (size_t b = 0; b <= a; b++)
                product[a][b] += asked[a] * asked[b] / TRIALS;
    }
    for (size_t a = 0; a < KNOWN; a++)
        for (size_t b = 0; b <= a; b++)
            assert_close(product[a][b], equations.scatter[a * KNOWN + b],
                         tolerance * sqrt(equations.scatter[a * (KNOWN + 1)] *
                                          equations.scatter[b * (KNOWN + 1)]));
    gsl_matrix_free(response);
    gsl_vector_free(whitened);
    mf_inversion_equations_clear(&equations);
    for (size_t s = 0; s < STATES; s++)
        mf_potential_grid_clear(&made.state[s].grid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_equations_without_some_bins_know_nothing_of_them),
        cmocka_unit_test(test_equations_of_states_have_the_same_least_squares),
        cmocka_unit_test(test_equations_scatter_by_errors_of_each_bin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
