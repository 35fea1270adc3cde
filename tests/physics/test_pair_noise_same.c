// SPDX-License-Identifier: GPL-3.0-or-later
//
// The noise inside the pair kernels (shared/probes.h) is the same number by number, whatever the
// instruction set, the precision and the order of the particles.
#include "base/memory.h"
#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/probes.h"
#include "shared/testing.h"
#include "shared/variants.h"

#include <math.h>

/// Scenes of the tests that compare number by number.
static struct probes_plan small_plan(enum probes_motif motif, int ids, int dimensions) {
    return (struct probes_plan){.motif = motif,
                                .ids = (enum probes_ids)ids,
                                .dimensions = dimensions,
                                .sites = dimensions == 3 ? 7 : 19};
}

/// Steps on both sides of the carry.
enum { FEW_STEPS = 20 };

static uint64_t few_step(int k) {
    return probes_carry - FEW_STEPS / 2 + (uint64_t)k;
}

static void test_pair_noise_is_the_same_when_the_variant_changes(void **state) {
    (void)state;
    struct variant variants[VARIANTS_MAX];
    const int variant_count = variants_find(variants);
    double largest = 0;
    size_t compared = 0;
    for (int which = 0; which < 8; which++) {
        const struct probes_plan plan = small_plan(which & 1 ? PROBES_TRIANGLES : PROBES_DIMERS,
                                                   which >> 1 & 1, which & 4 ? 3 : 2);
        struct probes scene;
        probes_make(&scene, &plan);
        double *first = probes_numbers(scene.pairs), *zeta = probes_numbers(scene.pairs);
        for (int k = 0; k < FEW_STEPS; k++)
            for (int v = 0; v < variant_count; v++) {
                variants_select(&variants[v]);
                scene.law.precision = variants[v].precision;
                probes_draw(&scene, 0xABCDEF0123456789, few_step(k), v == 0 ? first : zeta);
                for (size_t p = 0; v > 0 && p < scene.pairs; p++) {
                    if (!is_close(zeta[p], first[p], probes_tolerance))
                        fail_msg("%s: zeta = %.9g, but %.9g for %s", variants[v].name, zeta[p],
                                 first[p], variants[0].name);
                    largest = fmax(largest, fabs(zeta[p] - first[p]));
                    compared++;
                }
            }
        mf_memory_free(first);
        mf_memory_free(zeta);
        probes_clear(&scene);
    }
    variants_select(&variants[0]);
    print_message("%zu numbers of %d variants: largest difference %.1e\n", compared, variant_count,
                  largest);
}

/// The word of Philox that a pair's ζ is made of.
static int32_t word_of(const struct probes *scene, size_t pair, uint64_t step) {
    const uint32_t a = scene->particles.id[scene->probe[pair].particle],
                   b = scene->particles.id[scene->mirror[pair].particle];
    const uint64_t seed = scene->law.seed;
    return (int32_t)rng_philox_lane((uint32_t)seed, (uint32_t)(seed >> 32), (uint32_t)step,
                                    a < b ? a : b, a < b ? b : a,
                                    rng_stream_word(RNG_PAIR_NOISE, (uint32_t)(step >> 32)));
}

/// Mixed and double precision draw the same 32 bits. In double precision a ζ, good to 1e-14, tells
/// all of them; in mixed precision the 17 highest or more.
static void test_pair_noise_is_made_of_the_same_word_when_the_precision_changes(void **state) {
    (void)state;
    struct variant variants[VARIANTS_MAX];
    const int variant_count = variants_find(variants);
    const struct probes_plan plan = small_plan(PROBES_DIMERS, PROBES_SHUFFLED, 3);
    struct probes scene;
    probes_make(&scene, &plan);
    double *zeta = probes_numbers(scene.pairs);
    for (int v = 0; v < variant_count; v++) {
        variants_select(&variants[v]);
        scene.law.precision = variants[v].precision;
        const double lost = variants[v].precision == PAIR_DOUBLE ? 0.01 : probes_tolerance * 0x1p32;
        for (int k = 0; k < FEW_STEPS; k++) {
            probes_draw(&scene, 0xABCDEF0123456789, few_step(k), zeta);
            for (size_t p = 0; p < scene.pairs; p++)
                assert_close(zeta[p] * 0x1p32 / sqrt(12), word_of(&scene, p, few_step(k)), lost);
        }
    }
    mf_memory_free(zeta);
    probes_clear(&scene);
    variants_select(&variants[0]);
}

