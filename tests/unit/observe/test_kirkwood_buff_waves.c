// SPDX-License-Identifier: GPL-3.0-or-later
//
// Kirkwood and Buff's integrals of what is known exactly: an ideal gas in a closed box, pairs of
// beads that always stand so far apart, and molecules at random.
#include "base/rng.h"
#include "base/statistics.h"
#include "observe/kirkwood_buff.h"
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

enum { EACH = 500, CONFIGURATIONS = 400, PAIRS = 3 };

static const struct box box = {3, {8, 8, 8}};
static const double volume = 512, distance = 0.5, q_maximum = 2;

/// Standard errors by which a mean may be off: one false alarm in 15,000 values; seeds are fixed.
static const double deviations = 4;

static void place_at_random(struct rng_sequence *random, double place[3]) {
    for (int d = 0; d < 3; d++)
        place[d] = box.length[d] * mf_rng_sequence_uniform(random);
}

/// A vector of length 1 in a direction at random.
static void turn_at_random(struct rng_sequence *random, double vector[3]) {
    const double cosine = 2 * mf_rng_sequence_uniform(random) - 1;
    const double angle = 2 * M_PI * mf_rng_sequence_uniform(random);
    const double sine = sqrt(1 - cosine * cosine);
    vector[0] = sine * cos(angle), vector[1] = sine * sin(angle), vector[2] = cosine;
}

