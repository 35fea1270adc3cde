// SPDX-License-Identifier: GPL-3.0-or-later
//
// Friction and noise that a force pass keeps: against what it would have added, and what the
// integrators make of them against their formulas.
#include "forces/friction.h"

#include "base/memory.h"
#include "base/rng.h"
#include "curves/formula.h"
#include "shared/all_pairs.h"
#include "shared/is_close.h"
#include "shared/kept_pairs.h"
#include "shared/pair_scales.h"
#include "shared/testing.h"
#include "shared/variants.h"

/// Pairs are kept in single precision, whatever that of the forces: as test_pair_kernels.
static const double single_tolerance = 1e-6;

/// Straight pieces between the factors at the ends of an interval h of ω's table: h²/8 times their
/// second derivative, which is some 10 here; and a few roundings of 6e-8.
static const double factor_tolerance = 3e-6;

/// Standard errors that a mean may be off: one false alarm in 15,000, with fixed seeds.
static const double deviations = 4;

static struct variant variants[VARIANTS_MAX];
static int variant_count;
static struct table soft, omega_table, short_omega_table, long_omega_table;

static void make_omega(struct table *table, struct formula_power_omega_parameters parameters) {
    const struct curve curve = {&mf_formula_power_omega, &parameters};
    assert_ok(mf_table_init_omega(table, &curve));
}

static int make_tables(void **state) {
    (void)state;
    variant_count = variants_find(variants);
    struct formula_soft_repulsion_parameters parameters = {25, 1};
    const struct curve curve = {&mf_formula_soft_repulsion, &parameters};
    assert_ok(mf_table_init_potential(&soft, &curve));
    make_omega(&omega_table, (struct formula_power_omega_parameters){sqrt(4.5), 1, 0, 1});
    make_omega(&short_omega_table, (struct formula_power_omega_parameters){3, 1, 0, 0.6});
    make_omega(&long_omega_table, (struct formula_power_omega_parameters){2.589, 1, 0, 1.72});
    return 0;
}

static int clear_tables(void **state) {
    (void)state;
    mf_table_clear(&soft);
    mf_table_clear(&omega_table);
    mf_table_clear(&short_omega_table);
    mf_table_clear(&long_omega_table);
    return 0;
}

/// With DPD-VV's factors, the kept pairs add up to the friction and noise of all pairs.
static void check_law(const struct box *box, size_t count, const struct pair_law *law) {
    struct kept_pairs kept = {.law = *law};
    const uint64_t step = 0x100000007;
    kept_pairs_init(&kept, box, count, 0.02);
    struct particles *particles = &kept.particles;
    kept_pairs_use(&kept, &mf_dpd_vv);
    kept.law.friction = &kept.friction;
    all_pairs_forces(&kept.law, particles, step, NULL);
    double *expected[3] = {NULL};
    for (int d = 0; d < box->dimensions; d++) {
        expected[d] = mf_memory_zeroed(count, sizeof *expected[d]);
        assert_non_null(expected[d]);
        memcpy(expected[d], particles->force[d], count * sizeof *expected[d]);
    }
    struct pair_scales scales = pair_scales_find(&kept.law, particles);
    for (int v = 0; v < variant_count; v++) {
        variants_select(&variants[v]);
        kept.law.precision = variants[v].precision;
        kept_pairs_keep(&kept, step);
        assert_int_equal(kept_pairs_count(&kept.friction), scales.near);
        assert_ok(
            mf_friction_add_to_forces(&kept.friction, particles, particles->velocity, 1, true));
        for (int d = 0; d < box->dimensions; d++)
            for (size_t k = 0; k < count; k++)
                if (!is_close(particles->force[d][k], expected[d][k],
                              single_tolerance * scales.force[k]))
                    fail_msg("%s, %dD: force[%d][%zu] = %.9g, but %.9g from all pairs",
                             variants[v].name, box->dimensions, d, k, particles->force[d][k],
                             expected[d][k]);
    }
    for (int d = 0; d < box->dimensions; d++)
        mf_memory_free(expected[d]);
    pair_scales_clear(&scales);
    kept_pairs_clear(&kept);
}