static void test_pair_noise_is_opposite_when_read_on_the_other_particle(void **state) {
    (void)state;
    struct variant variants[VARIANTS_MAX];
    const int variant_count = variants_find(variants);
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        const struct probes_plan plan = small_plan(PROBES_DIMERS, PROBES_SHUFFLED, dimensions);
        struct probes scene;
        probes_make(&scene, &plan);
        double *zeta = probes_numbers(scene.pairs), *mirrored = probes_numbers(scene.pairs);
        for (int v = 0; v < variant_count; v++) {
            variants_select(&variants[v]);
            scene.law.precision = variants[v].precision;
            for (int k = 0; k < FEW_STEPS; k++) {
                probes_draw(&scene, 3, few_step(k), zeta);
                // The factors are opposite, so the same ζ is the opposite force, bit by bit.
                probes_read(&scene, scene.mirror, mirrored);
                for (size_t p = 0; p < scene.pairs; p++)
                    assert_identical(mirrored[p], zeta[p]);
            }
        }
        mf_memory_free(zeta);
        mf_memory_free(mirrored);
        probes_clear(&scene);
    }
    variants_select(&variants[0]);
}

/// Pairs of which the particle with the lower id is stored first.
static size_t count_low_first(const struct probes *scene) {
    size_t count = 0;
    for (size_t p = 0; p < scene->pairs; p++)
        count += scene->probe[p].particle < scene->mirror[p].particle;
    return count;
}

static void
test_pair_noise_is_the_same_when_particles_are_stored_the_other_way_round(void **state) {
    (void)state;
    struct variant variants[VARIANTS_MAX];
    const int variant_count = variants_find(variants);
    for (int which = 0; which < 4; which++) {
        struct probes_plan plan = small_plan(PROBES_DIMERS, which & 1, which & 2 ? 3 : 2);
        struct probes scene[3];
        probes_make(&scene[0], &plan);
        // Another order within the cells alone, then the opposite order of every pair.
        plan.reversed = true;
        probes_make(&scene[1], &plan);
        plan.exchanged = true;
        probes_make(&scene[2], &plan);
        const size_t pairs = scene[0].pairs, low_first = count_low_first(&scene[0]);
        assert_true(count_low_first(&scene[1]) != low_first);
        assert_int_equal(count_low_first(&scene[2]), pairs - low_first);
        double *zeta[3];
        for (int s = 0; s < 3; s++)
            zeta[s] = probes_numbers(pairs);
        for (int v = 0; v < variant_count; v++) {
            variants_select(&variants[v]);
            for (int k = 0; k < FEW_STEPS; k++) {
                for (int s = 0; s < 3; s++) {
                    scene[s].law.precision = variants[v].precision;
                    probes_draw(&scene[s], 3, few_step(k), zeta[s]);
                }
                for (size_t p = 0; p < pairs; p++) {
                    assert_identical(zeta[1][p], zeta[0][p]);
                    assert_identical(zeta[2][p], zeta[0][p]);
                }
            }
        }
        for (int s = 0; s < 3; s++) {
            mf_memory_free(zeta[s]);
            probes_clear(&scene[s]);
        }
    }
    variants_select(&variants[0]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pair_noise_is_the_same_when_the_variant_changes),
        cmocka_unit_test(test_pair_noise_is_made_of_the_same_word_when_the_precision_changes),
        cmocka_unit_test(test_pair_noise_is_opposite_when_read_on_the_other_particle),
        cmocka_unit_test(test_pair_noise_is_the_same_when_particles_are_stored_the_other_way_round),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
