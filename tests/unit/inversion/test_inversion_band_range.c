// SPDX-License-Identifier: GPL-3.0-or-later
//
// The error of the range, against the definition: least squares of the inner bins alone, solved for
// them by elimination, with what is left of the outer ones by hand.
#include "inversion/inversion.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_linalg.h>
#include <math.h>

enum { BINS = 20, INNER = 16 };

static const double width = 0.1, range = 2, temperature = 1.3, birge = 1.5;

/// One state of one type of beads, of which all bins are known.
struct made {
    struct inverse_problem problem;
    struct inversion_state state;
    struct inversion inversion;
    double g[BINS], exact[BINS], covariance[BINS * BINS], excess[BINS], variance[BINS], slope[BINS],
        phi[BINS + 1], reference[BINS + 1], step[BINS], weight[BINS];
};

/// A potential whose last fifth is a d + b d², d from its end.
static void make(struct made *made, double a, double b) {
    *made = (struct made){0};
    struct inversion_state *state = &made->state;
    struct targets *targets = &made->problem.targets;
    made->problem.scene.temperature = temperature;
    targets->bins = (struct rdf_bins){0, width, BINS};
    for (size_t k = 0; k < BINS; k++) {
        const double d = range - ((double)k + 0.5) * width;
        made->g[k] = 1;
        made->step[k] = 0.01 * cos((double)k);
        made->phi[k] = a * d + b * d * d - made->step[k];
        made->excess[k] = 0.3 * sin((double)k);
        made->variance[k] = 0.1 + 0.01 * (double)k;
        made->weight[k] = d / range;
        made->slope[k] = 1 + (double)k;
        for (size_t l = 0; l < BINS; l++)
            made->covariance[k * BINS + l] = (k == l ? 3 : 0) + 0.4 * cos((double)(k + l));
    }
    targets->target[TARGET_RDF] = (struct target){.count = BINS, .value = made->g};
    assert_ok(mf_potential_grid_init(&state->grid, &made->problem));
    assert_int_equal(state->grid.known, BINS);
    state->problem = &made->problem;
    state->response.covariance = made->covariance;
    state->response.functions = BINS;
    state->target.error = made->exact;
    state->inefficiency = 1;
    state->excess = made->excess;
    state->variance = made->variance;
    state->bulk.slope = made->slope;
    made->inversion =
        (struct inversion){.problem = &made->problem,
                           .state = state,
                           .states = 1,
                           .course = {.phi = made->phi, .reference = made->reference}};
    assert_ok(mf_inversion_band_init(&made->inversion.course.band, BINS, BINS + 1));
    assert_ok(mf_inversion_equations_init(&made->inversion.equations, state, 1));
    assert_ok(mf_inversion_equations_fill(&made->inversion.equations, birge));
}

static void clear(struct made *made) {
    mf_inversion_equations_clear(&made->inversion.equations);
    mf_inversion_band_clear(&made->inversion.course.band);
    mf_potential_grid_clear(&made->state.grid);
}

/// Σ before: independent bins.
static void set_errors(struct made *made, double error) {
    for (size_t k = 0; k < BINS; k++)
        made->inversion.course.band.covariance[k * (BINS + 1)] = error * error;
}

/// Second derivatives of all by all of the sum of squares, and what its slopes ask for at 0.
static void fill_squares(const struct made *made, double squares[BINS][BINS], double asked[BINS]) {
    const double unit = 1 / (temperature * temperature);
    gsl_matrix *prior = gsl_matrix_alloc(2 * BINS - 1, BINS);
    mf_imc_solve_prior(&made->inversion.equations.system, prior);
    for (size_t k = 0; k < BINS; k++) {
        asked[k] = 0;
        for (size_t n = 0; n < INNER; n++)
            asked[k] += made->covariance[n * BINS + k] * made->excess[n] /
                        (temperature * birge * made->variance[n]);
        for (size_t l = 0; l < BINS; l++) {
            squares[k][l] = 0;
            for (size_t n = 0; n < INNER; n++)
                squares[k][l] += unit * made->covariance[n * BINS + k] *
                                 made->covariance[n * BINS + l] / (birge * made->variance[n]);
            for (size_t n = 0; n < 2 * BINS - 1; n++)
                squares[k][l] += unit * gsl_matrix_get(prior, n, k) * gsl_matrix_get(prior, n, l);
        }
        for (size_t l = 0; l < BINS; l++)
            for (size_t n = 0; n < 2 * BINS - 1; n++)
                asked[k] -=
                    unit * gsl_matrix_get(prior, n, k) * gsl_matrix_get(prior, n, l) * made->phi[l];
    }
    gsl_matrix_free(prior);
}