static void check_sums(const struct box *box, size_t count, const struct table *potential,
                       const struct table *omega) {
    const struct pair_law law = kept_pairs_law(potential, omega, 0.02);
    check_law(box, count, &law);
}

static void test_kept_pairs_add_up_to_friction_and_noise_when_types_differ(void **state) {
    (void)state;
    const struct box three = {3, {5.1, 4.6, 6.3}}, two = {2, {9.1, 7.7, 1}};
    const struct table parts[] = {omega_table, short_omega_table, long_omega_table};
    struct table omega;
    assert_ok(mf_table_stack(&omega, parts, 3));
    for (int p = 0; p < 2; p++) {
        struct pair_law law = kept_pairs_law(p ? &soft : NULL, &omega, 0.02);
        law.composition = (struct composition){.types = 2, .count = {120, 323}};
        check_law(&three, 443, &law);
        check_law(&two, 301, &law);
    }
    mf_table_clear(&omega);
}

static void test_kept_pairs_add_up_to_friction_and_noise_when_they_are_forces(void **state) {
    (void)state;
    const struct box three = {3, {5.1, 4.6, 6.3}}, two = {2, {9.1, 7.7, 1}};
    const struct table *potentials[] = {NULL, &soft},
                       *omegas[] = {&omega_table, &short_omega_table, &long_omega_table};
    for (int p = 0; p < 2; p++)
        for (int w = 0; w < 3; w++) {
            check_sums(&three, 443, potentials[p], omegas[w]);
            check_sums(&two, 301, potentials[p], omegas[w]);
        }
    for (size_t count = 2; count < 40; count++)
        check_sums(&(struct box){3, {2.1, 2.2, 2.3}}, count, &soft, &omega_table);
}

/// A pair at (r, 0, 0), apart for the number that its noise has at a step.
static void make_pair(struct kept_pairs *kept, double r) {
    kept_pairs_init(kept, &(struct box){3, {4, 4, 4}}, 2, 0);
    for (int k = 0; k < 2; k++)
        for (int d = 0; d < 3; d++)
            kept->particles.position[d][k] = d == 0 ? 1 + r * k : 1;
    assert_ok(mf_neighbours_sort_and_build(&kept->neighbours, &kept->particles));
}

static double noise(const struct kept_pairs *kept, uint64_t step) {
    const uint32_t seed = (uint32_t)kept->law.seed, high = (uint32_t)(kept->law.seed >> 32);
    const uint32_t word = rng_philox_lane(seed, high, (uint32_t)step, 0, 1,
                                          rng_stream_word(RNG_PAIR_NOISE, (uint32_t)(step >> 32)));
    return normal_of_word(&kept->friction.normal, word);
}

/// Velocity of approach along the first axis, of the particle with the larger x relative to the
/// other: the sign of u and of the kick go with the unit vector.
static double relative(const struct particles *particles) {
    const int far = particles->position[0][1] > particles->position[0][0];
    return particles->velocity[0][far] - particles->velocity[0][!far];
}

/// u' = decay · u + kick · ζ.
struct law_of_u {
    double decay, kick;
};

static struct law_of_u exact_law(double omega, double time_step, double temperature) {
    const double decay = exp(-2 * omega * omega * time_step);
    return (struct law_of_u){decay, sqrt(2 * temperature * (1 - decay * decay))};
}

/// T. Shardlow, SIAM J. Sci. Comput. 24, 1267 (2003): half a step explicit, half a step implicit.
static struct law_of_u shardlow_law(double omega, double time_step, double temperature) {
    const double a = omega * omega * time_step;
    return (struct law_of_u){(1 - a) / (1 + a), 2 * sqrt(2 * temperature * a) / (1 + a)};
}

