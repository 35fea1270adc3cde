// SPDX-License-Identifier: GPL-3.0-or-later
//
// Potentials of few coefficients: with one for each bin their Newton step is that of inverse Monte
// Carlo, a curve that they can make is left as it is, and the covariance is what the noise of the
// gradient makes of the step.
#include "inversion/inversion_state.h"
#include "base/memory.h"
#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <string.h>

enum { BINS = 12, CORE = 2, KNOWN = BINS - CORE };

static const double temperature = 1.5;

/// An inversion of one potential with a covariance of its own, and no samples behind it but a
/// number of them.
struct made {
    struct inverse_problem problem;
    struct inversion_state state;
    double g[BINS], error[BINS], covariance[KNOWN * KNOWN], excess[KNOWN], step[BINS + 1];
};

static double uniform(struct rng_sequence *random) {
    return mf_rng_sequence_uniform(random) - 0.5;
}

static void make(struct made *made, size_t coefficients, double samples) {
    struct rng_sequence random = mf_rng_sequence_begin(7, RNG_INITIAL, 0, 0);
    double factor[KNOWN * KNOWN];
    struct inversion_state *state = &made->state;
    *made = (struct made){.problem = {.scene = {.temperature = temperature},
                                      .core_threshold = 1e-3,
                                      .core_stiffness = 2000}};
    for (size_t k = 0; k < BINS; k++)
        made->g[k] = k < CORE ? 0 : 1;
    made->problem.targets.bins = (struct rdf_bins){0, 0.1, BINS};
    made->problem.targets.target[TARGET_RDF] = (struct target){.count = BINS, .value = made->g};
    assert_ok(mf_potential_grid_init(&state->grid, &made->problem));
    assert_int_equal(state->grid.known, KNOWN);
    for (size_t k = 0; k < KNOWN * KNOWN; k++)
        factor[k] = uniform(&random) + (k % (KNOWN + 1) == 0);
    for (size_t a = 0; a < KNOWN; a++) {
        made->excess[a] = uniform(&random);
        made->error[a + CORE] = 0.015 + 0.005 * (double)(a % 3);
        for (size_t b = 0; b < KNOWN; b++)
            for (size_t k = 0; k < KNOWN; k++)
                made->covariance[a * KNOWN + b] += factor[a * KNOWN + k] * factor[b * KNOWN + k];
    }
    state->problem = &made->problem;
    state->response.sampled = made->covariance;
    state->excess = made->excess;
    state->target.error = made->error;
    state->inefficiency = 1;
    state->replicas.counts.count = samples;
    assert_ok(mf_inversion_basis_init(&state->basis, &state->grid,
                                      &(struct inversion_basis_size){(int64_t)coefficients, 1}));
    assert_int_equal(state->basis.count, coefficients < KNOWN ? coefficients : KNOWN);
}

static void clear(struct made *made) {
    mf_inversion_basis_clear(&made->state.basis);
    mf_potential_grid_clear(&made->state.grid);
}

/// C x/k_B T is the excess, which many samples tell.
static void test_basis_of_all_bins_takes_the_step_of_inverse_monte_carlo(void **state) {
    (void)state;
    static struct made made;
    make(&made, 100, 1e14);
    mf_inversion_basis_measure(&made.state, made.step);
    for (size_t a = 0; a < KNOWN; a++) {
        double predicted = 0;
        for (size_t b = 0; b < KNOWN; b++)
            predicted += made.covariance[a * KNOWN + b] * made.step[CORE + b] / temperature;
        assert_close(predicted, made.excess[a], 1e-6);
    }
    clear(&made);
}

/// Few coefficients remove what they can see of the excess: Bᵀ(excess − C x/k_B T) = 0; twice the
/// fall of S_rel that is promised is gᵀH⁻¹g = Σ excess x/k_B T.
static void test_basis_of_few_coefficients_makes_their_gradient_zero(void **state) {
    (void)state;
    static struct made made;
    make(&made, 4, 1e14);
    const struct inversion_basis *basis = &made.state.basis;
    double left[KNOWN], promised = 0, whole = 0;
    mf_inversion_basis_measure(&made.state, made.step);
    for (size_t a = 0; a < KNOWN; a++) {
        left[a] = made.excess[a];
        for (size_t b = 0; b < KNOWN; b++)
            left[a] -= made.covariance[a * KNOWN + b] * made.step[CORE + b] / temperature;
        promised += made.excess[a] * made.step[CORE + a] / temperature;
        whole += fabs(left[a]);
    }
    assert_true(whole > 0.1);
    for (size_t k = 0; k < basis->count; k++) {
        double gradient = 0;
        for (size_t a = 0; a < KNOWN; a++)
            gradient += basis->value[a * basis->count + k] * left[a];
        assert_close(gradient, 0, 1e-8);
    }
    assert_close(basis->decrement, promised, 1e-8);
    clear(&made);
}

