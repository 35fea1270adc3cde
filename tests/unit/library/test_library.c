// SPDX-License-Identifier: GPL-3.0-or-later
//
// The library as its users see it, by its public headers: what is refused, that several live side
// by side, and that nothing of the process is changed.
#include "mesofit.h"

#include "shared/is_close.h"
#include "shared/testing.h"

#include <gsl/gsl_errno.h>
#include <math.h>
#include <pthread.h>

static struct mesofit_scene small_scene(void) {
    struct mesofit_scene scene = mesofit_scene_default();
    for (int axis = 0; axis < 3; axis++)
        scene.box[axis] = 5;
    scene.particles = 300;
    scene.conservative.text = "{\"law\": \"soft-repulsion\", \"a\": 25}";
    scene.dissipative.text = "{\"law\": \"power\", \"sigma\": 2}";
    return scene;
}

static double soft_repulsion(const void *height, double r) {
    return r < 1 ? 0.5 * *(const double *)height * (1 - r) * (1 - r) : 0;
}

/// Sum of all velocities along the first axis, squared: tells runs apart.
static double fingerprint(const struct mesofit_simulation *simulation) {
    const double *v = mesofit_simulation_velocities(simulation, 0);
    double sum = 0;
    for (size_t k = 0; k < mesofit_simulation_count(simulation); k++)
        sum += v[k] * v[k] * (1 + mesofit_simulation_ids(simulation)[k]);
    return sum;
}

static double run_small(const struct mesofit_scene *scene) {
    struct mesofit_simulation *simulation = mesofit_simulation_create(scene);
    assert_non_null(simulation);
    assert_int_equal(mesofit_simulation_run(simulation, 100), MESOFIT_OK);
    assert_int_equal(mesofit_simulation_step(simulation), 100);
    const double found = fingerprint(simulation);
    mesofit_simulation_free(simulation);
    return found;
}

static void test_own_law_gives_the_forces_of_the_formula(void **state) {
    (void)state;
    const double height = 25;
    struct mesofit_scene formula = small_scene(), own = formula;
    own.conservative =
        (struct mesofit_law){.value = soft_repulsion, .context = &height, .cutoff = 1};
    assert_close(run_small(&own), run_small(&formula), 0);
}

static void test_faults_are_told_and_not_printed(void **state) {
    (void)state;
    struct mesofit_scene scene = small_scene();
    scene.temperature = -1;
    assert_null(mesofit_simulation_create(&scene));
    assert_contains(mesofit_message(), "temperature");
    scene = small_scene();
    scene.integrator = "leapfrog";
    assert_null(mesofit_simulation_create(&scene));
    assert_contains(mesofit_message(), "leapfrog");
    assert_null(mesofit_simulation_open("no/such/file.json"));
    assert_contains(mesofit_message(), "no/such/file.json");
    struct mesofit_fit_options options = mesofit_fit_options_default();
    assert_null(mesofit_fit_create(&options));
    assert_contains(mesofit_message(), "target");
    assert_null(mesofit_optimiser_create("steepest", NULL, 2, 0, 1, NULL, 1));
    assert_contains(mesofit_message(), "steepest");
}

/// As the program tells them.
static void test_failures_are_told_in_the_units_of_the_scene(void **state) {
    (void)state;
    static const char text[] =
        "{\"units\": \"nm-ps\", \"box\": [4, 4, 4], \"temperature\": 298, \"time_step\": 50,\n"
        "\"particles\": {\"count\": 500, \"mass\": 18.015},\n"
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 600, \"cutoff\": 0.6},\n"
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 5, \"cutoff\": 0.6}}\n";
    struct mesofit_simulation *simulation = mesofit_simulation_parse(text, NULL, 0);
    assert_non_null(simulation);
    assert_int_equal(mesofit_simulation_run(simulation, 100), MESOFIT_UNSTABLE);
    assert_contains(mesofit_message(), "largest force ");
    assert_contains(mesofit_message(), " kJ/mol/nm");
    mesofit_simulation_free(simulation);
}