static void check_pair(const struct integrator *integrator,
                       struct law_of_u law_of(double, double, double), double r, double time_step) {
    struct kept_pairs kept = {.law = kept_pairs_law(NULL, &omega_table, time_step)};
    double before[3], size;
    make_pair(&kept, r);
    kept_pairs_use(&kept, integrator);
    struct particles *particles = &kept.particles;
    const struct law_of_u law = law_of(sqrt(4.5) * (1 - r), time_step, kept.law.temperature);
    for (int v = 0; v < variant_count; v++) {
        variants_select(&variants[v]);
        kept.law.precision = variants[v].precision;
        const uint64_t step = 7 + (uint64_t)v;
        mf_particles_draw_velocities(particles, PARTICLES_MAXWELL, 1, step);
        const double u = relative(particles), across = particles->velocity[1][0];
        kept_pairs_momentum(particles, before, &size);
        kept_pairs_keep(&kept, step);
        mf_friction_sweep(&kept.friction, particles, NULL);
        assert_close(relative(particles), law.decay * u + law.kick * noise(&kept, step),
                     factor_tolerance * (fabs(u) + 2));
        assert_identical(particles->velocity[1][0], across);
        kept_pairs_assert_momentum(particles, before);
    }
    kept_pairs_clear(&kept);
}

static void test_sweep_follows_the_formula_when_there_are_two_particles(void **state) {
    (void)state;
    static const double r[] = {0.003, 0.31, 0.8, 0.9995}, time_steps[] = {1e-4, 0.04, 1};
    for (int n = 0; n < 4; n++)
        for (int t = 0; t < 3; t++) {
            check_pair(&mf_aboba, exact_law, r[n], time_steps[t]);
            check_pair(&mf_shardlow, shardlow_law, r[n], time_steps[t]);
        }
}

/// Give the two particles these masses.
static void give_masses(struct particles *particles, const double mass[2]) {
    const struct particles_attribute attribute = {.name = "mass", .components = 1};
    int number;
    assert_ok(mf_particles_add_attribute(particles, &attribute, &number));
    for (size_t k = 0; k < 2; k++)
        ((double *)particles->attribute[number].value[0])[k] = mass[k];
}

/// du = −ω²/μ u dt + sqrt(2 k_B T) ω/μ dW with 1/μ = 1/m_1 + 1/m_2 has the decay exp(−ω² Δt/μ) and
/// the variance k_B T/μ (1 − decay²).
static void check_masses(const double mass[2], double r, double time_step) {
    struct kept_pairs kept = {.law = kept_pairs_law(NULL, &omega_table, time_step)};
    make_pair(&kept, r);
    give_masses(&kept.particles, mass);
    kept_pairs_use(&kept, &mf_aboba);
    struct particles *particles = &kept.particles;
    const double inverse = 1 / mass[0] + 1 / mass[1], omega = sqrt(4.5) * (1 - r);
    const double decay = exp(-omega * omega * time_step * inverse);
    const double kick = sqrt(kept.law.temperature * inverse * (1 - decay * decay));
    const double size = 2 * fmax(1, inverse);
    for (uint64_t step = 7; step < 27; step++) {
        mf_particles_draw_velocities(particles, PARTICLES_MAXWELL, 1, step);
        const double u = relative(particles);
        double before = 0, after = 0;
        for (size_t k = 0; k < 2; k++)
            before += mass[k] * particles->velocity[0][k];
        kept_pairs_keep(&kept, step);
        mf_friction_weigh(&kept.friction, particles);
        mf_friction_sweep(&kept.friction, particles, NULL);
        for (size_t k = 0; k < 2; k++)
            after += mass[k] * particles->velocity[0][k];
        assert_close(relative(particles), decay * u + kick * noise(&kept, step),
                     size * factor_tolerance * (fabs(u) + size));
        assert_close(after, before, 1e-12 * (mass[0] + mass[1]) * size);
    }
    kept_pairs_clear(&kept);
}

static void test_sweep_follows_the_formula_when_masses_differ(void **state) {
    (void)state;
    static const double masses[][2] = {{1, 1}, {3, 3}, {0.5, 8}, {20, 0.2}};
    static const double r[] = {0.003, 0.31, 0.8, 0.9995}, time_steps[] = {1e-4, 0.04, 1};
    for (int m = 0; m < 4; m++)
        for (int n = 0; n < 4; n++)
            for (int t = 0; t < 3; t++)
                check_masses(masses[m], r[n], time_steps[t]);
}

