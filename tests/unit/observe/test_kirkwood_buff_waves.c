// SPDX-License-Identifier: GPL-3.0-or-later
//
// Kirkwood and Buff's integrals of what is known exactly: an ideal gas in a closed box, and pairs
// of beads that always stand so far apart.
#include "base/rng.h"
#include "base/statistics.h"
#include "observe/kirkwood_buff_waves.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>

enum { EACH = 500, CONFIGURATIONS = 400, PAIRS = 3 };

static const struct box box = {3, {8, 8, 8}};
static const double volume = 512, distance = 0.5, q_maximum = 2;

/// Standard errors by which a mean may be off: one false alarm in 15,000 values; seeds are fixed.
static const double deviations = 4;

/// A at random; B at random, or each so far from its A in a direction at random.
static void place(struct particles *particles, struct rng_sequence *random, bool bound) {
    for (size_t k = 0; k < EACH; k++) {
        const double cosine = 2 * mf_rng_sequence_uniform(random) - 1;
        const double angle = 2 * M_PI * mf_rng_sequence_uniform(random);
        const double sine = sqrt(1 - cosine * cosine);
        const double apart[3] = {sine * cos(angle), sine * sin(angle), cosine};
        for (int d = 0; d < 3; d++) {
            double *x = particles->position[d];
            x[k] = box.length[d] * mf_rng_sequence_uniform(random);
            x[EACH + k] = bound ? x[k] + distance * apart[d]
                                : box.length[d] * mf_rng_sequence_uniform(random);
        }
    }
}

static void measure(bool bound, struct running_mean mean[PAIRS]) {
    static const struct composition composition = {
        .types = 2, .count = {EACH, EACH}, .name = {"A", "B"}};
    struct rng_sequence random = mf_rng_sequence_begin(7, RNG_PLACEMENT, 0, 0);
    struct kirkwood_buff_waves kb;
    struct particles particles;
    assert_ok(mf_particles_init(&particles, &box, 2 * EACH));
    for (size_t k = 0; k < 2 * EACH; k++)
        particles.id[k] = (uint32_t)k;
    assert_ok(mf_kirkwood_buff_waves_init(&kb, &box, &composition, 2 * EACH, q_maximum));
    for (int n = 0; n < CONFIGURATIONS; n++) {
        double integral[PAIRS];
        place(&particles, &random, bound);
        mf_kirkwood_buff_waves_take(&kb, &particles, 1, integral);
        for (int pair = 0; pair < PAIRS; pair++)
            mf_statistics_add(&mean[pair], integral[pair]);
    }
    mf_kirkwood_buff_waves_clear(&kb);
    mf_particles_clear(&particles);
}

static void check(const struct running_mean *mean, double exact) {
    const double error = mf_statistics_standard_error(mean);
    print_message("G = %.4f(%.4f), exactly %.4f\n", mean->mean, error, exact);
    assert_true(error < 0.05);
    assert_close(mean->mean, exact, deviations * error);
}

/// The integral of g over the closed box would be off by −1/ρ_a = −1.024.
static void test_kirkwood_buff_waves_of_an_ideal_gas_have_no_integral(void **state) {
    (void)state;
    struct running_mean mean[PAIRS] = {0};
    measure(false, mean);
    for (int pair = 0; pair < PAIRS; pair++)
        check(&mean[pair], 0);
}

/// One B about each A beyond those at random: G_AB = 1/ρ_A. S_AB = sin(qℓ)/(qℓ), of which the line
/// keeps (5/21) (q_maximum ℓ)⁴/120, 0.002, of its term in q⁴.
static void test_kirkwood_buff_waves_of_bound_pairs_count_the_partner(void **state) {
    (void)state;
    struct running_mean mean[PAIRS] = {0};
    measure(true, mean);
    check(&mean[0], 0);
    check(&mean[1], volume / EACH * (1 - 5.0 / 21 * pow(q_maximum * distance, 4) / 120));
    check(&mean[2], 0);
}

static void test_kirkwood_buff_waves_need_two_lengths(void **state) {
    (void)state;
    const struct composition few = mf_composition_of_one(300);
    struct kirkwood_buff_waves kb;
    assert_int_equal(mf_kirkwood_buff_waves_init(&kb, &box, &few, 300, 0), STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "all have one length");
    mf_kirkwood_buff_waves_clear(&kb);
    assert_int_equal(mf_kirkwood_buff_waves_init(&kb, &box, &few, 300, 0.1), STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "below that of the longest wave");
    mf_kirkwood_buff_waves_clear(&kb);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kirkwood_buff_waves_of_an_ideal_gas_have_no_integral),
        cmocka_unit_test(test_kirkwood_buff_waves_of_bound_pairs_count_the_partner),
        cmocka_unit_test(test_kirkwood_buff_waves_need_two_lengths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
