// SPDX-License-Identifier: GPL-3.0-or-later
//
// What particles have besides their motion stays with them when they are sorted and saved.
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/restart.h"
#include "shared/testing.h"

#include <math.h>

enum { COUNT = 300 };

static const struct particles_attribute orientation = {
    .name = "orientation[1]", .type = PARTICLES_DOUBLE, .components = 3};
static const struct particles_attribute radius = {
    .name = "radius[lambda]", .type = PARTICLES_FLOAT, .components = 1};
static const struct particles_attribute cluster = {
    .name = "cluster", .type = PARTICLES_WORD, .components = 1};

/// Numbers of the attributes in `particles`.
struct numbers {
    int orientation, radius, cluster;
};

/// Values that tell whose they are.
static struct numbers add_all(struct particles *particles) {
    struct numbers n;
    assert_ok(mf_particles_add_attribute(particles, &orientation, &n.orientation));
    assert_ok(mf_particles_add_attribute(particles, &radius, &n.radius));
    assert_ok(mf_particles_add_attribute(particles, &cluster, &n.cluster));
    for (size_t k = 0; k < particles->count; k++) {
        for (int c = 0; c < 3; c++)
            ((double *)particles->attribute[n.orientation].value[c])[k] =
                sin(particles->id[k] + 0.1 * c);
        ((float *)particles->attribute[n.radius].value[0])[k] = 0.25F * (float)particles->id[k];
        ((uint32_t *)particles->attribute[n.cluster].value[0])[k] = 7 * particles->id[k];
    }
    return n;
}

static void assert_all(const struct particles *particles, struct numbers n) {
    for (size_t k = 0; k < particles->count; k++) {
        const uint32_t id = particles->id[k];
        for (int c = 0; c < 3; c++)
            assert_identical(((double *)particles->attribute[n.orientation].value[c])[k],
                             sin(id + 0.1 * c));
        assert_identical(((float *)particles->attribute[n.radius].value[0])[k], 0.25F * (float)id);
        assert_int_equal(((uint32_t *)particles->attribute[n.cluster].value[0])[k], 7 * id);
    }
}

static void test_attributes_stay_with_their_particles_when_these_are_sorted(void **state) {
    (void)state;
    struct fluid fluid;
    struct simulation simulation;
    fluid_groot_warren(&fluid, COUNT, 0.04);
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    const struct numbers n = add_all(&simulation.particles);
    const uint32_t first = simulation.particles.id[0], last = simulation.particles.id[COUNT - 1];
    assert_ok(mf_simulation_run(&simulation, 100));
    assert_true(simulation.list_builds > 5);
    assert_true(simulation.particles.id[0] != first || simulation.particles.id[COUNT - 1] != last);
    assert_all(&simulation.particles, n);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void test_attributes_are_saved_with_the_particles(void **state) {
    (void)state;
    struct particles from, to;
    struct memory_span saved[PARTICLES_SPANS], loaded[PARTICLES_SPANS];
    const struct box box = {3, {5, 5, 5}};
    assert_ok(mf_particles_init(&from, &box, COUNT));
    assert_ok(mf_particles_init(&to, &box, COUNT));
    for (size_t k = 0; k < COUNT; k++)
        from.id[k] = (uint32_t)(COUNT - 1 - k);
    add_all(&from);
    const struct numbers n = add_all(&to);
    const size_t spans = mf_particles_spans(&from, saved);
    assert_int_equal(spans, 13 + 5);
    assert_int_equal(mf_particles_spans(&to, loaded), spans);
    for (size_t k = 0; k < spans; k++) {
        assert_int_equal(saved[k].bytes, loaded[k].bytes);
        memcpy(loaded[k].memory, saved[k].memory, saved[k].bytes);
    }
    assert_int_equal(to.id[0], COUNT - 1);
    assert_all(&to, n);
    mf_particles_clear(&from);
    mf_particles_clear(&to);
}

/// Of a mixture by its composition, not by the types alone.
static void test_a_sum_is_over_all_particles(void **state) {
    static const double column[] = {1, 2, 4};
    const struct composition mixture = {.types = 2, .count = {240, 60}};
    struct attributes_source masses = {.ranges = 0};
    (void)state;
    assert_close(mf_attributes_sum(&masses, 1, &mixture, 300), 300, 1e-12);
    masses = (struct attributes_source){.ranges = 1, .range = {{2, 4}}};
    assert_close(mf_attributes_sum(&masses, 1, &mixture, 300), 900, 1e-12);
    masses = (struct attributes_source){.ranges = 2, .range = {{18, 18}, {30, 34}}};
    assert_close(mf_attributes_sum(&masses, 1, &mixture, 300), 240 * 18 + 60 * 32, 1e-9);
    masses = (struct attributes_source){.ranges = 1, .range = {{1, 4}}, .column = column};
    assert_close(mf_attributes_sum(&masses, 1, &mixture, 3), 7, 1e-12);
}

static void test_attributes_are_refused_when_there_are_too_many(void **state) {
    (void)state;
    struct particles particles;
    int number;
    assert_ok(mf_particles_init(&particles, &(struct box){2, {5, 5, 1}}, 4));
    for (int k = 0; k < PARTICLES_MAX_ATTRIBUTES; k++) {
        assert_ok(mf_particles_add_attribute(&particles, &radius, &number));
        assert_int_equal(number, k);
    }
    assert_fails(mf_particles_add_attribute(&particles, &cluster, &number), STATUS_BAD_INPUT,
                 "cluster: particles have at most 8");
    mf_particles_clear(&particles);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_attributes_stay_with_their_particles_when_these_are_sorted),
        cmocka_unit_test(test_attributes_are_saved_with_the_particles),
        cmocka_unit_test(test_a_sum_is_over_all_particles),
        cmocka_unit_test(test_attributes_are_refused_when_there_are_too_many),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