static void test_basis_leaves_a_curve_as_it_is_that_it_can_make(void **state) {
    (void)state;
    static struct made made;
    double weight[KNOWN], phi[BINS + 1], wanted[BINS + 1];
    make(&made, 5, 100);
    const struct potential_grid *grid = &made.state.grid;
    const double begin = grid->r[CORE], end = grid->r[BINS];
    for (size_t k = 0; k <= BINS; k++) {
        const double left = (end - grid->r[k]) / (end - begin);
        wanted[k] = phi[k] = 3 * left - 2 * left * left + 4 * left * left * left;
    }
    for (size_t a = 0; a < KNOWN; a++)
        weight[a] = 1 + (double)a;
    assert_ok(mf_inversion_basis_project(&made.state.basis, grid, weight, phi));
    for (size_t k = CORE; k <= BINS; k++)
        assert_close(phi[k], wanted[k], 1e-6);
    clear(&made);
}

/// Normal numbers with the covariance C/n + diag(τ²) of the excess.
static void draw_excess(struct made *made, const double *factor, double samples, uint32_t draw) {
    double normal[KNOWN][4];
    for (uint32_t a = 0; a < KNOWN; a++)
        mf_rng_normal4(mf_rng_philox(3, RNG_SELECTION, draw, a, 0), normal[a]);
    for (size_t a = 0; a < KNOWN; a++) {
        made->excess[a] = made->error[CORE + a] * normal[a][1];
        for (size_t b = 0; b <= a; b++)
            made->excess[a] += factor[a * KNOWN + b] / sqrt(samples) * normal[b][0];
    }
}

/// C of so many samples, normal numbers with the covariance L Lᵀ about 0.
static void sample_covariance(struct made *made, const double *factor, uint32_t samples,
                              uint32_t draw) {
    memset(made->covariance, 0, sizeof made->covariance);
    for (uint32_t n = 0; n < samples; n++) {
        double s[KNOWN] = {0};
        for (uint32_t b = 0; b < KNOWN; b++) {
            double normal[4];
            mf_rng_normal4(mf_rng_philox(4, RNG_SELECTION, draw, n, b), normal);
            for (size_t a = b; a < KNOWN; a++)
                s[a] += factor[a * KNOWN + b] * normal[0];
        }
        for (size_t a = 0; a < KNOWN; a++)
            for (size_t b = 0; b < KNOWN; b++)
                made->covariance[a * KNOWN + b] += s[a] * s[b] / samples;
    }
}

/// Cholesky's factor of C.
static void factorise(const double *c, double *factor) {
    memset(factor, 0, KNOWN * KNOWN * sizeof *factor);
    for (size_t a = 0; a < KNOWN; a++)
        for (size_t b = 0; b <= a; b++) {
            double sum = c[a * KNOWN + b];
            for (size_t k = 0; k < b; k++)
                sum -= factor[a * KNOWN + k] * factor[b * KNOWN + k];
            factor[a * KNOWN + b] = a == b ? sqrt(sum) : sum / factor[b * KNOWN + b];
        }
}

