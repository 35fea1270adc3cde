// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/particles.h"

#include "base/memory.h"
#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/testing.h"

static const struct box three = {3, {5, 7, 3.5}};
static const struct box two = {2, {5, 7, 1}};

/// Particles at random in several boxes around the origin, moving at random.
static void make(struct particles *particles, const struct box *box, size_t count) {
    assert_ok(mf_particles_init(particles, box, count));
    struct rng_sequence sequence = mf_rng_sequence_begin(2, RNG_PLACEMENT, 0, 0);
    for (int d = 0; d < box->dimensions; d++)
        for (size_t k = 0; k < count; k++) {
            particles->position[d][k] = 40 * (mf_rng_sequence_uniform(&sequence) - 0.5);
            particles->velocity[d][k] = mf_rng_sequence_uniform(&sequence) - 0.2;
            particles->force[d][k] = 10 * mf_rng_sequence_uniform(&sequence);
        }
}

static void test_particles_init_numbers_particles_and_clears_all_when_new(void **state) {
    (void)state;
    struct particles particles;
    assert_ok(mf_particles_init(&particles, &three, 9));
    assert_int_equal(particles.count, 9);
    for (size_t k = 0; k < 9; k++) {
        assert_int_equal(particles.id[k], k);
        for (int d = 0; d < 3; d++) {
            assert_identical(particles.position[d][k], 0);
            assert_identical(particles.velocity[d][k], 0);
            assert_int_equal(particles.image[d][k], 0);
        }
    }
    assert_close_relative(mf_particles_density(&particles), 9 / (5 * 7 * 3.5), 1e-15);
    mf_particles_clear(&particles);
    assert_null(particles.position[0]);
    mf_particles_clear(&particles); // a cleared one may be cleared again
}

static void test_particles_density_is_per_area_when_in_two_dimensions(void **state) {
    (void)state;
    struct particles particles;
    assert_ok(mf_particles_init(&particles, &two, 7));
    assert_close_relative(mf_particles_density(&particles), 0.2, 1e-15);
    mf_particles_clear(&particles);
}

static void test_particles_init_fails_when_there_are_too_many(void **state) {
    (void)state;
    struct particles particles;
    assert_fails(mf_particles_init(&particles, &three, SIZE_MAX / 2), STATUS_NO_MEMORY,
                 "too large");
}

static void check_wrap(const struct box *box) {
    struct particles particles;
    make(&particles, box, 200);
    double before[3][200];
    for (int d = 0; d < box->dimensions; d++)
        memcpy(before[d], particles.position[d], sizeof before[d]);
    mf_particles_wrap(&particles);
    int moved = 0;
    for (int d = 0; d < box->dimensions; d++)
        for (size_t k = 0; k < 200; k++) {
            const double x = particles.position[d][k];
            assert_true(x >= 0 && x < box->length[d]);
            assert_close(x + particles.image[d][k] * box->length[d], before[d][k], 1e-13);
            moved += particles.image[d][k] != 0;
        }
    assert_true(moved > 100);
    mf_particles_wrap(&particles); // nothing is left to do
    for (int d = 0; d < box->dimensions; d++)
        for (size_t k = 0; k < 200; k++)
            assert_close(particles.position[d][k] + particles.image[d][k] * box->length[d],
                         before[d][k], 1e-13);
    mf_particles_clear(&particles);
}

static void test_particles_wrap_keeps_the_unwrapped_position_when_boxes_are_crossed(void **state) {
    (void)state;
    check_wrap(&three);
    check_wrap(&two);
}

static void
test_particles_wrap_stays_below_the_length_when_position_is_a_tiny_negative(void **state) {
    (void)state;
    struct particles particles;
    assert_ok(mf_particles_init(&particles, &three, 3));
    particles.position[0][0] = -1e-18;
    particles.position[0][1] = 5;
    particles.position[0][2] = nextafter(5, 0);
    mf_particles_wrap(&particles);
    assert_identical(particles.position[0][0], 0);
    assert_int_equal(particles.image[0][0], 0);
    assert_identical(particles.position[0][1], 0);
    assert_int_equal(particles.image[0][1], 1);
    assert_identical(particles.position[0][2], nextafter(5, 0));
    assert_int_equal(particles.image[0][2], 0);
    mf_particles_clear(&particles);
}

/// Before they become numbers of boxes.
static void test_particles_wrap_leaves_what_is_nowhere(void **state) {
    static const double nowhere[] = {NAN, INFINITY, -1e300, 5 * 0x1p19};
    (void)state;
    struct particles particles;
    assert_ok(mf_particles_init(&particles, &three, 2));
    for (int k = 0; k < 4; k++) {
        particles.position[0][0] = nowhere[k];
        particles.position[0][1] = -1;
        particles.image[0][0] = particles.image[0][1] = 7;
        assert_false(mf_particles_wrap(&particles));
        assert_memory_equal(&particles.position[0][0], &nowhere[k], sizeof(double));
        assert_int_equal(particles.image[0][0], 7);
        assert_identical(particles.position[0][1], 4);
        assert_int_equal(particles.image[0][1], 6);
    }
    particles.position[0][0] = 5 * 0x1p17;
    assert_true(mf_particles_wrap(&particles));
    assert_int_equal(particles.image[0][0], 7 + 0x20000);
    mf_particles_clear(&particles);
}

