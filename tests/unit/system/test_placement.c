// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/placement.h"

#include "shared/is_close.h"
#include "shared/testing.h"

/// Least distance of any two particles, nearest images.
static double min_distance(const struct particles *particles) {
    double min = INFINITY;
    for (size_t i = 0; i < particles->count; i++)
        for (size_t j = i + 1; j < particles->count; j++) {
            double square = 0;
            for (int d = 0; d < particles->box.dimensions; d++) {
                const double dx = box_nearest(particles->position[d][i] - particles->position[d][j],
                                              particles->box.length[d]);
                square += dx * dx;
            }
            min = fmin(min, square);
        }
    return sqrt(min);
}

/// All positions are in the box, and the fractions are up to date.
static void check_in_box(const struct particles *particles) {
    for (int d = 0; d < particles->box.dimensions; d++)
        for (size_t k = 0; k < particles->count; k++) {
            const double x = particles->position[d][k], length = particles->box.length[d];
            assert_true(x >= 0 && x < length);
            assert_int_equal(particles->fraction[d][k], box_fraction(x, 1 / length));
        }
}

static void test_placement_lattice_is_simple_cubic_when_count_is_a_cube(void **state) {
    (void)state;
    struct particles particles;
    const struct box box = {3, {9.427, 9.427, 9.427}};
    assert_ok(mf_particles_init(&particles, &box, 2744));
    mf_placement_lattice(&particles, 0, 1);
    check_in_box(&particles);
    assert_close(min_distance(&particles), 9.427 / 14, 1e-12);
    mf_particles_clear(&particles);
}

/// 463³ particles, near the most that a scene may have, of which a full lattice has one each; and a
/// lattice that has a site more along each axis.
static void test_placement_site_is_used_once_when_particles_are_a_hundred_million(void **state) {
    (void)state;
    const size_t count = (size_t)463 * 463 * 463, sites = (size_t)464 * 464 * 464;
    size_t wrong = 0, shared = 0, before = 0;
    for (size_t k = 0; k < count; k++) {
        const size_t site = placement_site(k, count, sites);
        wrong += placement_site(k, count, count) != k;
        shared += k > 0 && site <= before;
        before = site;
    }
    assert_int_equal(wrong, 0);
    assert_int_equal(shared, 0);
    assert_true(before < sites);
}

static void test_placement_lattice_is_square_when_in_two_dimensions(void **state) {
    (void)state;
    struct particles particles;
    const struct box box = {2, {6, 6, 1}};
    assert_ok(mf_particles_init(&particles, &box, 144));
    mf_placement_lattice(&particles, 0, 1);
    check_in_box(&particles);
    assert_close(min_distance(&particles), 0.5, 1e-12);
    mf_particles_clear(&particles);
}

/// No site is used twice, whatever the count and shape; the sites are no finer than needed.
static void test_placement_lattice_keeps_particles_apart_when_count_is_odd(void **state) {
    (void)state;
    static const struct box boxes[] = {
        {3, {5, 5, 5}}, {3, {20, 3, 4}}, {2, {7, 7, 1}}, {2, {2, 30, 1}}};
    for (int b = 0; b < 4; b++)
        for (size_t count = 2; count < 130; count += 7) {
            struct particles particles;
            assert_ok(mf_particles_init(&particles, &boxes[b], count));
            mf_placement_lattice(&particles, 0, 1);
            check_in_box(&particles);
            const double spacing =
                pow(mf_box_volume(&boxes[b]) / (double)count, 1.0 / boxes[b].dimensions);
            assert_true(min_distance(&particles) > 0.55 * spacing);
            mf_particles_clear(&particles);
        }
}

/// Every id once, the same for the same seed, and hardly any where it was.
static void test_placement_mix_exchanges_ids_when_asked(void **state) {
    (void)state;
    enum { COUNT = 1000 };
    const struct box box = {3, {10, 10, 10}};
    struct particles particles, again;
    bool found[COUNT] = {false};
    size_t same = 0;
    double middle = 0;
    assert_ok(mf_particles_init(&particles, &box, COUNT));
    assert_ok(mf_particles_init(&again, &box, COUNT));
    mf_placement_mix(&particles, 7);
    mf_placement_mix(&again, 7);
    assert_memory_equal(particles.id, again.id, COUNT * sizeof *again.id);
    for (size_t k = 0; k < COUNT; k++) {
        assert_false(found[particles.id[k]]);
        found[particles.id[k]] = true;
        same += particles.id[k] == k;
        middle += k < COUNT / 2 && particles.id[k] < COUNT / 2;
    }
    assert_true(same < 10);
    // 250 expected with a standard deviation of 8: no false alarm to speak of, and one seed.
    assert_true(fabs(middle - 250) < 40);
    mf_particles_clear(&particles);
    mf_particles_clear(&again);
}