/// Moments of u after one step from the same u, over many steps' noise. Those of a normal number z:
/// z² has a variance of 2, z⁴ a mean of 3 and a variance of 96. A uniform one has 1.8 for the 3.
static void test_exact_friction_leaves_a_normal_number_when_drawn_often(void **state) {
    (void)state;
    enum { DRAWS = 20000 };
    struct kept_pairs kept = {.law = kept_pairs_law(NULL, &omega_table, 0.1)};
    make_pair(&kept, 0.4);
    kept_pairs_use(&kept, &mf_aboba);
    struct particles *particles = &kept.particles;
    const struct law_of_u law = exact_law(sqrt(4.5) * 0.6, 0.1, kept.law.temperature);
    const double variance = law.kick * law.kick;
    double sum = 0, squares = 0, fourths = 0;
    for (uint64_t step = 1; step <= DRAWS; step++) {
        const int far = particles->position[0][1] > particles->position[0][0];
        particles->velocity[0][far] = 0.9;
        particles->velocity[0][!far] = -0.6;
        kept_pairs_keep(&kept, step);
        mf_friction_sweep(&kept.friction, particles, NULL);
        const double change = relative(particles) - 1.5 * law.decay;
        sum += change;
        squares += change * change;
        fourths += change * change * change * change;
    }
    assert_close(sum / DRAWS, 0, deviations * sqrt(variance / DRAWS));
    assert_close(squares / DRAWS, variance, deviations * variance * sqrt(2.0 / DRAWS));
    assert_close(fourths / DRAWS / variance / variance, 3, deviations * sqrt(96.0 / DRAWS));
    kept_pairs_clear(&kept);
}

/// What a method makes of ω at a time step.
struct friction_factors {
    double damping;
    double amplitude; ///< standard deviation of the kick [λ/τ]
};

static struct friction_factors factors_of(const struct friction_method *method, double omega,
                                          double time_step, double temperature) {
    const double d = method->damping(omega, time_step);
    const double square =
        method->square ? method->square(time_step, temperature) * d * (1 - method->bound * d) : 1;
    return (struct friction_factors){d, sqrt(square)};
}

/// u' = (1 − 2 damping) u + 2 kick ζ keeps the variance 2 k_B T if amplitude² = 2 k_B T damping
/// (1 − damping): at any time step and any friction. The midpoint rule's (1 + 2G) u' = (1 − 2G) u
/// + 2 kick ζ does if amplitude² = 4 k_B T G.
static void test_factors_keep_the_temperature_when_the_time_step_is_anything(void **state) {
    (void)state;
    const double temperature = 1.3, omega[] = {0, 1e-9, 1e-3, 1, 10, 30};
    for (double time_step = 1e-9; time_step < 1e9; time_step *= 10)
        for (int n = 0; n < 6; n++) {
            const struct friction_factors exact = factors_of(mf_aboba.friction, omega[n], time_step,
                                                             temperature),
                                          split = factors_of(mf_shardlow.friction, omega[n],
                                                             time_step, temperature),
                                          implicit = factors_of(mf_aboba_implicit.friction,
                                                                omega[n], time_step, temperature);
            assert_close_relative(exact.amplitude * exact.amplitude,
                                  2 * temperature * exact.damping * (1 - exact.damping), 1e-12);
            assert_close_relative(implicit.amplitude * implicit.amplitude,
                                  4 * temperature * implicit.damping, 1e-12);
            // 1 − damping has lost its digits where damping is near 1.
            assert_close(split.amplitude * split.amplitude,
                         2 * temperature * split.damping * (1 - split.damping), 1e-14);
        }
}

/// amplitude² = A d (1 − B d) of what a kernel keeps, which leaves u the variance 2 k_B T: (1 −
/// 2d)² 2 k_B T + 4 amplitude² = 2 k_B T of the sweeps, amplitude² = 4 k_B T d of the midpoint rule
/// and 2 k_B T d/Δt of a force.
static double balanced_square(const struct integrator *integrator, double d,
                              const struct pair_law *law) {
    if (integrator == &mf_dpd_vv)
        return 2 * law->temperature * d / law->time_step;
    return integrator == &mf_aboba_implicit ? 4 * law->temperature * d
                                            : 2 * law->temperature * d * (1 - d);
}

