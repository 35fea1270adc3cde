// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every instance of the pair kernels against the sum over all pairs in double precision.
#include "base/simd.h"
#include "forces/pair.h"

#include "base/memory.h"
#include "shared/all_pairs.h"
#include "shared/is_close.h"
#include "shared/pair_scales.h"
#include "shared/pairs.h"
#include "shared/testing.h"
#include "shared/variants.h"

#include <stdio.h>

/// What a precision may be wrong by.
struct tolerances {
    /// A force, relative to the sum over its pairs of |F| + r |dF/dr|: a dozen roundings of 6e-8 or
    /// 1.1e-16 in F each, most of them in the same direction at worst, and as many in r. In double
    /// precision the reference is wrong by as much, and sums over some hundred pairs are rounded.
    double force;
    double sum; ///< energy and virial, relative to Σ |Φ| and Σ |r Φ'|
};
static const struct tolerances tolerances[] = {
    [PAIR_MIXED] = {1e-6, 1e-5}, [PAIR_DOUBLE] = {5e-15, 1e-13}};

/// What the order of double-precision additions can change, relative to the largest partial sum.
static const double rounding = 1e-13;

static struct variant variants[VARIANTS_MAX];
static int variant_count;

static int begin(void **state) {
    variant_count = variants_find(variants);
    return pairs_begin(state);
}

static double *copy_forces(const struct particles *particles) {
    double *copy = mf_memory_zeroed(3 * particles->count, sizeof *copy);
    assert_non_null(copy);
    for (int d = 0; d < particles->box.dimensions; d++)
        memcpy(copy + (size_t)d * particles->count, particles->force[d],
               particles->count * sizeof *copy);
    return copy;
}

static void check_forces(const struct particles *particles, const double *expected,
                         const double *scale, double tolerance, const char *label) {
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++) {
            const double force = particles->force[d][k];
            const double reference = expected[(size_t)d * particles->count + k];
            if (!is_close(force, reference, tolerance * scale[k]))
                fail_msg("%s: force[%d][%zu] = %.9g, but %.9g from all pairs (scale %.3g)", label,
                         d, k, force, reference, scale[k]);
        }
}

/// Σ F = 0 up to the rounding of double additions.
static void check_momentum(const struct particles *particles, const char *label) {
    for (int d = 0; d < particles->box.dimensions; d++) {
        double sum = 0, size = 0;
        for (size_t k = 0; k < particles->count; k++) {
            sum += particles->force[d][k];
            size += fabs(particles->force[d][k]);
        }
        if (!is_close(sum, 0, rounding * size))
            fail_msg("%s: the forces along %d sum to %g, of %g", label, d, sum, size);
    }
}

static void check_sums(const struct pair_sums *sums, const struct pair_sums *expected,
                       const struct pair_scales *scales, double tolerance) {
    assert_close(sums->energy, expected->energy, tolerance * scales->energy);
    assert_close(sums->virial, expected->virial, tolerance * scales->virial);
}

/// One law on one system, with every variant of the kernels, with and without sums.
static void check_law(const struct pairs_system *system, const struct pair_law *of_any_precision) {
    struct pair_law law = *of_any_precision;
    struct particles particles;
    struct neighbours neighbours;
    struct pair_sums expected, sums;
    const uint64_t step = 0x100000007;
    pairs_make(&particles, &neighbours, system, &law);
    all_pairs_forces(&law, &particles, step, &expected);
    double *reference = copy_forces(&particles);
    struct pair_scales scales = pair_scales_find(&law, &particles);
    for (int v = 0; v < variant_count; v++) {
        const struct tolerances allowed = tolerances[variants[v].precision];
        variants_select(&variants[v]);
        assert_string_equal(mf_simd_name(), variants[v].instruction_set);
        law.precision = variants[v].precision;
        char label[100];
        snprintf(label, sizeof label, "%s, %dD, N = %zu, potential %d, omega %d", variants[v].name,
                 system->box.dimensions, system->count, law.potential != NULL, law.omega != NULL);
        mf_pair_forces(&law, &particles, &neighbours, step, PAIR_FORCES, NULL);
        check_forces(&particles, reference, scales.force, allowed.force, label);
        check_momentum(&particles, label);
        double *without_sums = copy_forces(&particles);
        mf_pair_forces(&law, &particles, &neighbours, step, PAIR_FORCES_AND_SUMS, &sums);
        check_forces(&particles, without_sums, scales.force, 0, label);
        check_sums(&sums, &expected, &scales, allowed.sum);
        mf_memory_free(without_sums);
    }
    mf_memory_free(reference);
    pair_scales_clear(&scales);
    mf_particles_clear(&particles);
    mf_neighbours_clear(&neighbours);
}