static void test_placement_lattice_shifts_within_the_jitter_when_asked(void **state) {
    (void)state;
    struct particles even, shifted, again, other;
    const struct box box = {3, {6, 6, 6}};
    assert_ok(mf_particles_init(&even, &box, 216));
    assert_ok(mf_particles_init(&shifted, &box, 216));
    assert_ok(mf_particles_init(&again, &box, 216));
    assert_ok(mf_particles_init(&other, &box, 216));
    mf_placement_lattice(&even, 0, 1);
    mf_placement_lattice(&shifted, 0.3, 1);
    mf_placement_lattice(&again, 0.3, 1);
    mf_placement_lattice(&other, 0.3, 2);
    check_in_box(&shifted);
    double largest = 0, difference = 0;
    for (int d = 0; d < 3; d++)
        for (size_t k = 0; k < 216; k++) {
            const double shift = fabs(shifted.position[d][k] - even.position[d][k]);
            assert_true(shift <= 0.3 + 1e-12); // the spacing is 1
            largest = fmax(largest, shift);
            assert_identical(again.position[d][k], shifted.position[d][k]);
            difference = fmax(difference, fabs(other.position[d][k] - shifted.position[d][k]));
        }
    assert_true(largest > 0.29);
    assert_true(difference > 0.3);
    mf_particles_clear(&even);
    mf_particles_clear(&shifted);
    mf_particles_clear(&again);
    mf_particles_clear(&other);
}

static void check_random(const struct box *box, size_t count, double separation) {
    struct particles particles, again;
    assert_ok(mf_particles_init(&particles, box, count));
    assert_ok(mf_particles_init(&again, box, count));
    assert_ok(mf_placement_random(&particles, separation, 3));
    assert_ok(mf_placement_random(&again, separation, 3));
    check_in_box(&particles);
    assert_true(min_distance(&particles) >= separation);
    for (int d = 0; d < box->dimensions; d++)
        assert_memory_equal(particles.position[d], again.position[d], count * sizeof(double));
    mf_particles_clear(&particles);
    mf_particles_clear(&again);
}

/// Each third of the ids is a wave along the longest edge, whose amplitude would be sqrt(N/3) = 18
/// by chance, and the middle one no less than the others; every id is there once.
static void test_placement_tilt_makes_a_wave_of_each_type(void **state) {
    (void)state;
    enum { TYPES = 3, COUNT = 999 };
    const struct box box = {3, {10, 20, 10}};
    struct particles particles;
    bool found[COUNT] = {false};
    double wave[TYPES][2] = {{0}};
    assert_ok(mf_particles_init(&particles, &box, COUNT));
    mf_placement_lattice(&particles, 0, 1);
    mf_placement_mix(&particles, 7);
    mf_placement_tilt(&particles, 0.6, 7);
    for (size_t k = 0; k < COUNT; k++) {
        const double angle = 2 * M_PI * particles.position[1][k] / 20;
        double *own = wave[particles.id[k] / (COUNT / TYPES)];
        assert_false(found[particles.id[k]]);
        found[particles.id[k]] = true;
        own[0] += cos(angle);
        own[1] += sin(angle);
    }
    for (int type = 0; type < TYPES; type++) {
        const double amplitude = hypot(wave[type][0], wave[type][1]);
        print_message("amplitude of type %d: %.0f\n", type, amplitude);
        assert_true(amplitude > 55 && amplitude < 150);
    }
    mf_particles_clear(&particles);
}

static void test_placement_random_keeps_the_separation_when_there_is_room(void **state) {
    (void)state;
    check_random(&(struct box){3, {6, 7, 5}}, 200, 0.8);
    check_random(&(struct box){3, {20, 1.3, 1.2}}, 30, 0.6);
    check_random(&(struct box){2, {8, 9, 1}}, 60, 0.7);
    check_random(&(struct box){3, {6, 7, 5}}, 200, 0);
}

/// Octants of the box are equally likely: χ² of 7 degrees is below 24.3 with probability 0.999.
static void test_placement_random_is_uniform_when_there_is_no_separation(void **state) {
    (void)state;
    enum { COUNT = 8000 };
    struct particles particles;
    const struct box box = {3, {4, 5, 6}};
    assert_ok(mf_particles_init(&particles, &box, COUNT));
    assert_ok(mf_placement_random(&particles, 0, 17));
    int hits[8] = {0};
    for (size_t k = 0; k < COUNT; k++)
        hits[(particles.position[0][k] > 2) + 2 * (particles.position[1][k] > 2.5) +
             4 * (particles.position[2][k] > 3)]++;
    double chi2 = 0;
    for (int o = 0; o < 8; o++)
        chi2 += (hits[o] - COUNT / 8.0) * (hits[o] - COUNT / 8.0) / (COUNT / 8.0);
    assert_true(chi2 < 24.3);
    mf_particles_clear(&particles);
}