/// Rounding of d, and of 1 − d where it is near 1, in single precision.
static const double balance_tolerance = 3e-6;

static void check_balance(const struct integrator *integrator, const struct table *omega,
                          double time_step, double r) {
    struct kept_pairs kept = {.law = kept_pairs_law(NULL, omega, time_step)};
    make_pair(&kept, r);
    kept_pairs_use(&kept, integrator);
    for (int v = 0; v < variant_count; v++) {
        variants_select(&variants[v]);
        kept.law.precision = variants[v].precision;
        kept_pairs_keep(&kept, 3);
        if (kept_pairs_count(&kept.friction) == 0) // r is rounded to the cutoff
            continue;
        int part = 0;
        while (kept.friction.end[part] == kept.friction.begin[part])
            part++;
        const struct friction_pair *pair = &kept.friction.pair[kept.friction.begin[part]];
        const double amplitude = pair->kick / noise(&kept, 3), d = pair->damping;
        assert_close_relative(amplitude * amplitude, balanced_square(integrator, d, &kept.law),
                              balance_tolerance);
    }
    kept_pairs_clear(&kept);
}

/// Friction that jumps to 10 at r = 0.97 and to 0 at 1, and friction that rises to 8: at thousands
/// of r, a third of them in the intervals of the table in which it jumps.
static void test_kick_balances_the_damping_when_friction_jumps(void **state) {
    (void)state;
    static const struct integrator *const with[] = {&mf_aboba, &mf_shardlow, &mf_aboba_implicit,
                                                    &mf_dpd_vv};
    struct table shell, steep;
    make_omega(&shell, (struct formula_power_omega_parameters){10, 1e-6, 0.97, 1});
    make_omega(&steep, (struct formula_power_omega_parameters){8, 2, 0, 1});
    for (int n = 0; n < 300; n++)
        for (int k = 0; k < 4; k++) {
            const double interval = 1.0 / TABLE_INTERVALS, part = (n + 0.5) / 300;
            check_balance(with[k], &shell, 0.005, 0.97 + (2 * part - 1) * interval);
            check_balance(with[k], &shell, 0.005, 1 - 0.999 * part * interval);
            check_balance(with[k], &shell, 0.005, 0.971 + 0.029 * part);
            check_balance(with[k], &steep, 0.1, 0.01 + 0.98 * part);
        }
    mf_table_clear(&shell);
    mf_table_clear(&steep);
}

static void test_sweep_conserves_momentum_when_particles_are_many(void **state) {
    (void)state;
    struct kept_pairs kept = {.law = kept_pairs_law(&soft, &omega_table, 0.1)};
    double before[3], size;
    kept_pairs_init(&kept, &(struct box){3, {5.1, 4.6, 6.3}}, 443, 0);
    kept_pairs_use(&kept, &mf_aboba);
    kept_pairs_momentum(&kept.particles, before, &size);
    for (uint64_t step = 1; step <= 100; step++) {
        kept_pairs_keep(&kept, step);
        mf_friction_sweep(&kept.friction, &kept.particles, NULL);
        kept_pairs_assert_momentum(&kept.particles, before);
    }
    kept_pairs_clear(&kept);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kept_pairs_add_up_to_friction_and_noise_when_they_are_forces),
        cmocka_unit_test(test_kept_pairs_add_up_to_friction_and_noise_when_types_differ),
        cmocka_unit_test(test_sweep_follows_the_formula_when_there_are_two_particles),
        cmocka_unit_test(test_sweep_follows_the_formula_when_masses_differ),
        cmocka_unit_test(test_exact_friction_leaves_a_normal_number_when_drawn_often),
        cmocka_unit_test(test_factors_keep_the_temperature_when_the_time_step_is_anything),
        cmocka_unit_test(test_kick_balances_the_damping_when_friction_jumps),
        cmocka_unit_test(test_sweep_conserves_momentum_when_particles_are_many),
    };
    return cmocka_run_group_tests(tests, make_tables, clear_tables);
}