/// The difference of fractions is the separation of the nearest images.
static void
test_particles_fractions_differ_by_the_nearest_image_when_positions_are_unwrapped(void **state) {
    (void)state;
    struct particles particles;
    make(&particles, &three, 100);
    mf_particles_update_fractions(&particles);
    for (int d = 0; d < 3; d++)
        for (size_t i = 0; i < 100; i++)
            for (size_t j = 0; j < 100; j++) {
                const double length = three.length[d];
                const double expected =
                    box_nearest(particles.position[d][i] - particles.position[d][j], length);
                const double found =
                    length * 0x1p-32 *
                    box_fraction_difference(particles.fraction[d][i], particles.fraction[d][j]);
                // Half a unit of either fraction.
                assert_close(found, expected, 1.01 * 0x1p-32 * length);
            }
    mf_particles_clear(&particles);
}

static void test_particles_motion_is_ahead_when_time_is_given(void **state) {
    (void)state;
    struct particles particles;
    make(&particles, &three, 50);
    const uint32_t rotated[] = {1, 2, 0};
    uint32_t order[50];
    for (uint32_t k = 0; k < 50; k++)
        order[k] = k < 3 ? rotated[k] : k;
    mf_particles_permute(&particles, order);
    mf_particles_update_motion(&particles, 0.25);
    for (size_t k = 0; k < 50; k++)
        assert_int_equal(particles.kernel_motion[k].id, order[k]);
    for (int d = 0; d < 3; d++)
        for (size_t k = 0; k < 50; k++)
            assert_close_relative(particles.kernel_motion[k].velocity[d],
                                  particles.velocity[d][k] + 0.25 * particles.force[d][k], 1e-7);
    mf_particles_clear(&particles);
}

static void test_particles_precise_records_are_exact_when_kept(void **state) {
    (void)state;
    enum { COUNT = 50 };
    struct particles particles;
    uint32_t order[COUNT];
    make(&particles, &three, COUNT);
    assert_null(particles.precise_place);
    assert_null(particles.precise_motion);
    assert_ok(mf_particles_keep_precise(&particles));
    mf_particles_update_motion(&particles, 0.25);
    for (uint32_t k = 0; k < COUNT; k++)
        order[k] = COUNT - 1 - k;
    mf_particles_permute(&particles, order);
    mf_particles_update_fractions(&particles);
    for (size_t k = 0; k < COUNT; k++) {
        assert_identical(particles.precise_motion[k].id, particles.id[k]);
        for (int d = 0; d < 3; d++) {
            assert_identical(particles.precise_place[k].position[d], particles.position[d][k]);
            // The forces did not move: they were those of the particles in the old order.
            assert_close_relative(
                particles.precise_motion[k].velocity[d],
                particles.velocity[d][k] + 0.25 * particles.force[d][COUNT - 1 - k], 1e-15);
        }
    }
    mf_particles_clear(&particles);
}

static void test_particles_permute_moves_every_array_when_reversed(void **state) {
    (void)state;
    enum { COUNT = 33 };
    struct particles particles, original;
    uint32_t order[COUNT];
    make(&particles, &three, COUNT);
    make(&original, &three, COUNT);
    mf_particles_wrap(&particles);
    mf_particles_wrap(&original);
    mf_particles_update_motion(&particles, 0);
    mf_particles_update_motion(&original, 0);
    for (uint32_t k = 0; k < COUNT; k++)
        order[k] = COUNT - 1 - k;
    mf_particles_permute(&particles, order);
    for (size_t k = 0; k < COUNT; k++) {
        const size_t old = COUNT - 1 - k;
        assert_int_equal(particles.id[k], old);
        for (int d = 0; d < 3; d++) {
            assert_identical(particles.position[d][k], original.position[d][old]);
            assert_identical(particles.velocity[d][k], original.velocity[d][old]);
            assert_identical(particles.kernel_motion[k].velocity[d],
                             original.kernel_motion[old].velocity[d]);
            assert_int_equal(particles.image[d][k], original.image[d][old]);
        }
    }
    mf_particles_clear(&particles);
    mf_particles_clear(&original);
}

