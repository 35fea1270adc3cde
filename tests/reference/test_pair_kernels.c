// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every instance of the pair kernels against the sum over all pairs in double precision.
#include "base/simd.h"
#include "forces/pair.h"

#include "base/memory.h"
#include "base/rng.h"
#include "curves/formula.h"
#include "curves/sampled.h"
#include "forces/reference_forces.h"
#include "shared/is_close.h"
#include "shared/pair_scales.h"
#include "shared/testing.h"
#include "shared/variants.h"
#include "system/placement.h"

#include <stdio.h>
#include <stdlib.h>

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

static struct variant variants[VARIANTS_MOST];
static int variant_count;

/// Interactions used by all tests.
static struct { struct table soft, lennard_jones, gaussian, sampled, omega, thesis_omega; } tables;

static void make_sampled(struct curve *curve) {
    enum { POINTS = 60 };
    double r[POINTS], phi[POINTS];
    for (int k = 0; k < POINTS; k++) {
        r[k] = 0.4 + 1.2 * k / (POINTS - 1);
        phi[k] = 5 * exp(-4 * r[k]) * cos(6 * r[k]) * (1.6 - r[k]);
    }
    assert_ok(mf_sampled_create(curve, r, phi, POINTS));
}

static int make_tables(void **state) {
    (void)state;
    variant_count = variants_find(variants);
    struct curve curve;
    assert_ok(mf_curve_create(&curve, &mf_formula_soft_repulsion));
    assert_ok(mf_table_init_potential(&tables.soft, &curve));
    mf_curve_clear(&curve);
    assert_ok(mf_curve_create(&curve, &mf_formula_lennard_jones));
    assert_ok(mf_table_init_potential(&tables.lennard_jones, &curve));
    mf_curve_clear(&curve);
    assert_ok(mf_curve_create(&curve, &mf_formula_gaussian));
    ((struct formula_gaussian_parameters *)curve.parameters)->cutoff = 2;
    assert_ok(mf_table_init_potential(&tables.gaussian, &curve));
    mf_curve_clear(&curve);
    make_sampled(&curve);
    assert_ok(mf_table_init_potential(&tables.sampled, &curve));
    mf_curve_clear(&curve);
    assert_ok(mf_curve_create(&curve, &mf_formula_power_omega));
    assert_ok(mf_table_init_omega(&tables.omega, &curve));
    struct formula_power_omega_parameters *omega = curve.parameters;
    *omega = (struct formula_power_omega_parameters){
        .sigma = 2.589, .exponent = 1, .inner_cutoff = 0.596, .cutoff = 1.72};
    assert_ok(mf_table_init_omega(&tables.thesis_omega, &curve));
    mf_curve_clear(&curve);
    return 0;
}

static int clear_tables(void **state) {
    (void)state;
    mf_table_clear(&tables.soft);
    mf_table_clear(&tables.lennard_jones);
    mf_table_clear(&tables.gaussian);
    mf_table_clear(&tables.sampled);
    mf_table_clear(&tables.omega);
    mf_table_clear(&tables.thesis_omega);
    return 0;
}

/// Where the particles of a system are.
enum arrangement { LATTICE, RANDOM, CLUSTERED };

struct system {
    struct box box;
    size_t count;
    enum arrangement arrangement;
    double skin;
};

static struct pair_law make_law(const struct table *potential, const struct table *omega) {
    return (struct pair_law){.potential = potential,
                             .omega = omega,
                             .temperature = 1.3,
                             .time_step = 0.02,
                             .seed = 0x123456789ABCDEF};
}

/// Uniform random positions; CLUSTERED: within 0.6 of the corner, on all sides of it.
static void place_random(struct particles *particles, double reach, uint64_t seed) {
    struct rng_sequence sequence = mf_rng_sequence_begin(seed, RNG_PLACEMENT, 0, 0);
    for (size_t k = 0; k < particles->count; k++)
        for (int d = 0; d < particles->box.dimensions; d++) {
            const double width = reach > 0 ? 2 * reach : particles->box.length[d];
            particles->position[d][k] = width * (mf_rng_sequence_uniform(&sequence) - 0.5);
        }
    mf_particles_wrap(particles);
}