/// The change, if so much of the last fifth is gone.
static void find_change(const struct made *made, double gone, double change[BINS]) {
    double squares[BINS][BINS], asked[BINS];
    int sign;
    gsl_matrix *inner = gsl_matrix_alloc(INNER, INNER);
    gsl_vector *right = gsl_vector_alloc(INNER), *x = gsl_vector_alloc(INNER);
    gsl_permutation *order = gsl_permutation_alloc(INNER);
    fill_squares(made, squares, asked);
    for (size_t k = INNER; k < BINS; k++)
        change[k] = made->step[k] - gone * (made->phi[k] + made->step[k]);
    for (size_t k = 0; k < INNER; k++) {
        for (size_t l = 0; l < INNER; l++)
            gsl_matrix_set(inner, k, l, squares[k][l]);
        for (size_t l = INNER; l < BINS; l++)
            asked[k] -= squares[k][l] * change[l];
        gsl_vector_set(right, k, asked[k]);
    }
    gsl_linalg_LU_decomp(inner, order, &sign);
    gsl_linalg_LU_solve(inner, order, right, x);
    for (size_t k = 0; k < BINS; k++)
        change[k] = (k < INNER ? gsl_vector_get(x, k) : change[k]) - made->step[k];
    gsl_matrix_free(inner);
    gsl_vector_free(right);
    gsl_vector_free(x);
    gsl_permutation_free(order);
}

static void add(struct made *made) {
    const struct inversion_band_without without = {&made->inversion.equations.system, birge,
                                                   made->step, made->weight, NULL};
    assert_ok(mf_inversion_band_add_range(&made->inversion, &without));
}

/// Of more than a third of the height by the slope at the end all of the last fifth is gone, of a
/// sixth a quarter; of a potential that ends by itself nothing.
static void test_error_of_the_range_is_the_change_of_the_least_squares(void **unused) {
    (void)unused;
    static const double slope[] = {0.4, 0.4, 0, -0.1}, bend[] = {1, 5, 3, 3},
                        gone[] = {1, 0.25, 0, 0};
    static const double error = 0.01;
    for (int k = 0; k < 4; k++) {
        struct made made;
        double change[BINS], along = 0, variance = 0;
        make(&made, slope[k], bend[k]);
        set_errors(&made, error);
        find_change(&made, gone[k], change);
        add(&made);
        for (size_t a = 0; a < BINS; a++) {
            along += made.weight[a] * change[a];
            variance += made.weight[a] * made.weight[a] * error * error;
        }
        const double share = fmax(0, 1 - variance / (along * along));
        print_message("of the last fifth %g gone: ramp %.3f, share %.3f\n", gone[k], along, share);
        for (size_t a = 0; a < BINS; a++)
            for (size_t b = 0; b < BINS; b++)
                assert_close(made.inversion.course.band.covariance[a * BINS + b],
                             share * change[a] * change[b] + (a == b ? error * error : 0), 1e-6);
        clear(&made);
    }
}

static void test_change_of_the_size_of_errors_is_none(void **unused) {
    (void)unused;
    struct made made;
    make(&made, 0.4, 1);
    set_errors(&made, 5);
    add(&made);
    for (size_t a = 0; a < BINS; a++) {
        assert_close(made.inversion.course.band.covariance[a * (BINS + 1)], 25, 0);
        assert_close(made.inversion.course.band.beside_ramp[a], 0, 0);
    }
    clear(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_error_of_the_range_is_the_change_of_the_least_squares),
        cmocka_unit_test(test_change_of_the_size_of_errors_is_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