static void test_particles_draw_velocities_gives_maxwell_when_many(void **state) {
    (void)state;
    enum { COUNT = 20000 };
    struct particles particles;
    assert_ok(mf_particles_init(&particles, &three, COUNT));
    mf_particles_draw_velocities(&particles, PARTICLES_MAXWELL, 2.5, 11);
    for (int d = 0; d < 3; d++) {
        double sum = 0, squares = 0, fourth = 0;
        for (size_t k = 0; k < COUNT; k++) {
            const double v = particles.velocity[d][k];
            sum += v;
            squares += v * v;
            fourth += v * v * v * v;
        }
        assert_close(sum, 0, 1e-9);
        // Four standard errors: sqrt(2/N) of ⟨v²⟩ and sqrt(96/N) of ⟨v⁴⟩, in units of T and T².
        assert_close(squares / COUNT / 2.5, 1, 4 * sqrt(2.0 / COUNT));
        assert_close(fourth / COUNT / 6.25, 3, 4 * sqrt(96.0 / COUNT));
    }
    assert_close(mf_particles_temperature(&particles), 2.5, 2.5 * 4 * sqrt(2.0 / 3 / COUNT));
    mf_particles_clear(&particles);
}

static void test_particles_draw_velocities_goes_by_id_when_order_differs(void **state) {
    (void)state;
    struct particles first, second;
    const uint32_t order[5] = {3, 0, 4, 2, 1};
    assert_ok(mf_particles_init(&first, &three, 5));
    assert_ok(mf_particles_init(&second, &three, 5));
    mf_particles_permute(&second, order);
    mf_particles_draw_velocities(&first, PARTICLES_MAXWELL, 1, 4);
    mf_particles_draw_velocities(&second, PARTICLES_MAXWELL, 1, 4);
    for (size_t k = 0; k < 5; k++)
        // Only the mean, summed in another order, differs.
        assert_close(second.velocity[0][k], first.velocity[0][order[k]], 1e-15);
    mf_particles_draw_velocities(&second, PARTICLES_MAXWELL, 1, 5);
    assert_true(fabs(second.velocity[0][0] - first.velocity[0][3]) > 1e-3);
    mf_particles_clear(&first);
    mf_particles_clear(&second);
}

static void test_particles_temperature_leaves_out_the_common_motion_when_all_drift(void **state) {
    (void)state;
    struct particles particles;
    assert_ok(mf_particles_init(&particles, &two, 2));
    particles.velocity[0][0] = 7;
    particles.velocity[0][1] = 9;
    // Σ (v − 8)² / (2 · (2 − 1)) = 2 / 2.
    assert_close(mf_particles_temperature(&particles), 1, 1e-15);
    assert_close(mf_particles_square_velocities(&particles), 49 + 81, 1e-12);
    mf_particles_remove_momentum(&particles);
    assert_close(particles.velocity[0][0], -1, 1e-15);
    assert_close(particles.velocity[0][1], 1, 1e-15);
    assert_close(mf_particles_temperature(&particles), 1, 1e-15);
    particles.velocity[1][1] = NAN;
    assert_true(isnan(mf_particles_square_velocities(&particles)));
    assert_true(isnan(mf_particles_temperature(&particles)));
    mf_particles_clear(&particles);
}

static void test_particles_largest_force_is_the_longest_vector_or_nan_when_one_is(void **state) {
    (void)state;
    struct particles particles;
    assert_ok(mf_particles_init(&particles, &three, 6));
    assert_identical(mf_particles_largest_force(&particles), 0);
    particles.force[0][2] = -3;
    particles.force[1][2] = 4;
    particles.force[2][4] = 4.5;
    assert_close(mf_particles_largest_force(&particles), 5, 1e-15);
    particles.force[1][1] = NAN;
    assert_true(isnan(mf_particles_largest_force(&particles)));
    particles.force[1][1] = INFINITY;
    assert_true(isinf(mf_particles_largest_force(&particles)));
    mf_particles_clear(&particles);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_particles_init_numbers_particles_and_clears_all_when_new),
        cmocka_unit_test(test_particles_density_is_per_area_when_in_two_dimensions),
        cmocka_unit_test(test_particles_init_fails_when_there_are_too_many),
        cmocka_unit_test(test_particles_wrap_keeps_the_unwrapped_position_when_boxes_are_crossed),
        cmocka_unit_test(test_particles_wrap_leaves_what_is_nowhere),
        cmocka_unit_test(
            test_particles_wrap_stays_below_the_length_when_position_is_a_tiny_negative),
        cmocka_unit_test(
            test_particles_fractions_differ_by_the_nearest_image_when_positions_are_unwrapped),
        cmocka_unit_test(test_particles_motion_is_ahead_when_time_is_given),
        cmocka_unit_test(test_particles_precise_records_are_exact_when_kept),
        cmocka_unit_test(test_particles_permute_moves_every_array_when_reversed),
        cmocka_unit_test(test_particles_draw_velocities_gives_maxwell_when_many),
        cmocka_unit_test(test_particles_draw_velocities_goes_by_id_when_order_differs),
        cmocka_unit_test(test_particles_temperature_leaves_out_the_common_motion_when_all_drift),
        cmocka_unit_test(test_particles_largest_force_is_the_longest_vector_or_nan_when_one_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
