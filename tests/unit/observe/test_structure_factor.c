// SPDX-License-Identifier: GPL-3.0-or-later
//
// The structure factor of what is known exactly: a crystal, a sum over pairs, an ideal gas.
#include "base/rng.h"
#include "io/json.h"
#include "observe/measure.h"
#include "observe/pooled.h"
#include "shared/is_close.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "shared/told.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
static const double rounding = 1e-9;

/// A simulation that stands still, and what is measured of it.
struct still {
    struct simulation simulation;
    struct observable_use use;
    struct measure_plan plan;
};

static const struct observable *find_record(void) {
    for (size_t k = 0; mf_observables[k]; k++)
        if (strcmp(mf_observables[k]->name, "structure_factor") == 0)
            return mf_observables[k];
    fail_msg("the structure factor is not in the list");
    return NULL;
}

/// Settings as a scene says them.
static void read_settings(struct temporary_folder *folder, const char *text, void *settings) {
    struct json_document *document;
    const char *file = temporary_folder_write(folder, "settings.json", text, strlen(text));
    assert_ok(mf_json_open(&document, file));
    struct json_object root = mf_json_root(document);
    mf_json_fields(&root, find_record()->fields, settings);
    mf_json_finish(&root);
    assert_ok(mf_json_close(document, STATUS_OK));
}

static void still_init(struct still *still, struct temporary_folder *folder, const struct box *box,
                       size_t count, const char *settings, int64_t samples) {
    *still = (struct still){.plan = {.samples = samples, .every = 1}};
    still->use.observable = find_record();
    still->use.settings = mf_memory_zeroed(1, still->use.observable->settings_size);
    still->use.state = mf_memory_zeroed(1, still->use.observable->state_size);
    read_settings(folder, settings, still->use.settings);
    assert_ok(mf_particles_init(&still->simulation.particles, box, count));
    still->simulation.setup.box = *box;
    still->simulation.setup.threads = 1;
    for (size_t k = 0; k < count; k++)
        still->simulation.particles.id[k] = (uint32_t)k;
}

static enum status still_begin(struct still *still) {
    return told_begin(still->use.observable, still->use.state, still->use.settings,
                      &still->simulation, &still->plan);
}

static void still_sample(struct still *still) {
    assert_ok(told_sample(still->use.observable, still->use.state, &still->simulation));
}

static void still_clear(struct still *still) {
    still->use.observable->clear(still->use.state);
    mf_memory_free(still->use.state);
    mf_memory_free(still->use.settings);
    mf_particles_clear(&still->simulation.particles);
}

/// S at one wave number, as a target asks for it.
static double read_at(const struct still *still, double q, double *error) {
    double value = 0, own_error = 0;
    const struct observable_values values = {1, &q, &value, &own_error, NULL};
    assert_ok(mf_pooled_result(still->use.observable, (const void *const[]){still->use.state}, 1,
                               &values));
    if (error)
        *error = own_error;
    return value;
}

/// Positions anywhere, and far outside of the box, where a wave of the box has the same phase.
static void scatter(struct still *still, uint64_t seed) {
    struct particles *particles = &still->simulation.particles;
    for (size_t k = 0; k < particles->count; k++)
        for (int d = 0; d < particles->box.dimensions; d++) {
            const double part =
                (double)(mf_rng_child_seed(seed, RNG_PLACEMENT, (uint32_t)k, (uint32_t)d) >> 11) *
                0x1p-53;
            particles->position[d][k] = (part + (double)(k % 5)) * particles->box.length[d];
        }
}