static void test_scene_reads_its_table_from_memory(void **state) {
    (void)state;
    static const double points[] = {0, 20, 0.25, 12, 0.5, 6, 0.75, 1.5, 1, 0};
    const struct mesofit_table table = {"phi", 5, 2, points};
    static const char text[] = "{\"box\": [5, 5, 5], \"particles\": {\"count\": 300}, "
                               "\"temperature\": 1, \"time_step\": 0.01,"
                               " \"conservative\": {\"law\": \"table\", \"file\": \"phi\"}}";
    struct mesofit_simulation *simulation = mesofit_simulation_parse(text, &table, 1);
    assert_non_null(simulation);
    assert_int_equal(mesofit_simulation_run(simulation, 10), MESOFIT_OK);
    mesofit_simulation_free(simulation);
    // The table was lent for one call.
    assert_null(mesofit_simulation_parse(text, NULL, 0));
    assert_contains(mesofit_message(), "phi");
}

/// Independent particles in a trap: <k x^2> = k_B T by equipartition, within 4 standard errors.
static double pull(void *stiffness, size_t count, const uint32_t *id, const double *const *position,
                   double *const *force) {
    double energy = 0;
    (void)id;
    for (size_t n = 0; n < count; n++) {
        const double x = position[0][n] - 2.5, k = *(const double *)stiffness;
        force[0][n] -= k * x;
        energy += 0.5 * k * x * x;
    }
    return energy;
}

static void test_user_force_holds_particles_as_equipartition_says(void **state) {
    (void)state;
    enum { SAMPLES = 80 };
    double stiffness = 4, sum = 0;
    struct mesofit_scene scene = small_scene();
    scene.conservative = (struct mesofit_law){0};
    scene.time_step = 0.01;
    struct mesofit_simulation *simulation = mesofit_simulation_create(&scene);
    assert_non_null(simulation);
    mesofit_simulation_set_force(simulation, pull, &stiffness);
    assert_int_equal(mesofit_simulation_run(simulation, 4000), MESOFIT_OK);
    for (int sample = 0; sample < SAMPLES; sample++) {
        assert_int_equal(mesofit_simulation_run(simulation, 50), MESOFIT_OK);
        const double *x = mesofit_simulation_positions(simulation, 0);
        for (size_t n = 0; n < mesofit_simulation_count(simulation); n++)
            sum += stiffness * (x[n] - 2.5) * (x[n] - 2.5) / (300.0 * SAMPLES);
    }
    // Var of x^2 is 2; of samples 0.5 apart, of a period of 3.1, one in six counts.
    assert_close(sum, 1, 4 * sqrt(2.0 / (300 * SAMPLES / 6)));
    print_message("k <x^2> = %.3f\n", sum);
    mesofit_simulation_free(simulation);
}

static void test_user_force_is_refused_when_moves_would_not_feel_it(void **state) {
    (void)state;
    double stiffness = 4;
    struct mesofit_means means;
    struct mesofit_scene scene = small_scene();
    scene.dissipative = (struct mesofit_law){0};
    scene.integrator = "monte-carlo";
    struct mesofit_simulation *simulation = mesofit_simulation_create(&scene);
    assert_non_null(simulation);
    assert_int_equal(mesofit_simulation_run(simulation, 100), MESOFIT_OK);
    assert_int_equal(mesofit_simulation_means(simulation, 20, 5, &means), MESOFIT_OK);
    assert_true(means.energy > 0);
    mesofit_simulation_set_force(simulation, pull, &stiffness);
    assert_int_equal(mesofit_simulation_run(simulation, 1), MESOFIT_BAD_INPUT);
    assert_contains(mesofit_message(), "monte-carlo");
    assert_int_equal(mesofit_simulation_means(simulation, 20, 5, &means), MESOFIT_BAD_INPUT);
    mesofit_simulation_set_force(simulation, NULL, NULL);
    assert_int_equal(mesofit_simulation_run(simulation, 1), MESOFIT_OK);
    mesofit_simulation_free(simulation);
}

static double found[2];

static void *run_in_thread(void *number) {
    struct mesofit_scene scene = small_scene();
    scene.seed = 1 + (uint64_t)(*(int *)number);
    found[*(int *)number] = run_small(&scene);
    return NULL;
}

static void test_simulations_of_two_threads_are_those_of_one(void **state) {
    (void)state;
    int number[] = {0, 1};
    pthread_t thread[2];
    for (int k = 0; k < 2; k++)
        assert_int_equal(pthread_create(&thread[k], NULL, run_in_thread, &number[k]), 0);
    for (int k = 0; k < 2; k++)
        pthread_join(thread[k], NULL);
    for (int k = 0; k < 2; k++) {
        struct mesofit_scene scene = small_scene();
        scene.seed = 1 + (uint64_t)k;
        assert_close(found[k], run_small(&scene), 0);
    }
    assert_true(found[0] != found[1]);
}