/// Steps from draws of noise scatter as the covariance says: 4000 know a standard deviation within
/// 1.1 %, and 5 of that is the margin of each of ten. The gradient is then as large as its noise.
static void test_basis_covariance_is_the_scatter_of_the_step(void **state) {
    (void)state;
    enum { DRAWS = 4000 };
    static const double samples = 4000;
    static struct made made;
    double factor[KNOWN * KNOWN], covariance[KNOWN * KNOWN], squares[KNOWN] = {0}, directions;
    double misses = 0, decrement = 0;
    make(&made, 4, samples);
    factorise(made.covariance, factor);
    for (uint32_t draw = 0; draw < DRAWS; draw++) {
        draw_excess(&made, factor, samples, draw);
        mf_inversion_basis_measure(&made.state, made.step);
        misses += pow(made.state.basis.miss, 2) / DRAWS;
        decrement += made.state.basis.decrement / DRAWS;
        for (size_t a = 0; a < KNOWN; a++)
            squares[a] += pow(made.step[CORE + a], 2) / DRAWS;
    }
    assert_ok(mf_inversion_basis_covariance(&made.state, covariance, &directions));
    assert_close(directions, 4, 0.01);
    assert_close(misses, 1, 0.06);
    assert_close(decrement / made.state.basis.chance, 1, 0.07);
    for (size_t a = 0; a < KNOWN; a++)
        assert_close(sqrt(squares[a] / covariance[a * (KNOWN + 1)]), 1, 5 * 0.0112);
    clear(&made);
}

/// Near the target a step goes all of the way on average, whatever C of 40 samples: the curve that
/// the excess is made with comes back in each bin. The inverse of such a C alone goes 14 % too far,
/// with n/(n − K − 1) for K = 4 (Wishart's distribution); 3000 of them know the step within 1 %.
static void test_basis_near_the_target_steps_all_of_the_way_on_average(void **state) {
    (void)state;
    enum { DRAWS = 3000, SAMPLES = 40, COUNT = 4 };
    static const double coefficient[COUNT] = {0.3, -0.5, 0.4, 0.2}, large = 30;
    static struct made made;
    double exact[KNOWN * KNOWN], factor[KNOWN * KNOWN], wanted[KNOWN] = {0}, mean[KNOWN] = {0};
    make(&made, COUNT, SAMPLES);
    for (size_t k = 0; k < KNOWN * KNOWN; k++)
        exact[k] = large * large * made.covariance[k];
    factorise(exact, factor);
    for (size_t a = 0; a < KNOWN; a++)
        for (size_t k = 0; k < COUNT; k++)
            wanted[a] += made.state.basis.value[a * COUNT + k] * coefficient[k];
    for (size_t a = 0; a < KNOWN; a++) {
        made.excess[a] = 0;
        for (size_t b = 0; b < KNOWN; b++)
            made.excess[a] += exact[a * KNOWN + b] * wanted[b] / temperature;
    }
    for (size_t k = 0; k < BINS; k++)
        made.error[k] *= 1e6; // which makes the target near
    for (uint32_t draw = 0; draw < DRAWS; draw++) {
        sample_covariance(&made, factor, SAMPLES, draw);
        mf_inversion_basis_measure(&made.state, made.step);
        for (size_t a = 0; a < KNOWN; a++)
            mean[a] += made.step[CORE + a] / DRAWS;
    }
    for (size_t a = 0; a < KNOWN; a++) {
        print_message("bin %zu: %.4f of %.4f\n", a, mean[a], wanted[a]);
        assert_close(mean[a], wanted[a], 0.02);
    }
    clear(&made);
}

/// Whether the target is near is told by the present gradient, not by that of the iteration before:
/// a fit that comes near would end with the small step of one that is far.
static void test_basis_is_near_by_its_present_gradient(void **state) {
    (void)state;
    static struct made made;
    double step[KNOWN];
    make(&made, 4, 40);
    for (size_t k = 0; k < BINS; k++)
        made.error[k] *= 1e6;
    for (int before = 0; before < 2; before++) {
        made.state.gradient = before ? INFINITY : 1;
        mf_inversion_basis_measure(&made.state, made.step);
        assert_true(made.state.gradient < 1);
        for (size_t a = 0; a < KNOWN && before == 0; a++)
            step[a] = made.step[CORE + a];
    }
    for (size_t a = 0; a < KNOWN; a++)
        assert_close(made.step[CORE + a], step[a], 1e-12);
    clear(&made);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_basis_of_all_bins_takes_the_step_of_inverse_monte_carlo),
        cmocka_unit_test(test_basis_of_few_coefficients_makes_their_gradient_zero),
        cmocka_unit_test(test_basis_leaves_a_curve_as_it_is_that_it_can_make),
        cmocka_unit_test(test_basis_covariance_is_the_scatter_of_the_step),
        cmocka_unit_test(test_basis_near_the_target_steps_all_of_the_way_on_average),
        cmocka_unit_test(test_basis_is_near_by_its_present_gradient),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