static void test_placement_random_fails_when_the_density_is_too_high(void **state) {
    (void)state;
    struct particles particles;
    assert_ok(mf_particles_init(&particles, &(struct box){3, {3, 3, 3}}, 200));
    assert_fails(mf_placement_random(&particles, 1, 1), STATUS_BAD_INPUT, "no room for particle");
    mf_particles_clear(&particles);
}

/// A third of the longest edge, in its middle, with the separation kept.
static void check_slab(enum placement_kind kind, const struct box *box, int axis) {
    enum { COUNT = 120 };
    const struct placement placement = {
        .count = COUNT, .kind = kind, .jitter = 0, .separation = 0.5, .slab = 1.0 / 3};
    const double length = box->length[axis];
    struct particles particles;
    double low = length, high = 0, mean = 0;
    assert_ok(mf_particles_init(&particles, box, COUNT));
    assert_ok(mf_placement_fill(&particles, &placement, 9));
    check_in_box(&particles);
    assert_true(min_distance(&particles) >= 0.5);
    for (size_t k = 0; k < COUNT; k++) {
        const double x = particles.position[axis][k];
        low = fmin(low, x);
        high = fmax(high, x);
        mean += x / COUNT;
        assert_int_equal(particles.fraction[axis][k], box_fraction(x, 1 / length));
    }
    assert_true(low >= length / 3 && low < 0.45 * length);
    assert_true(high <= length * 2 / 3 && high > 0.55 * length);
    assert_true(fabs(mean - length / 2) < 0.05 * length);
    assert_identical(particles.box.length[axis], length);
    mf_particles_clear(&particles);
}

static void test_placement_slab_fills_the_middle_of_the_longest_edge(void **state) {
    (void)state;
    for (int kind = PLACEMENT_LATTICE; kind <= PLACEMENT_RANDOM; kind++) {
        check_slab((enum placement_kind)kind, &(struct box){3, {5, 5, 18}}, 2);
        check_slab((enum placement_kind)kind, &(struct box){3, {5, 18, 5}}, 1);
        check_slab((enum placement_kind)kind, &(struct box){3, {9, 9, 9}}, 2);
        check_slab((enum placement_kind)kind, &(struct box){2, {36, 12, 1}}, 0);
    }
}

/// Order shows in S(q) = |Σ exp(iqx)|²/N at the waves of a lattice's planes; without it S is below
/// 1, but for chance 12 = −ln(6e-6) of points at random.
static void test_placement_disordered_has_no_planes_when_the_count_is_a_cube(void **state) {
    (void)state;
    enum { EDGE = 8, COUNT = EDGE * EDGE * EDGE };
    struct particles particles;
    const struct box box = {3, {9, 9, 9}};
    assert_ok(mf_particles_init(&particles, &box, COUNT));
    assert_ok(mf_placement_disordered(&particles, 5));
    check_in_box(&particles);
    assert_true(min_distance(&particles) >= 0.7 * 9 / EDGE);
    for (int d = 0; d < 3; d++) {
        double real = 0, imaginary = 0;
        for (size_t k = 0; k < COUNT; k++) {
            const double angle = 2 * acos(-1.0) * EDGE / 9 * particles.position[d][k];
            real += cos(angle);
            imaginary += sin(angle);
        }
        assert_true((real * real + imaginary * imaginary) / COUNT < 12);
    }
    mf_particles_clear(&particles);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_placement_lattice_is_simple_cubic_when_count_is_a_cube),
        cmocka_unit_test(test_placement_site_is_used_once_when_particles_are_a_hundred_million),
        cmocka_unit_test(test_placement_lattice_is_square_when_in_two_dimensions),
        cmocka_unit_test(test_placement_lattice_keeps_particles_apart_when_count_is_odd),
        cmocka_unit_test(test_placement_lattice_shifts_within_the_jitter_when_asked),
        cmocka_unit_test(test_placement_mix_exchanges_ids_when_asked),
        cmocka_unit_test(test_placement_tilt_makes_a_wave_of_each_type),
        cmocka_unit_test(test_placement_random_keeps_the_separation_when_there_is_room),
        cmocka_unit_test(test_placement_random_is_uniform_when_there_is_no_separation),
        cmocka_unit_test(test_placement_disordered_has_no_planes_when_the_count_is_a_cube),
        cmocka_unit_test(test_placement_slab_fills_the_middle_of_the_longest_edge),
        cmocka_unit_test(test_placement_random_fails_when_the_density_is_too_high),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