/// g(r) of the soft fluid, measured by the library itself, to be fitted.
enum { BINS = 40 };

static void make_target(double *r, double *g, double *error) {
    struct mesofit_scene scene = small_scene();
    scene.time_step = 0.01;
    struct mesofit_simulation *simulation = mesofit_simulation_create(&scene);
    struct mesofit_rdf_plan plan = mesofit_rdf_plan_default();
    plan.bins = BINS;
    plan.range = 1.6;
    assert_non_null(simulation);
    assert_int_equal(mesofit_simulation_run(simulation, 200), MESOFIT_OK);
    assert_int_equal(mesofit_simulation_rdf(simulation, &plan, r, g, error), MESOFIT_OK);
    mesofit_simulation_free(simulation);
}

static struct mesofit_fit_options small_fit(const double *r, const double *g, const double *error) {
    struct mesofit_fit_options options = mesofit_fit_options_default();
    options.scene = small_scene();
    options.scene.conservative = (struct mesofit_law){0};
    options.rdf.count = BINS;
    options.rdf.r = r;
    options.rdf.g = g;
    options.rdf.error = error;
    options.settings = "{\"replicas\": 4, \"iterations\": 6, \"precision\": 0.02}";
    return options;
}

static void test_fit_from_arrays_comes_nearer_and_verifies(void **state) {
    (void)state;
    double r[BINS], g[BINS], error[BINS];
    make_target(r, g, error);
    const struct mesofit_fit_options options = small_fit(r, g, error);
    struct mesofit_fit *fit = mesofit_fit_create(&options);
    struct mesofit_fit_state now = {0};
    struct mesofit_verification verified;
    assert_non_null(fit);
    assert_int_equal(mesofit_fit_curve(fit, MESOFIT_POTENTIAL).count, 0);
    assert_int_equal(mesofit_fit_verify(fit, &verified), MESOFIT_BAD_INPUT);
    assert_int_equal(mesofit_fit_iterate(fit, &now), MESOFIT_OK);
    const double first = now.error;
    while (!now.finished)
        assert_int_equal(mesofit_fit_iterate(fit, &now), MESOFIT_OK);
    assert_true(now.error <= first && now.error < 2 * now.noise);
    const struct mesofit_curve phi = mesofit_fit_curve(fit, MESOFIT_POTENTIAL);
    assert_int_equal(phi.count, BINS + 1);
    assert_close(phi.r[BINS], 1.6, 1e-12);
    assert_int_equal(mesofit_fit_curve(fit, MESOFIT_FRICTION).count, 0);
    assert_int_equal(mesofit_fit_verify(fit, &verified), MESOFIT_OK);
    assert_true(verified.rdf_rms < 0.1 && isnan(verified.etd_rms));
    mesofit_fit_free(fit);
}

/// An inversion moves no variables: it makes none.
static void test_inversion_has_no_coefficients(void **state) {
    (void)state;
    double r[BINS], g[BINS], error[BINS], value = 0.5, variance;
    make_target(r, g, error);
    const struct mesofit_fit_options options = small_fit(r, g, error);
    struct mesofit_fit *fit = mesofit_fit_create(&options);
    assert_non_null(fit);
    assert_int_equal(mesofit_fit_coefficients(fit), 0);
    assert_int_equal(mesofit_fit_start(fit, &value), MESOFIT_BAD_INPUT);
    assert_non_null(strstr(mesofit_message(), "does not measure candidates"));
    assert_int_equal(mesofit_fit_evaluate(fit, &value, 1, &value, &variance), MESOFIT_BAD_INPUT);
    mesofit_fit_free(fit);
}

