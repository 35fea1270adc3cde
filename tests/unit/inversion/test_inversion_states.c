// SPDX-License-Identifier: GPL-3.0-or-later
//
// The mean of the coarse steps of several states: each one's constant of a group is of no
// consequence, and a bin that one state has not seen is the other's alone.
#include "inversion/inversion_low_rank.h"
#include "inversion/inversion_state.h"
#include "inversion/inversion_states.h"
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

enum { BINS = 24, STATES = 2, FIRST = 4, LAST = 19 };

static const double sampled = 1e5;
static const int types[2] = {0};

/// Two states of one group of bonds, whose samples have an ideal response C = S*.
/// The second state has seen the bins 0 … BINS − 1, the first those from FIRST to LAST.
struct made {
    struct molecules molecules;
    struct composition composition;
    struct inverse_problem problem[STATES];
    const struct inverse_problem *problems[STATES];
    struct inversion_state state[STATES];
    double target[STATES][BINS], none[BINS], one[BINS], min[BINS], counts[STATES][BINS],
        excess[STATES][BINS], variance[STATES][BINS], covariance[STATES][BINS * BINS];
};

/// What U lacks, as Boltzmann inversion sees it.
static double wanted(size_t bin) {
    return 0.3 * sin(0.4 * (double)bin);
}

static bool is_seen(size_t s, size_t bin) {
    return s == 1 || (bin >= FIRST && bin <= LAST);
}

static void make_state(struct made *made, size_t s, double temperature) {
    static const struct bonded_bins bins = {0.2, 0.05, BINS};
    struct inversion_state *state = &made->state[s];
    struct inverse_problem *problem = &made->problem[s];
    const int kind = mf_bonded_distribution_kind(BONDED_BOND);
    *problem = (struct inverse_problem){
        .scene = {.temperature = temperature, .box = {.dimensions = 3, .length = {9, 9, 9}}},
        .state = made->problems,
        .states = STATES,
        .bonded = 1,
        .unknown[UNKNOWN_BONDED].wanted = true,
        .group[0] = {BONDED_BOND, 0, bins, 0, {0}}};
    problem->targets.target[kind] =
        (struct target){.count = BINS, .value = made->target[s], .error = made->none};
    molecules_enter(&problem->scene, &made->molecules, &made->composition);
    for (size_t k = 0; k < BINS; k++) {
        made->one[k] = 1;
        made->target[s][k] = is_seen(s, k) ? 100 + 20 * cos((double)(k + s)) : 0;
    }
    made->problems[s] = problem;
    state->problem = problem;
}

/// Samples that are off by exp(wanted/k_B T) times a factor, as normalisation makes it.
static void sample_state(struct made *made, size_t s, double factor) {
    struct inversion_state *state = &made->state[s];
    const double temperature = made->problem[s].scene.temperature;
    assert_ok(mf_potential_grid_init(&state->grid, &made->problem[s]));
    assert_int_equal(state->grid.known, BINS);
    for (size_t k = 0; k < BINS; k++) {
        const double p = made->target[s][k];
        made->counts[s][k] = is_seen(s, k) ? p * factor * exp(wanted(k) / temperature) : 40;
        made->excess[s][k] = made->counts[s][k] - p;
        made->variance[s][k] = made->counts[s][k] / sampled;
        for (size_t n = 0; n < BINS; n++)
            made->covariance[s][k * BINS + n] = n == k ? p : 0;
    }
    state->target = (struct inversion_target){.ideal = made->one,
                                              .unit = made->one,
                                              .min = made->min,
                                              .counts = made->target[s],
                                              .error = made->none};
    state->excess = made->excess[s];
    state->variance = made->variance[s];
    state->response.sampled = made->covariance[s];
    state->replicas.counts = (struct comoments){.count = sampled, .mean = made->counts[s]};
    state->inefficiency = 1;
    state->assessment.sections = 1;
    state->assessment.section[0] = (struct inversion_section){.known_count = BINS, .bins = BINS};
    assert_ok(mf_inversion_low_rank_init(state));
}

static void make(struct made *made, const double factor[STATES]) {
    *made = (struct made){.none = {0}};
    for (size_t k = 0; k < BINS; k++)
        made->min[k] = 0.01;
    made->composition =
        molecules_topology(&made->molecules.topology, molecules_chain(20, types, 2, 1, 0),
                           (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&made->molecules, BONDED_BOND, &mf_bond_harmonic, NULL);
    make_state(made, 0, 1);
    make_state(made, 1, 2);
    for (size_t s = 0; s < STATES; s++)
        sample_state(made, s, factor[s]);
}

static void clear(struct made *made) {
    for (size_t s = 0; s < STATES; s++) {
        mf_inversion_basis_clear(&made->state[s].low_rank);
        mf_potential_grid_clear(&made->state[s].grid);
    }
    mf_molecules_clear(&made->molecules);
}

/// Both states see what U lacks but for a constant, so that their mean does, in all bins. Within
/// 0.02: bins that are not seen have a weight of a hundredth in the coarse part.
static void test_constants_of_states_do_not_bend_the_mean(void **state) {
    static const double factors[][STATES] = {{1, 1}, {1.5, 0.6}};
    static struct made made;
    double step[3 * BINS] = {0};
    (void)state;
    for (size_t n = 0; n < 2; n++) {
        make(&made, factors[n]);
        assert_ok(mf_inversion_states_low_rank_step(made.state, STATES, step));
        const size_t *point = made.state[0].grid.known_point;
        const double constant = step[point[FIRST]] - wanted(FIRST);
        for (size_t k = 0; k < BINS; k++)
            assert_close(step[point[k]] - constant, wanted(k), 0.02);
        clear(&made);
    }
}

/// In the first state's samples there are 40 where its target has none: it does not say so.
static void test_what_a_state_has_not_seen_is_no_news_of_it(void **state) {
    static const double factor[STATES] = {1, 1};
    static struct made made;
    double step[3 * BINS] = {0}, again[3 * BINS] = {0};
    (void)state;
    make(&made, factor);
    assert_ok(mf_inversion_states_low_rank_step(made.state, STATES, step));
    for (size_t k = 0; k < BINS; k++)
        assert_int_equal(made.state[0].grid.seen[k], is_seen(0, k));
    made.counts[0][0] = 4000;
    assert_ok(mf_inversion_states_low_rank_step(made.state, STATES, again));
    for (size_t k = 0; k < made.state[0].grid.points; k++)
        assert_close(step[k], again[k], 1e-12);
    clear(&made);
}

/// Start and reference are those of the state that has seen most, whichever is the first.
static void test_widest_state_is_that_which_has_seen_most(void **state) {
    static bool all[BINS], some[BINS];
    (void)state;
    for (size_t k = 0; k < BINS; k++) {
        all[k] = true;
        some[k] = k >= FIRST;
    }
    struct inversion_state two[STATES] = {{.grid = {.known = BINS, .seen = some}},
                                          {.grid = {.known = BINS, .seen = all}}};
    assert_int_equal(mf_inversion_states_widest(two, STATES), 1);
    assert_int_equal(mf_inversion_states_widest(two, 1), 0);
    two[1].grid.seen = some;
    assert_int_equal(mf_inversion_states_widest(two, STATES), 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_constants_of_states_do_not_bend_the_mean),
        cmocka_unit_test(test_what_a_state_has_not_seen_is_no_news_of_it),
        cmocka_unit_test(test_widest_state_is_that_which_has_seen_most),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