/// A simple cubic crystal has N at its reciprocal vectors and nothing elsewhere.
static void test_structure_factor_of_a_crystal_is_n_at_its_reciprocal_vectors(void **state) {
    enum { SIDE = 4, COUNT = SIDE * SIDE * SIDE };
    const struct box box = {3, {2, 2, 2}};
    struct still still;
    // Bins of an eighth of 2π/L: (4, 0, 0) and the like are alone in theirs.
    still_init(&still, *state, &box, COUNT, "{\"q_maximum\": 15.707963268, \"bins\": 40}", 2);
    for (int k = 0; k < COUNT; k++) {
        const int place[3] = {k % SIDE, k / SIDE % SIDE, k / SIDE / SIDE};
        for (int d = 0; d < 3; d++)
            still.simulation.particles.position[d][k] = 0.1 + 0.5 * place[d];
    }
    assert_ok(still_begin(&still));
    still_sample(&still);
    still_sample(&still);
    assert_close(read_at(&still, 2 * pi / 2, NULL), 0, rounding);
    assert_close(read_at(&still, 2 * pi / 2 * sqrt(3), NULL), 0, rounding);
    assert_close(read_at(&still, 4 * pi, NULL), COUNT, rounding * COUNT);
    assert_true(isnan(read_at(&still, 1, NULL)) && isnan(read_at(&still, 16, NULL)));
    still_clear(&still);
}

/// (1/N) Σ_ij cos q·r_ij over all pairs of two types.
static double sum_over_pairs(const struct still *still, const double q[3], size_t from[2],
                             size_t to[2]) {
    const struct particles *particles = &still->simulation.particles;
    double sum = 0;
    for (size_t i = from[0]; i < to[0]; i++)
        for (size_t j = from[1]; j < to[1]; j++) {
            double angle = 0;
            for (int d = 0; d < particles->box.dimensions; d++)
                angle += q[d] * (particles->position[d][i] - particles->position[d][j]);
            sum += cos(angle);
        }
    return sum / sqrt((double)(to[0] - from[0]) * (double)(to[1] - from[1]));
}

/// A box of unequal edges tells the longest wave along each apart, in two dimensions too.
static void test_structure_factor_is_the_sum_over_pairs(void **state) {
    enum { COUNT = 50 };
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        const struct box box = {dimensions, {5, 3, dimensions == 3 ? 4 : 1}};
        struct still still;
        still_init(&still, *state, &box, COUNT, "{\"q_maximum\": 3, \"bins\": 1000}", 1);
        scatter(&still, 7);
        assert_ok(still_begin(&still));
        still_sample(&still);
        size_t all[2] = {0, 0}, end[2] = {COUNT, COUNT};
        for (int d = 0; d < dimensions; d++) {
            double q[3] = {0};
            q[d] = 2 * pi / box.length[d];
            assert_close(read_at(&still, q[d], NULL), sum_over_pairs(&still, q, all, end),
                         rounding);
        }
        // (1, 1, 0) and (−1, 1, 0) share a bin.
        const double q[2][3] = {{2 * pi / 5, 2 * pi / 3, 0}, {-2 * pi / 5, 2 * pi / 3, 0}};
        assert_close(
            read_at(&still, hypot(q[0][0], q[0][1]), NULL),
            0.5 * (sum_over_pairs(&still, q[0], all, end) + sum_over_pairs(&still, q[1], all, end)),
            rounding);
        still_clear(&still);
    }
}