/// Φ alone, ω alone, and both; the cutoff of ω equal to that of Φ, below it, and above it.
static void check_all_laws(const struct pairs_system *system, const struct table *potential) {
    const struct table *omegas[] = {&pairs_tables.omega, &pairs_tables.thesis_omega};
    struct pair_law law = pairs_law(potential, NULL);
    check_law(system, &law);
    for (int w = 0; w < 2; w++) {
        law = pairs_law(potential, omegas[w]);
        check_law(system, &law);
        law = pairs_law(NULL, omegas[w]);
        check_law(system, &law);
    }
}

static void test_pair_kernels_agree_with_all_pairs_when_on_a_lattice(void **state) {
    (void)state;
    const struct pairs_system three = {{3, {7.3, 6.1, 5.7}}, 210, PAIRS_LATTICE, 0.3};
    const struct pairs_system two = {{2, {11, 13.5, 1}}, 121, PAIRS_LATTICE, 0.2};
    check_all_laws(&three, &pairs_tables.lennard_jones);
    check_all_laws(&two, &pairs_tables.lennard_jones);
}

static void test_pair_kernels_agree_with_all_pairs_when_random(void **state) {
    (void)state;
    const struct pairs_system three = {{3, {5.1, 4.6, 6.3}}, 443, PAIRS_RANDOM, 0.25};
    const struct pairs_system two = {{2, {9.1, 7.7, 1}}, 301, PAIRS_RANDOM, 0.25};
    check_all_laws(&three, &pairs_tables.soft);
    check_all_laws(&three, &pairs_tables.sampled);
    check_all_laws(&three, &pairs_tables.gaussian);
    check_all_laws(&two, &pairs_tables.soft);
    check_all_laws(&two, &pairs_tables.sampled);
    check_all_laws(&two, &pairs_tables.gaussian);
}

static void test_pair_kernels_agree_with_all_pairs_when_box_is_very_long(void **state) {
    (void)state;
    const struct pairs_system three = {{3, {60, 4.1, 4.3}}, 700, PAIRS_RANDOM, 0.3};
    const struct pairs_system two = {{2, {4.2, 80, 1}}, 500, PAIRS_RANDOM, 0.3};
    check_all_laws(&three, &pairs_tables.soft);
    check_all_laws(&two, &pairs_tables.soft);
}

static void test_pair_kernels_agree_with_all_pairs_when_box_is_two_cutoffs(void **state) {
    (void)state;
    const struct pairs_system three = {{3, {3.4401, 3.45, 3.47}}, 157, PAIRS_RANDOM, 0.4};
    const struct pairs_system two = {{2, {3.4401, 3.45, 1}}, 61, PAIRS_RANDOM, 0.4};
    check_all_laws(&three, &pairs_tables.soft);
    check_all_laws(&two, &pairs_tables.soft);
    const struct pairs_system lattice = {{3, {5.0001, 5.0001, 5.0001}}, 125, PAIRS_LATTICE, 0.4};
    const struct pair_law law = pairs_law(&pairs_tables.lennard_jones, &pairs_tables.omega);
    check_law(&lattice, &law);
}