/// Coefficients are added to what is made of the target: none of them is where a fit begins.
static void test_fit_begins_at_its_base(void **state) {
    (void)state;
    double r[BINS], g[BINS], error[BINS], start[200];
    make_target(r, g, error);
    struct mesofit_fit_options options = small_fit(r, g, error);
    options.method = "genetic";
    options.settings = "{\"population\": 4, \"generations\": 1}";
    struct mesofit_fit *fit = mesofit_fit_create(&options);
    assert_non_null(fit);
    const size_t count = mesofit_fit_coefficients(fit);
    assert_in_range(count, 1, 200);
    assert_int_equal(mesofit_fit_start(fit, start), MESOFIT_OK);
    for (size_t k = 0; k < count; k++)
        assert_close(start[k], 0.5, 1e-9);
    mesofit_fit_free(fit);
}

static int cancel(void *context, uint32_t iteration, uint64_t done, uint64_t total) {
    (void)iteration, (void)done, (void)total;
    ++*(int *)context;
    return 1;
}

static void check_cancel(const char *settings) {
    double r[BINS], g[BINS], error[BINS];
    int told = 0;
    make_target(r, g, error);
    struct mesofit_fit_options options = small_fit(r, g, error);
    options.settings = settings;
    struct mesofit_fit *other = mesofit_fit_create(&options);
    options.progress = cancel;
    options.context = &told;
    struct mesofit_fit *fit = mesofit_fit_create(&options);
    assert_non_null(fit);
    assert_int_equal(mesofit_fit_iterate(fit, NULL), MESOFIT_INTERRUPTED);
    assert_true(told > 0);
    assert_int_equal(mesofit_fit_iterate(other, NULL), MESOFIT_OK);
    mesofit_fit_free(fit);
    mesofit_fit_free(other);
}

static void handler(const char *reason, const char *file, int line, int number) {
    (void)reason, (void)file, (void)line, (void)number;
}

static void test_fit_is_cancelled_by_its_listener_alone(void **state) {
    (void)state;
    check_cancel("{\"replicas\": 4, \"iterations\": 6, \"precision\": 0.02}");
    check_cancel("{\"sampler\": \"dynamics\", \"replicas\": 4, \"precision\": 0.02}");
}

static void test_handler_of_gsl_is_again_the_callers(void **state) {
    (void)state;
    gsl_error_handler_t *before = gsl_set_error_handler(handler);
    struct mesofit_scene scene = small_scene();
    run_small(&scene);
    assert_ptr_equal(gsl_set_error_handler(before), handler);
}

static void test_optimiser_finds_the_bottom_of_a_bowl(void **state) {
    (void)state;
    struct mesofit_optimiser *optimiser = mesofit_optimiser_create(
        "cma-es", "{\"population\": 8, \"rounds\": 60}", 3, -2, 2, NULL, 1);
    double best[3], errors[1024];
    const double *candidates;
    size_t count;
    assert_non_null(optimiser);
    assert_int_equal(mesofit_optimiser_best(optimiser, best), 0);
    while (mesofit_optimiser_ask(optimiser, &candidates, &count) == MESOFIT_OK && count > 0) {
        for (size_t k = 0; k < count; k++) {
            errors[k] = 0;
            for (int d = 0; d < 3; d++)
                errors[k] += pow(candidates[3 * k + (size_t)d] - 0.5, 2);
        }
        assert_int_equal(mesofit_optimiser_tell(optimiser, errors, NULL), MESOFIT_OK);
    }
    assert_int_equal(mesofit_optimiser_best(optimiser, best), 1);
    for (int d = 0; d < 3; d++)
        assert_close(best[d], 0.5, 1e-2);
    mesofit_optimiser_free(optimiser);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_own_law_gives_the_forces_of_the_formula),
        cmocka_unit_test(test_faults_are_told_and_not_printed),
        cmocka_unit_test(test_failures_are_told_in_the_units_of_the_scene),
        cmocka_unit_test(test_scene_reads_its_table_from_memory),
        cmocka_unit_test(test_user_force_holds_particles_as_equipartition_says),
        cmocka_unit_test(test_user_force_is_refused_when_moves_would_not_feel_it),
        cmocka_unit_test(test_simulations_of_two_threads_are_those_of_one),
        cmocka_unit_test(test_inversion_has_no_coefficients),
        cmocka_unit_test(test_fit_begins_at_its_base),
        cmocka_unit_test(test_fit_from_arrays_comes_nearer_and_verifies),
        cmocka_unit_test(test_fit_is_cancelled_by_its_listener_alone),
        cmocka_unit_test(test_handler_of_gsl_is_again_the_callers),
        cmocka_unit_test(test_optimiser_finds_the_bottom_of_a_bowl),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