/// A at random; B at random, or each so far from its A in a direction at random.
static void place(struct particles *particles, struct rng_sequence *random, bool bound) {
    for (size_t k = 0; k < EACH; k++) {
        double a[3], b[3], apart[3];
        place_at_random(random, a);
        place_at_random(random, b);
        turn_at_random(random, apart);
        for (int d = 0; d < 3; d++) {
            particles->position[d][k] = a[d];
            particles->position[d][EACH + k] = bound ? a[d] + distance * apart[d] : b[d];
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
    assert_ok(mf_kirkwood_buff_waves_init(&kb, &box, &composition, 2 * EACH, NULL, q_maximum));
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

// Molecules ---------------------------------------------------------------------------------------

enum { DIMERS = 300, TRIMERS = 300, SINGLE = DIMERS, COMPONENTS = 3, MOLECULE_PAIRS = 6 };

/// Each C at the middle of a dimer A-B, and straight trimers A-A-A, across the borders of the box.
static void place_molecules(struct particles *particles, const struct topology *topology,
                            struct rng_sequence *random) {
    static const double arm = 1.5;
    for (size_t n = 0; n < DIMERS + TRIMERS; n++) {
        const struct topology_kind *kind = &topology->kind[n < DIMERS ? 0 : 1];
        const int64_t m = (int64_t)(n < DIMERS ? n : n - DIMERS);
        double middle[3], along[3];
        place_at_random(random, middle);
        turn_at_random(random, along);
        for (int d = 0; d < 3; d++) {
            for (int bead = 0; bead < kind->beads; bead++) {
                const double x = middle[d] + arm * along[d] * (1 - 2.0 * bead / (kind->beads - 1));
                particles->position[d][topology_id(kind, m, bead)] =
                    x - box.length[d] * floor(x / box.length[d]);
            }
            if (n < DIMERS)
                particles->position[d][particles->count - SINGLE + n] = middle[d];
        }
    }
}

/// What is within a molecule is no part of G: it is 0 of molecules at random, and 1/ρ of those with
/// a bead of their own at the site. If the first bead were the site, this would be 16 % less (as
/// of bound pairs above), and if all beads were, G of a kind would be 1/ρ or more.
static void test_kirkwood_buff_waves_of_molecules_are_those_of_their_sites(void **state) {
    (void)state;
    static const int dimer[] = {0, 1}, trimer[] = {0, 0, 0};
    struct topology topology;
    const struct composition beads = molecules_topology(
        &topology, molecules_chain(DIMERS, dimer, 2, BONDED_BOND, 1),
        molecules_chain(TRIMERS, trimer, 3, BONDED_BOND, 1), 3, (const int64_t[]){0, 0, SINGLE});
    const size_t count = topology.particles;
    struct rng_sequence random = mf_rng_sequence_begin(11, RNG_PLACEMENT, 0, 0);
    struct running_mean mean[MOLECULE_PAIRS] = {0};
    struct kirkwood_buff_waves kb;
    struct particles particles;
    snprintf(topology.kind[1].name, TOPOLOGY_NAME_SIZE, "trimer");
    assert_ok(mf_particles_init(&particles, &box, count));
    assert_ok(mf_particles_join(&particles, &topology));
    for (size_t k = 0; k < count; k++)
        particles.id[k] = (uint32_t)k;
    mf_particles_label_places(&particles);
    assert_ok(mf_kirkwood_buff_waves_init(&kb, &box, &beads, count, &topology, q_maximum));
    assert_int_equal(mf_kirkwood_buff_waves_components(&kb)->types, COMPONENTS);
    for (int n = 0; n < CONFIGURATIONS; n++) {
        double integral[MOLECULE_PAIRS];
        place_molecules(&particles, &topology, &random);
        mf_kirkwood_buff_waves_take(&kb, &particles, 1, integral);
        for (int pair = 0; pair < MOLECULE_PAIRS; pair++)
            mf_statistics_add(&mean[pair], integral[pair]);
    }
    for (int pair = 0; pair < MOLECULE_PAIRS; pair++)
        check(&mean[pair], pair == 2 ? volume / DIMERS : 0); // dimer-C
    mf_kirkwood_buff_waves_clear(&kb);
    mf_particles_clear(&particles);
    mf_topology_clear(&topology);
}

/// A few of Kremer and Grest's chains of 50 beads, R_g² = 13.7 at density 0.85 (lab/molecules.md),
/// among single beads: the mean distance of sites is that of beads, but the waves stay longer than
/// a chain. Those of dimers are as without the bond.
static void test_kirkwood_buff_waves_are_longer_than_the_molecules(void **state) {
    (void)state;
    enum { CHAIN = 50, ALL = 20000 };
    static const int types[CHAIN] = {0};
    static const double density = 0.85, size = 3.7;
    const double edge = cbrt(ALL / density);
    const struct box large = {3, {edge, edge, edge}};
    struct topology chains, dimers;
    molecules_topology(&chains, molecules_chain(10, types, CHAIN, BONDED_BOND, 1),
                       (struct topology_kind){0}, 1, (const int64_t[]){ALL - 10 * CHAIN});
    molecules_topology(&dimers, molecules_chain(10, types, 2, BONDED_BOND, 1),
                       (struct topology_kind){0}, 1, (const int64_t[]){ALL - 10 * 2});
    const double free = mf_kirkwood_buff_waves_maximum(&large, ALL, ALL, NULL, 0);
    assert_true(free * size > 4);
    assert_true(mf_kirkwood_buff_waves_maximum(&large, ALL - 490, ALL, &chains, 0) * size < 1.3);
    assert_true(mf_kirkwood_buff_waves_maximum(&large, ALL, ALL, &dimers, 0) == free);
    assert_true(mf_kirkwood_buff_waves_maximum(&large, ALL - 490, ALL, &chains, 2) == 2);
    mf_topology_clear(&chains);
    mf_topology_clear(&dimers);
}

static void test_kirkwood_buff_waves_need_two_lengths(void **state) {
    (void)state;
    const struct composition few = mf_composition_of_one(300);
    struct kirkwood_buff_waves kb;
    assert_int_equal(mf_kirkwood_buff_waves_init(&kb, &box, &few, 300, NULL, 0), STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "all have one length");
    mf_kirkwood_buff_waves_clear(&kb);
    assert_int_equal(mf_kirkwood_buff_waves_init(&kb, &box, &few, 300, NULL, 0.1),
                     STATUS_BAD_INPUT);
    assert_contains(mf_status_message(), "below that of the longest wave");
    mf_kirkwood_buff_waves_clear(&kb);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kirkwood_buff_waves_of_an_ideal_gas_have_no_integral),
        cmocka_unit_test(test_kirkwood_buff_waves_of_bound_pairs_count_the_partner),
        cmocka_unit_test(test_kirkwood_buff_waves_of_molecules_are_those_of_their_sites),
        cmocka_unit_test(test_kirkwood_buff_waves_are_longer_than_the_molecules),
        cmocka_unit_test(test_kirkwood_buff_waves_need_two_lengths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