/// Every remainder of the number of lanes, in pairs and in particles.
static void test_pair_kernels_agree_with_all_pairs_when_particles_are_few(void **state) {
    (void)state;
    for (size_t count = 2; count <= 40; count++) {
        const struct pairs_system three = {{3, {4.1, 4.4, 4.8}}, count, PAIRS_CLUSTERED, 0.3};
        const struct pairs_system two = {{2, {4.1, 4.4, 1}}, count, PAIRS_CLUSTERED, 0.3};
        check_all_laws(&three, &pairs_tables.soft);
        check_all_laws(&two, &pairs_tables.soft);
    }
}

/// Every pair type with a potential and an ω of its own, of different cutoffs; some have none.
static void check_mixture(const struct pairs_system *system,
                          const struct composition *composition) {
    const struct table *const potentials[] = {
        &pairs_tables.soft,     &pairs_tables.sampled,       NULL,
        &pairs_tables.gaussian, &pairs_tables.lennard_jones, &pairs_tables.soft};
    const struct table *const omegas[] = {&pairs_tables.thesis_omega, &pairs_tables.omega,
                                          &pairs_tables.omega,        NULL,
                                          &pairs_tables.thesis_omega, &pairs_tables.omega};
    struct table parts[2][6] = {{{0}}}, potential, omega;
    const int pairs = mf_composition_pairs(composition);
    for (int p = 0; p < pairs; p++) {
        if (potentials[p])
            parts[0][p] = *potentials[p];
        if (omegas[p])
            parts[1][p] = *omegas[p];
    }
    assert_ok(mf_table_stack(&potential, parts[0], pairs));
    assert_ok(mf_table_stack(&omega, parts[1], pairs));
    struct pair_law laws[] = {pairs_law(&potential, NULL), pairs_law(NULL, &omega),
                              pairs_law(&potential, &omega), pairs_law(&pairs_tables.soft, &omega),
                              pairs_law(&potential, &pairs_tables.omega)};
    for (size_t n = 0; n < sizeof laws / sizeof *laws; n++) {
        laws[n].composition = *composition;
        check_law(system, &laws[n]);
    }
    mf_table_clear(&potential);
    mf_table_clear(&omega);
}

static void test_pair_kernels_agree_with_all_pairs_when_types_differ(void **state) {
    (void)state;
    const struct composition two_types = {.types = 2, .count = {120, 181}},
                             three_types = {.types = 3, .count = {20, 150, 131}};
    const struct pairs_system three = {{3, {5.1, 5.6, 6.3}}, 301, PAIRS_RANDOM, 0.25};
    const struct pairs_system two = {{2, {9.1, 7.7, 1}}, 301, PAIRS_RANDOM, 0.25};
    check_mixture(&three, &two_types);
    check_mixture(&three, &three_types);
    check_mixture(&two, &two_types);
    check_mixture(&two, &three_types);
}

static void test_pair_kernels_agree_with_all_pairs_when_types_differ_and_are_few(void **state) {
    (void)state;
    for (int count = 6; count <= 36; count += 3) {
        const struct composition composition = {.types = 3, .count = {1, 3, count - 4}};
        const struct pairs_system system = {
            {3, {5.1, 5.4, 5.8}}, (size_t)count, PAIRS_CLUSTERED, 0.3};
        check_mixture(&system, &composition);
    }
}

static void test_pair_kernels_give_no_force_when_pairs_are_out_of_range(void **state) {
    (void)state;
    const struct pairs_system system = {{3, {12, 12, 12}}, 27, PAIRS_LATTICE, 0.3};
    const struct pair_law law = pairs_law(&pairs_tables.soft, &pairs_tables.omega);
    check_law(&system, &law);
}

