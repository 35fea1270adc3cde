// SPDX-License-Identifier: GPL-3.0-or-later
//
// Clusters and local densities of particles whose places are known.
#include "io/data_table.h"
#include "observe/measure.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "shared/told.h"

#include <math.h>

extern const struct observable mf_clusters, mf_local_density;

struct settings {
    double distance;
    char types[FIELD_TEXT_SIZE];
};

enum { COUNT = 9 };
/// A chain of four through the edge of the box, a pair, three alone.
static const double x[COUNT] = {0.1, 0.7, 4.6, 4.0, 2.5, 2.5, 1.5, 3.5, 2.5};
static const double y[COUNT] = {1, 1, 1, 1, 3, 3.6, 4.5, 4.5, 1.5};
static const struct measure_plan plan = {.equilibration = 0, .samples = 1, .every = 1};

/// The chain but its last particle, and the others.
static const struct composition mixture = {2, {3, 6}, {"A", "B"}};

static void make(struct fluid *fluid, struct simulation *simulation) {
    const struct simulation_start start = {.position = {x, y}, .velocity = {NULL}};
    fluid_soft_discs(fluid, COUNT, 0.01);
    fluid->setup.box = (struct box){2, {5, 5, 1}};
    fluid->setup.placement.kind = PLACEMENT_FILE;
    assert_ok(mf_simulation_init(simulation, &fluid->setup, &start));
}

static void take(const struct observable *observable, const void *settings,
                 struct data_table *table, const char *folder) {
    struct fluid fluid;
    struct simulation simulation;
    double state[64] = {0};
    char path[OUTPUT_PATH_SIZE];
    assert_true(observable->state_size <= sizeof state);
    make(&fluid, &simulation);
    simulation.setup.composition = mixture;
    assert_ok(told_begin(observable, state, settings, &simulation, &plan));
    assert_ok(told_sample(observable, state, &simulation));
    const struct observable_results results = {.folder = folder};
    assert_ok(observable->write(state, &results));
    mf_observable_file(&results, observable->files[0], path);
    assert_ok(mf_data_table_read(table, path, 3));
    observable->clear(state);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void test_clusters_join_through_the_edges_of_the_box(void **state) {
    struct temporary_folder *folder = *state;
    static const struct settings settings = {.distance = 0.7};
    static const double expected[] = {1, 3.0 / 9, 3, 2, 2.0 / 9, 1, 4, 4.0 / 9, 1};
    struct data_table table = {0};
    take(&mf_clusters, &settings, &table, folder->path);
    assert_int_equal(table.rows, 3);
    for (int k = 0; k < 9; k++)
        assert_close(table.values[k], expected[k], 1e-6);
    mf_data_table_clear(&table);
}

/// Without the others three of the chain are left; without those, its last one is alone.
static void test_clusters_of_a_type_do_not_see_the_others(void **state) {
    struct temporary_folder *folder = *state;
    static const struct settings settings[] = {
        {0.7, "A"}, {0.7, "B"}, {0.7, "A B"}, {.distance = 0.7}};
    static const double expected[][9] = {{3, 1, 1},
                                         {1, 4.0 / 6, 4, 2, 2.0 / 6, 1},
                                         {1, 3.0 / 9, 3, 2, 2.0 / 9, 1, 4, 4.0 / 9, 1},
                                         {1, 3.0 / 9, 3, 2, 2.0 / 9, 1, 4, 4.0 / 9, 1}};
    static const size_t rows[] = {1, 2, 3, 3};
    for (int n = 0; n < 4; n++) {
        struct data_table table = {0};
        take(&mf_clusters, &settings[n], &table, folder->path);
        assert_int_equal(table.rows, rows[n]);
        for (size_t k = 0; k < 3 * rows[n]; k++)
            assert_close(table.values[k], expected[n][k], 1e-6);
        mf_data_table_clear(&table);
    }
}

static void test_clusters_refuse_a_type_that_is_none(void **state) {
    (void)state;
    static const struct settings settings[] = {{0.7, "A C"}, {0.7, " "}};
    struct fluid fluid;
    struct simulation simulation;
    make(&fluid, &simulation);
    simulation.setup.composition = mixture;
    for (int n = 0; n < 2; n++) {
        double own[64] = {0};
        assert_fails(told_begin(&mf_clusters, own, &settings[n], &simulation, &plan),
                     STATUS_BAD_INPUT,
                     n == 0 ? "clusters.types: \"C\" is no type" : "clusters.types: no type");
        mf_clusters.clear(own);
    }
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

static void test_clusters_refuse_a_distance_beyond_the_list(void **state) {
    (void)state;
    static const struct settings settings = {.distance = 1.2};
    struct fluid fluid;
    struct simulation simulation;
    double own[64] = {0};
    make(&fluid, &simulation);
    assert_fails(told_begin(&mf_clusters, own, &settings, &simulation, &plan), STATUS_BAD_INPUT,
                 "clusters.distance: 1.2 is beyond 1");
    mf_clusters.clear(own);
    mf_simulation_clear(&simulation);
    fluid_clear(&fluid);
}

/// Cells of 2.5: three in the corner of the origin (0.1, 0.7), (2.5 is the next), and so on.
static void test_local_density_counts_cells_by_their_particles(void **state) {
    struct temporary_folder *folder = *state;
    static const struct { double cell, diameter; } settings = {2.4, 1};
    // Cells: (0.1 0.7), (1.5 at 4.5), (4.6 4.0 2.5), (2.5 2.5 3.5): 2, 1, 3, 3.
    static const double share[] = {0, 0.25, 0.25, 0.5};
    struct data_table table = {0};
    take(&mf_local_density, &settings, &table, folder->path);
    assert_int_equal(table.rows, 4);
    for (int k = 0; k < 4; k++) {
        assert_close(table.values[4 * k], k, 1e-9);
        assert_close(table.values[4 * k + 1], k / 6.25, 1e-5);
        assert_close(table.values[4 * k + 2], share[k], 1e-9);
        assert_close(table.values[4 * k + 3], k / 6.25 * M_PI / 4, 1e-5);
    }
    mf_data_table_clear(&table);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_clusters_join_through_the_edges_of_the_box,
                                        temporary_folder_create, temporary_folder_remove),
        cmocka_unit_test_setup_teardown(test_clusters_of_a_type_do_not_see_the_others,
                                        temporary_folder_create, temporary_folder_remove),
        cmocka_unit_test(test_clusters_refuse_a_type_that_is_none),
        cmocka_unit_test(test_clusters_refuse_a_distance_beyond_the_list),
        cmocka_unit_test_setup_teardown(test_local_density_counts_cells_by_their_particles,
                                        temporary_folder_create, temporary_folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
