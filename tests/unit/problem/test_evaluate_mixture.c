// SPDX-License-Identifier: GPL-3.0-or-later
//
// Candidates of a mixture that begin where another has ended keep the types of their beads.
#include "problem/evaluate.h"

#include "base/rng.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { COUNT = 200, BINS = 10, PAIRS = 6 };

static const struct rdf_bins bins = {0, 0.1, BINS};

/// At this time step nothing moves far while it is measured [τ].
static const double no_time = 1e-9;

/// A mixture of three types in slabs across x: beads of one type are together.
struct slabs {
    struct fluid fluid;
    double g[PAIRS * BINS], error[PAIRS * BINS], memory[3][COUNT];
    double *position[3];
    struct inverse_problem problem;
};

static void begin(struct slabs *slabs) {
    struct rng_sequence random = mf_rng_sequence_begin(4, RNG_INITIAL, 0, 0);
    *slabs = (struct slabs){0};
    fluid_mixture(&slabs->fluid, COUNT, no_time);
    const double edge = slabs->fluid.setup.box.length[0];
    for (int n = 0; n < PAIRS * BINS; n++) {
        slabs->g[n] = 1;
        slabs->error[n] = 0.01;
    }
    for (int k = 0; k < COUNT; k++) {
        slabs->memory[0][k] = edge * (k + 0.5) / COUNT;
        slabs->memory[1][k] = edge * mf_rng_sequence_uniform(&random);
        slabs->memory[2][k] = edge * mf_rng_sequence_uniform(&random);
    }
    for (int d = 0; d < 3; d++)
        slabs->position[d] = slabs->memory[d];
    slabs->problem =
        (struct inverse_problem){.targets = {.bins = bins,
                                             .target[TARGET_RDF] = {.count = PAIRS * BINS,
                                                                    .value = slabs->g,
                                                                    .error = slabs->error,
                                                                    .weight = 0}},
                                 .scene = slabs->fluid.setup,
                                 .threads = 1};
}

/// g of each pair type, by all pairs of ids.
static void count_g(const struct slabs *slabs, double *g) {
    const struct composition *composition = &slabs->fluid.setup.composition;
    const struct box *box = &slabs->fluid.setup.box;
    for (int n = 0; n < PAIRS * BINS; n++)
        g[n] = 0;
    for (uint32_t i = 0; i < COUNT; i++)
        for (uint32_t j = i + 1; j < COUNT; j++) {
            const size_t pair = (size_t)mf_composition_pair_of_ids(composition, i, j);
            double square = 0;
            for (int d = 0; d < 3; d++) {
                const double x =
                    box_nearest(slabs->memory[d][i] - slabs->memory[d][j], box->length[d]);
                square += x * x;
            }
            const size_t bin = (size_t)(sqrt(square) / bins.width);
            if (bin < BINS)
                g[pair * BINS + bin] +=
                    1 / mf_rdf_ideal_pairs_of(&bins, bin, box, composition, (int)pair);
        }
}

static void test_evaluate_keeps_types_and_places_when_it_begins_where_another_ended(void **state) {
    (void)state;
    struct slabs slabs;
    double expected[PAIRS * BINS], features[PAIRS * BINS], memory[3][COUNT] = {{0}};
    struct evaluate_result result;
    begin(&slabs);
    count_g(&slabs, expected);
    // Like beads are together, unlike ones apart: types matter here.
    assert_true(expected[5] > 2 && expected[BINS + 5] < 0.8);
    const struct evaluate_parameters parameters = {
        .plan = {.equilibration = 20, .samples = 4, .every = 1}, .temperature_tolerance = 0.9};
    // Twice: the second begins where the first has ended.
    for (uint64_t seed = 11; seed <= 12; seed++) {
        const struct evaluate_candidate candidate = {.potential = &slabs.fluid.potential,
                                                     .omega = &slabs.fluid.omega,
                                                     .position =
                                                         (const double *const *)slabs.position,
                                                     .discard_above = HUGE_VAL,
                                                     .threads = 1,
                                                     .seed = seed};
        double *ended[3] = {memory[0], memory[1], memory[2]};
        assert_ok(
            mf_evaluate(&slabs.problem, &candidate, &parameters, features, NULL, ended, &result));
        // A pair at an edge may be rounded to either side.
        for (int n = 0; n < PAIRS * BINS; n++)
            assert_close(features[n], expected[n], 0.05 + 0.1 * expected[n]);
        for (int d = 0; d < 3; d++)
            for (int k = 0; k < COUNT; k++) {
                const double moved =
                    box_nearest(memory[d][k] - slabs.memory[d][k], slabs.fluid.setup.box.length[d]);
                assert_close(moved, 0, 1e-6);
            }
        memcpy(slabs.memory, memory, sizeof memory);
    }
    fluid_clear(&slabs.fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_evaluate_keeps_types_and_places_when_it_begins_where_another_ended),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