static void test_pair_kernels_give_no_force_when_there_is_no_law(void **state) {
    (void)state;
    const struct pairs_system system = {{3, {5, 5, 5}}, 60, PAIRS_RANDOM, 0.3};
    const struct pair_law some = pairs_law(&pairs_tables.soft, NULL), none = pairs_law(NULL, NULL);
    struct particles particles;
    struct neighbours neighbours;
    struct pair_sums sums = {1, 1};
    pairs_make(&particles, &neighbours, &system, &some);
    mf_pair_forces(&some, &particles, &neighbours, 1, PAIR_FORCES, NULL);
    assert_true(mf_particles_largest_force(&particles) > 0);
    mf_pair_forces(&none, &particles, &neighbours, 1, PAIR_FORCES_AND_SUMS, &sums);
    assert_identical(mf_particles_largest_force(&particles), 0);
    assert_identical(sums.energy, 0);
    assert_identical(sums.virial, 0);
    assert_identical(mf_pair_cutoff(&none), 0);
    mf_particles_clear(&particles);
    mf_neighbours_clear(&neighbours);
}

/// Two particles on one spot have no direction: no force, not NaN.
static void test_pair_kernels_give_no_force_when_particles_coincide(void **state) {
    (void)state;
    const struct pairs_system system = {{3, {5, 5, 5}}, 2, PAIRS_CLUSTERED, 0.3};
    struct pair_law law = pairs_law(&pairs_tables.soft, &pairs_tables.omega);
    for (int v = 0; v < variant_count; v++) {
        variants_select(&variants[v]);
        law.precision = variants[v].precision;
        struct particles particles;
        struct neighbours neighbours;
        pairs_place(&particles, &system);
        for (int d = 0; d < 3; d++)
            particles.position[d][1] = particles.position[d][0];
        assert_ok(mf_neighbours_init(&neighbours, NEIGHBOURS_HALF, &system.box, 2, 1, 0.3));
        assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
        mf_particles_update_motion(&particles, 0);
        mf_pair_forces(&law, &particles, &neighbours, 1, PAIR_FORCES, NULL);
        assert_identical(mf_particles_largest_force(&particles), 0);
        mf_particles_clear(&particles);
        mf_neighbours_clear(&neighbours);
    }
}

static void test_pair_kernels_show_nan_when_a_velocity_is_nan(void **state) {
    (void)state;
    const struct pairs_system system = {{3, {5, 5, 5}}, 300, PAIRS_RANDOM, 0.3};
    struct pair_law law = pairs_law(&pairs_tables.soft, &pairs_tables.omega);
    struct particles particles;
    struct neighbours neighbours;
    pairs_make(&particles, &neighbours, &system, &law);
    particles.velocity[1][7] = NAN;
    mf_particles_update_motion(&particles, 0);
    for (int v = 0; v < variant_count; v++) {
        variants_select(&variants[v]);
        law.precision = variants[v].precision;
        mf_pair_forces(&law, &particles, &neighbours, 1, PAIR_FORCES, NULL);
        assert_true(isnan(mf_particles_largest_force(&particles)));
    }
    mf_particles_clear(&particles);
    mf_neighbours_clear(&neighbours);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pair_kernels_agree_with_all_pairs_when_on_a_lattice),
        cmocka_unit_test(test_pair_kernels_agree_with_all_pairs_when_random),
        cmocka_unit_test(test_pair_kernels_agree_with_all_pairs_when_box_is_very_long),
        cmocka_unit_test(test_pair_kernels_agree_with_all_pairs_when_box_is_two_cutoffs),
        cmocka_unit_test(test_pair_kernels_agree_with_all_pairs_when_particles_are_few),
        cmocka_unit_test(test_pair_kernels_agree_with_all_pairs_when_types_differ),
        cmocka_unit_test(test_pair_kernels_agree_with_all_pairs_when_types_differ_and_are_few),
        cmocka_unit_test(test_pair_kernels_give_no_force_when_pairs_are_out_of_range),
        cmocka_unit_test(test_pair_kernels_give_no_force_when_there_is_no_law),
        cmocka_unit_test(test_pair_kernels_give_no_force_when_particles_coincide),
        cmocka_unit_test(test_pair_kernels_show_nan_when_a_velocity_is_nan),
    };
    return cmocka_run_group_tests(tests, begin, pairs_end);
}