static void make_particles(struct particles *particles, const struct system *system) {
    assert_ok(mf_particles_init(particles, &system->box, system->count));
    assert_ok(mf_particles_keep_precise(particles));
    if (system->arrangement == LATTICE)
        mf_placement_lattice(particles, 0.1, 5);
    else
        place_random(particles, system->arrangement == CLUSTERED ? 0.6 : 0, 5);
    mf_particles_draw_velocities(particles, 1.3, 6);
}

/// Particles, sorted, with their list and what the kernels read.
static void make_system(struct particles *particles, struct neighbours *neighbours,
                        const struct system *system, const struct pair_law *law) {
    make_particles(particles, system);
    assert_ok(mf_neighbours_init(neighbours, NEIGHBOURS_HALF, &system->box, system->count,
                                 mf_pair_cutoff(law), system->skin));
    assert_ok(mf_neighbours_sort_and_build(neighbours, particles));
    mf_particles_update_motion(particles, 0);
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
static void check_law(const struct system *system, const struct pair_law *of_any_precision) {
    struct pair_law law = *of_any_precision;
    struct particles particles;
    struct neighbours neighbours;
    struct pair_sums expected, sums;
    const uint64_t step = 0x100000007;
    make_system(&particles, &neighbours, system, &law);
    mf_reference_forces(&law, &particles, step, &expected);
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
static void check_all_laws(const struct system *system, const struct table *potential) {
    const struct table *omegas[] = {&tables.omega, &tables.thesis_omega};
    struct pair_law law = make_law(potential, NULL);
    check_law(system, &law);
    for (int w = 0; w < 2; w++) {
        law = make_law(potential, omegas[w]);
        check_law(system, &law);
        law = make_law(NULL, omegas[w]);
        check_law(system, &law);
    }
}

static void test_pair_kernels_agree_with_all_pairs_when_on_a_lattice(void **state) {
    (void)state;
    const struct system three = {{3, {7.3, 6.1, 5.7}}, 210, LATTICE, 0.3};
    const struct system two = {{2, {11, 13.5, 1}}, 121, LATTICE, 0.2};
    check_all_laws(&three, &tables.lennard_jones);
    check_all_laws(&two, &tables.lennard_jones);
}

static void test_pair_kernels_agree_with_all_pairs_when_random(void **state) {
    (void)state;
    const struct system three = {{3, {5.1, 4.6, 6.3}}, 443, RANDOM, 0.25};
    const struct system two = {{2, {9.1, 7.7, 1}}, 301, RANDOM, 0.25};
    check_all_laws(&three, &tables.soft);
    check_all_laws(&three, &tables.sampled);
    check_all_laws(&three, &tables.gaussian);
    check_all_laws(&two, &tables.soft);
    check_all_laws(&two, &tables.sampled);
    check_all_laws(&two, &tables.gaussian);
}

static void test_pair_kernels_agree_with_all_pairs_when_box_is_very_long(void **state) {
    (void)state;
    const struct system three = {{3, {60, 4.1, 4.3}}, 700, RANDOM, 0.3};
    const struct system two = {{2, {4.2, 80, 1}}, 500, RANDOM, 0.3};
    check_all_laws(&three, &tables.soft);
    check_all_laws(&two, &tables.soft);
}

static void test_pair_kernels_agree_with_all_pairs_when_box_is_two_cutoffs(void **state) {
    (void)state;
    const struct system three = {{3, {3.4401, 3.45, 3.47}}, 157, RANDOM, 0.4};
    const struct system two = {{2, {3.4401, 3.45, 1}}, 61, RANDOM, 0.4};
    check_all_laws(&three, &tables.soft);
    check_all_laws(&two, &tables.soft);
    const struct system lattice = {{3, {5.0001, 5.0001, 5.0001}}, 125, LATTICE, 0.4};
    const struct pair_law law = make_law(&tables.lennard_jones, &tables.omega);
    check_law(&lattice, &law);
}

/// Every remainder of the number of lanes, in pairs and in particles.
static void test_pair_kernels_agree_with_all_pairs_when_particles_are_few(void **state) {
    (void)state;
    for (size_t count = 2; count <= 40; count++) {
        const struct system three = {{3, {4.1, 4.4, 4.8}}, count, CLUSTERED, 0.3};
        const struct system two = {{2, {4.1, 4.4, 1}}, count, CLUSTERED, 0.3};
        check_all_laws(&three, &tables.soft);
        check_all_laws(&two, &tables.soft);
    }
}

/// Every pair type with a potential and an ω of its own, of different cutoffs; some have none.
static void check_mixture(const struct system *system, const struct composition *composition) {
    const struct table *const potentials[] = {
        &tables.soft, &tables.sampled, NULL, &tables.gaussian, &tables.lennard_jones, &tables.soft};
    const struct table *const omegas[] = {&tables.thesis_omega, &tables.omega, &tables.omega, NULL,
                                          &tables.thesis_omega, &tables.omega};
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
    struct pair_law laws[] = {make_law(&potential, NULL), make_law(NULL, &omega),
                              make_law(&potential, &omega), make_law(&tables.soft, &omega),
                              make_law(&potential, &tables.omega)};
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
    const struct system three = {{3, {5.1, 5.6, 6.3}}, 301, RANDOM, 0.25};
    const struct system two = {{2, {9.1, 7.7, 1}}, 301, RANDOM, 0.25};
    check_mixture(&three, &two_types);
    check_mixture(&three, &three_types);
    check_mixture(&two, &two_types);
    check_mixture(&two, &three_types);
}

static void test_pair_kernels_agree_with_all_pairs_when_types_differ_and_are_few(void **state) {
    (void)state;
    for (int count = 6; count <= 36; count += 3) {
        const struct composition composition = {.types = 3, .count = {1, 3, count - 4}};
        const struct system system = {{3, {5.1, 5.4, 5.8}}, (size_t)count, CLUSTERED, 0.3};
        check_mixture(&system, &composition);
    }
}

static void test_pair_kernels_give_no_force_when_pairs_are_out_of_range(void **state) {
    (void)state;
    const struct system system = {{3, {12, 12, 12}}, 27, LATTICE, 0.3};
    const struct pair_law law = make_law(&tables.soft, &tables.omega);
    check_law(&system, &law);
}

static void test_pair_kernels_give_no_force_when_there_is_no_law(void **state) {
    (void)state;
    const struct system system = {{3, {5, 5, 5}}, 60, RANDOM, 0.3};
    const struct pair_law some = make_law(&tables.soft, NULL), none = make_law(NULL, NULL);
    struct particles particles;
    struct neighbours neighbours;
    struct pair_sums sums = {1, 1};
    make_system(&particles, &neighbours, &system, &some);
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
    const struct system system = {{3, {5, 5, 5}}, 2, CLUSTERED, 0.3};
    struct pair_law law = make_law(&tables.soft, &tables.omega);
    for (int v = 0; v < variant_count; v++) {
        variants_select(&variants[v]);
        law.precision = variants[v].precision;
        struct particles particles;
        struct neighbours neighbours;
        make_particles(&particles, &system);
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
    const struct system system = {{3, {5, 5, 5}}, 300, RANDOM, 0.3};
    struct pair_law law = make_law(&tables.soft, &tables.omega);
    struct particles particles;
    struct neighbours neighbours;
    make_system(&particles, &neighbours, &system, &law);
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

/// Forces by id, in double precision.
static double *forces_by_id(const struct particles *particles) {
    double *forces = mf_memory_zeroed(3 * particles->count, sizeof *forces);
    assert_non_null(forces);
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++)
            forces[3 * particles->id[k] + (size_t)d] = particles->force[d][k];
    return forces;
}

/// Forces by id of a system whose arrays were shuffled before the sort, with another skin.
static double *shuffled_forces(const struct system *system, const struct pair_law *law,
                               uint64_t shuffle, double skin) {
    struct particles particles;
    struct neighbours neighbours;
    make_particles(&particles, system);
    uint32_t *order = mf_memory_zeroed(system->count, sizeof *order);
    assert_non_null(order);
    struct rng_sequence sequence = mf_rng_sequence_begin(shuffle, RNG_SELECTION, 0, 0);
    for (uint32_t k = 0; k < system->count; k++) {
        const uint32_t other = shuffle ? mf_rng_sequence_below(&sequence, k + 1) : k;
        order[k] = order[other];
        order[other] = k;
    }
    mf_particles_permute(&particles, order);
    assert_ok(mf_neighbours_init(&neighbours, NEIGHBOURS_HALF, &system->box, system->count,
                                 mf_pair_cutoff(law), skin));
    assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
    mf_particles_update_motion(&particles, 0);
    mf_pair_forces(law, &particles, &neighbours, 3, PAIR_FORCES, NULL);
    double *forces = forces_by_id(&particles);
    mf_memory_free(order);
    mf_particles_clear(&particles);
    mf_neighbours_clear(&neighbours);
    return forces;
}

/// The arithmetic of a pair is symmetric, so only the order of the double additions is left.
static void test_pair_forces_do_not_depend_on_order_or_skin_when_ids_are_the_same(void **state) {
    (void)state;
    const struct system system = {{3, {5.1, 4.6, 6.3}}, 443, RANDOM, 0.25};
    struct pair_law law = make_law(&tables.soft, &tables.thesis_omega);
    for (int v = 0; v < variant_count; v++) {
        variants_select(&variants[v]);
        law.precision = variants[v].precision;
        double *first = shuffled_forces(&system, &law, 0, 0.25);
        for (uint64_t shuffle = 1; shuffle < 5; shuffle++) {
            double *again = shuffled_forces(&system, &law, shuffle, 0.1 * (double)shuffle);
            for (size_t k = 0; k < 3 * system.count; k++)
                // Partial sums on a particle stay below some hundreds.
                assert_close(again[k], first[k], 1e3 * rounding);
            mf_memory_free(again);
        }
        mf_memory_free(first);
    }
}

static void test_pair_noise_changes_when_seed_or_step_changes(void **state) {
    (void)state;
    const struct system system = {{3, {4, 4, 4}}, 50, RANDOM, 0.25};
    struct pair_law law = make_law(NULL, &tables.omega);
    struct particles particles;
    struct neighbours neighbours;
    make_system(&particles, &neighbours, &system, &law);
    mf_pair_forces(&law, &particles, &neighbours, 3, PAIR_FORCES, NULL);
    const double first = particles.force[0][0];
    mf_pair_forces(&law, &particles, &neighbours, 3, PAIR_FORCES, NULL);
    assert_identical(particles.force[0][0], first);
    mf_pair_forces(&law, &particles, &neighbours, 3 + (UINT64_C(1) << 32), PAIR_FORCES, NULL);
    assert_true(fabs(particles.force[0][0] - first) > 1e-3);
    law.seed += UINT64_C(1) << 32;
    mf_pair_forces(&law, &particles, &neighbours, 3, PAIR_FORCES, NULL);
    assert_true(fabs(particles.force[0][0] - first) > 1e-3);
    mf_particles_clear(&particles);
    mf_neighbours_clear(&neighbours);
}

/// Slope against central differences of the value, from table and kernel alike.
static void check_gradient(const struct table *potential, double first) {
    // The third derivative is bounded by some 1e5 k_B T/λ³ in the range looked at, so the error of
    // the difference is below 1e-5; the C² spline's kinks add less.
    const double h = 1e-5, tolerance = 1e-4;
    for (double r = first; r < potential->cutoff - 0.01; r += 0.0037) {
        double low, high, slope;
        mf_table_evaluate(potential, r - h, &low, NULL, NULL);
        mf_table_evaluate(potential, r + h, &high, NULL, NULL);
        mf_table_evaluate(potential, r, NULL, &slope, NULL);
        assert_close(slope, (high - low) / (2 * h), tolerance * (1 + fabs(slope)));
    }
}

static void test_table_slope_is_the_derivative_of_its_value_when_differenced(void **state) {
    (void)state;
    check_gradient(&tables.soft, 0.05);
    check_gradient(&tables.lennard_jones, 0.85);
    check_gradient(&tables.gaussian, 0.05);
    check_gradient(&tables.sampled, 0.05);
}

/// Force on one of two particles at distance r, and their energy, from the kernel.
static double two_particle_force(const struct table *potential, enum pair_precision precision,
                                 double r, double *energy) {
    const struct box box = {3, {8, 8, 8}};
    struct pair_law law = make_law(potential, NULL);
    law.precision = precision;
    struct particles particles;
    struct neighbours neighbours;
    struct pair_sums sums;
    assert_ok(mf_particles_init(&particles, &box, 2));
    assert_ok(mf_particles_keep_precise(&particles));
    particles.position[0][0] = 7.9;
    particles.position[0][1] = 7.9 + r;
    assert_ok(mf_neighbours_init(&neighbours, NEIGHBOURS_HALF, &box, 2, potential->cutoff, 0.2));
    assert_ok(mf_neighbours_sort_and_build(&neighbours, &particles));
    mf_pair_forces(&law, &particles, &neighbours, 1, PAIR_FORCES_AND_SUMS, &sums);
    *energy = sums.energy;
    const double force = particles.id[0] == 1 ? particles.force[0][0] : particles.force[0][1];
    mf_particles_clear(&particles);
    mf_neighbours_clear(&neighbours);
    return force;
}

/// Of one variant. Differences over a step h have an error of h²/6 Φ‴, for which twice the
/// difference of the curvatures stands, and that of the energies, `noise`.
static void check_energy_gradient(const struct variant *variant, double h, double noise) {
    const enum pair_precision precision = variant->precision;
    const struct table *potentials[] = {&tables.soft, &tables.lennard_jones, &tables.gaussian,
                                        &tables.sampled};
    variants_select(variant);
    for (int p = 0; p < 4; p++)
        for (double r = potentials[p] == &tables.lennard_jones ? 1 : 0.2;
             r < potentials[p]->cutoff - 0.02; r += 0.043) {
            double low, high, energy, curvature_low, curvature_high;
            two_particle_force(potentials[p], precision, r - h, &low);
            two_particle_force(potentials[p], precision, r + h, &high);
            mf_table_evaluate(potentials[p], r - h, NULL, NULL, &curvature_low);
            mf_table_evaluate(potentials[p], r + h, NULL, NULL, &curvature_high);
            const double force = two_particle_force(potentials[p], precision, r, &energy);
            assert_close(force, -(high - low) / (2 * h),
                         noise / h + 2 * h / 12 * fabs(curvature_high - curvature_low));
        }
}

/// Energies are of order 10, and good to 1e-7 or 1e-16 of that, a few times; in double precision
/// the distances, which come from coordinates of 8, are wrong by 1e-15, under forces of up to 40.
static void test_pair_force_is_minus_the_gradient_of_the_energy_when_differenced(void **state) {
    (void)state;
    for (int v = 0; v < variant_count; v++)
        if (variants[v].precision == PAIR_DOUBLE)
            check_energy_gradient(&variants[v], 1e-4, 1e-13);
        else
            check_energy_gradient(&variants[v], 0.01, 1e-5);
}

static void test_simd_select_refuses_when_the_name_is_unknown(void **state) {
    (void)state;
    assert_true(mf_simd_select("portable"));
    assert_false(mf_simd_select("mmx"));
    assert_string_equal(mf_simd_name(), "portable");
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
        cmocka_unit_test(test_pair_forces_do_not_depend_on_order_or_skin_when_ids_are_the_same),
        cmocka_unit_test(test_pair_noise_changes_when_seed_or_step_changes),
        cmocka_unit_test(test_table_slope_is_the_derivative_of_its_value_when_differenced),
        cmocka_unit_test(test_pair_force_is_minus_the_gradient_of_the_energy_when_differenced),
        cmocka_unit_test(test_simd_select_refuses_when_the_name_is_unknown),
    };
    return cmocka_run_group_tests(tests, make_tables, clear_tables);
}