/// The table of a mixture of 20 and 30, at the longest wave, against sums over pairs of its types.
static void test_structure_factor_of_a_mixture_has_the_partial_ones(void **state) {
    enum { A = 20, COUNT = 50 };
    const struct box box = {3, {9, 4, 4}};
    struct still still;
    char text[4096] = "";
    still_init(&still, *state, &box, COUNT, "{\"q_maximum\": 1}", 1);
    still.simulation.setup.composition =
        (struct composition){.types = 2, .count = {A, COUNT - A}, .name = {"A", "B"}};
    scatter(&still, 3);
    assert_ok(still_begin(&still));
    still_sample(&still);
    const struct units none = {0};
    const struct observable_results results = {.setup = &still.simulation.setup,
                                               .plan = &still.plan,
                                               .units = &none,
                                               .folder = ((struct temporary_folder *)*state)->path};
    assert_ok(still.use.observable->write(still.use.state, &results));
    char path[512];
    snprintf(path, sizeof path, "%s/structure_factor.tsv", results.folder);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    assert_non_null(fgets(text, sizeof text, file));
    assert_contains(text, "S(A-B)[1]");
    double row[10];
    for (int k = 0; k < 10; k++)
        assert_int_equal(fscanf(file, "%lf", &row[k]), 1);
    fclose(file);
    const double q[3] = {2 * pi / 9, 0, 0};
    assert_close(row[0], q[0], 1e-9);
    size_t from[3][2] = {{0, 0}, {0, A}, {A, A}}, to[3][2] = {{A, A}, {A, COUNT}, {COUNT, COUNT}};
    const double total = sum_over_pairs(&still, q, (size_t[]){0, 0}, (size_t[]){COUNT, COUNT});
    assert_close(row[1], total, 1e-7);
    for (int pair = 0; pair < 3; pair++)
        assert_close(row[3 + 2 * pair], sum_over_pairs(&still, q, from[pair], to[pair]), 1e-7);
    assert_close(row[9], 1, 0);
    still_clear(&still);
}

/// Independent beads have S = 1 for every q: 60 configurations, bins of a few vectors or many. By
/// Student's t of 60 blocks a bin is beyond 5 of its errors with p = 6e-6, one of 20 with 1e-4.
static void test_structure_factor_of_an_ideal_gas_is_one_within_its_errors(void **state) {
    enum { COUNT = 200, SAMPLES = 60 };
    const struct box box = {3, {5, 5, 5}};
    struct still still;
    still_init(&still, *state, &box, COUNT, "{\"q_maximum\": 6, \"bins\": 20}", SAMPLES);
    assert_ok(still_begin(&still));
    for (uint64_t k = 0; k < SAMPLES; k++) {
        scatter(&still, 100 + k);
        still_sample(&still);
    }
    for (double q = 1.4; q < 5.8; q += 0.22) {
        double error;
        const double value = read_at(&still, q, &error);
        assert_true(error > 0 && error < 0.2);
        assert_true(fabs(value - 1) < 5 * error);
    }
    still_clear(&still);
}

static void test_structure_factor_has_the_same_bits_for_any_threads(void **state) {
    enum { COUNT = 300 };
    const struct box box = {3, {5, 5, 5}};
    double value[2];
    for (int k = 0; k < 2; k++) {
        struct still still;
        still_init(&still, *state, &box, COUNT, "{\"q_maximum\": 9}", 1);
        scatter(&still, 1);
        still.simulation.setup.threads = 1 + 2 * k;
        assert_ok(still_begin(&still));
        still_sample(&still);
        value[k] = read_at(&still, 5, NULL);
        still_clear(&still);
    }
    assert_memory_equal(&value[0], &value[1], sizeof *value);
}

static void test_structure_factor_refuses_what_the_box_has_not(void **state) {
    const struct box box = {3, {5, 5, 5}};
    struct still still;
    still_init(&still, *state, &box, 10, "{\"q_maximum\": 1}", 1);
    assert_fails(still_begin(&still), STATUS_BAD_INPUT, "longest wave");
    still_clear(&still);
    still_init(&still, *state, &box, 10, "{\"q_maximum\": 1e9}", 1);
    assert_fails(still_begin(&still), STATUS_BAD_INPUT, "wave vectors of the box");
    still_clear(&still);
}

#define TEST(test)                                                                                 \
    cmocka_unit_test_setup_teardown(test, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_structure_factor_of_a_crystal_is_n_at_its_reciprocal_vectors),
        TEST(test_structure_factor_is_the_sum_over_pairs),
        TEST(test_structure_factor_of_a_mixture_has_the_partial_ones),
        TEST(test_structure_factor_of_an_ideal_gas_is_one_within_its_errors),
        TEST(test_structure_factor_has_the_same_bits_for_any_threads),
        TEST(test_structure_factor_refuses_what_the_box_has_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
