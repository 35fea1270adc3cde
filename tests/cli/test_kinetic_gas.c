// SPDX-License-Identifier: GPL-3.0-or-later
//
// Hard discs and spheres from outside: what a scene gives, bits through restarts and threads, and
// what is refused.
#include "base/rng.h"
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>

static const char scene[] =
    "{\"seed\": 5, \"dimensions\": 2, \"box\": [20, 20], \"time_step\": 0.4,\n"
    "\"particles\": {\"types\": {\"A\": 80, \"B\": 60}, \"placement\": \"random\",\n"
    "\"radius\": {\"A\": 0.5, \"B\": 0.7}, \"mass\": {\"A\": 1, \"B\": 2}, \"velocities\": "
    "\"signs\"},\n"
    "\"dynamics\": {\"integrator\": \"event-driven\", \"walls\": \"y\"},\n"
    "\"collisions\": {\"bins\": 20}, \"rdf\": {\"range\": 3, \"bins\": 20},\n"
    "\"motion\": {\"every\": 1, \"lags\": 10},\n"
    "\"measure\": {\"equilibration\": 40, \"samples\": 60, \"every\": 4}}\n";

static const char *const tables[] = {
    "collisions.tsv",     "speeds.tsv", "rdf_A-B.tsv", "motion.tsv",
    "thermodynamics.tsv", "used.json",  NULL};

static const char *const numbers[] = {"packing_fraction",
                                      "compressibility_factor",
                                      "compressibility_factor_error",
                                      "compressibility_factor_theory",
                                      "compressibility_factor_walls",
                                      "compressibility_factor_walls_error",
                                      "collision_rate",
                                      "collision_rate_error",
                                      "collision_rate_theory",
                                      "mean_free_path",
                                      "mean_free_path_error",
                                      "mean_free_path_theory",
                                      "speeds_p_value",
                                      "collisions",
                                      NULL};

static void write_text(struct temporary_folder *folder, const char *name, const char *text) {
    small_inputs_write(folder, name, text, NULL, NULL);
}

static void test_kinetic_gas_goes_on_with_the_same_bits(void **state) {
    static struct run_program_result result;
    write_text(*state, "scene.json", scene);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "whole");
    run_program_assert_code(&result, 0);
    assert_null(strstr(result.err, "there is no thermostat"));
    const char *const words[] = {"simulate", "scene.json", "-o", "pieces", NULL};
    run_program_in_pieces(0, words);
    results_assert_same("whole", "pieces", tables);
    RUN_PROGRAM(&result, "simulate", "whole/used.json", "-o", "again", "--threads", "2");
    run_program_assert_code(&result, 0);
    results_assert_same("whole", "again", tables);
}

/// Walls take room from the centres: Z is larger than theory says of the whole box, by the walls as
/// by the collisions. The error of 240 steps of 140 discs is about 1 %.
static void test_kinetic_gas_writes_what_it_measured(void **state) {
    static struct run_program_result result;
    write_text(*state, "scene.json", scene);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "by collisions, theory");
    results_assert_numbers("out/summary.json", numbers);
    results_assert_table("out/collisions.tsv", 6, 60);
    results_assert_table("out/speeds.tsv", 4, 20);
    results_assert_table("out/timing.tsv", 3, 1);
    assert_close(results_number("out/summary.json", "temperature"), 1, 1e-2);
    const double theory = results_number("out/summary.json", "compressibility_factor_theory");
    const double inside = results_number("out/summary.json", "compressibility_factor");
    const double walls = results_number("out/summary.json", "compressibility_factor_walls");
    assert_true(inside > theory && inside < 1.3 * theory);
    assert_close_relative(walls, inside, 0.15);
    assert_true(results_number("out/summary.json", "speeds_p_value") > 1e-4);
    assert_true(results_number("out/summary.json", "deepest_overlap") < 1e-12);
}

static void test_kinetic_gas_explains_and_describes_itself(void **state) {
    static struct run_program_result result;
    write_text(*state, "scene.json", scene);
    RUN_PROGRAM(&result, "simulate", "scene.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "event-driven");
    assert_contains(result.out, "collisions                         on ");
    RUN_PROGRAM(&result, "describe", "event-driven");
    assert_contains(result.out, "walls");
    RUN_PROGRAM(&result, "describe", "collisions");
    assert_contains(result.out, "bins of the speed distribution");
}

static void test_kinetic_gas_refuses_with_file_and_key(void **state) {
    static const struct {
        const char *from, *to, *words[4];
    } cases[] = {
        {"\"collisions\"",
         "\"conservative\": {\"law\": \"soft-repulsion\"}, \"collisions\"",
         {"scene.json: conservative: \"event-driven\" moves hard particles"}},
        {"\"collisions\"",
         "\"interactions\": {\"uniform-force\": {\"force\": [1, 0]}}, "
         "\"collisions\"",
         {"scene.json: interactions: "}},
        {"\"walls\": \"y\"", "\"walls\": \"yz\"", {"scene.json: dynamics.walls: ", "two"}},
        {"\"walls\": \"y\"", "\"walls\": \"w\"", {"scene.json: dynamics.walls: "}},
        {"\"walls\": \"y\"",
         "\"walls\": \"zy\"",
         {"scene.json: dynamics.walls: \"zy\" is unknown; did you mean \"yz\"?"}},
        {"\"particles\": {",
         "\"particles\": {\"orientation\": 1, ",
         {"scene.json: particles.orientation: event-driven turns no orientations"}},
        {"\"A\": 0.5", "\"A\": -0.5", {"scene.json: particles.radius.A: -0.5 is out of range"}},
        {"\"B\": 0.7", "\"B\": 5.2", {"scene.json: box: its edge 20 is below two diameters"}},
        {"\"B\": 0.7", "\"B\": 1.3", {"scene.json: particles ", " overlap at the start"}},
        {"{\"integrator\": \"event-driven\", \"walls\": \"y\"}",
         "{\"integrator\": \"velocity-verlet\"}",
         {"scene.json: collisions: only the integrator \"event-driven\""}},
        {"\"placement\": \"random\",\n\"radius\": {\"A\": 0.5, \"B\": 0.7},",
         "\"placement\": \"file\", \"file\": \"places.tsv\",",
         {"scene.json: particles 1 and 3 overlap at the start: they are 0.9 apart"}},
    };
    static struct run_program_result result;
    char places[4096] = "# x y\n";
    for (int k = 0; k < 140; k++) {
        const double x = k == 3 ? 2.9 : 0.8 + 1.2 * (k % 16), y = 1 + 1.9 * (k / 16);
        snprintf(places + strlen(places), 32, "%g %g\n", x, y);
    }
    write_text(*state, "places.tsv", places);
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        small_inputs_write(*state, "scene.json", scene, cases[n].from, cases[n].to);
        RUN_PROGRAM(&result, "simulate", "scene.json");
        run_program_assert_refused(&result, ".", cases[n].to, 1, cases[n].words);
    }
}

/// A square lattice of 36 discs in a box of 12, whose velocities are normal but for a drift.
static void write_discs(struct temporary_folder *folder, double drift) {
    static char text[8192];
    int length = 0;
    for (uint32_t k = 0; k < 36; k++) {
        double normal[4];
        mf_rng_normal4(mf_rng_philox(7, RNG_VELOCITIES, k, 0, 0), normal);
        length += snprintf(text + length, sizeof text - (size_t)length, "%g %g %.17g %.17g\n",
                           1 + 2.0 * (k % 6), 1 + 2.0 * (k / 6), normal[0] + drift, normal[1]);
    }
    write_text(folder, "discs.txt", text);
}

#define DISCS(walls)                                                                               \
    "{\"dimensions\": 2, \"box\": [12, 12], \"time_step\": 0.2,\n"                                 \
    "\"particles\": {\"count\": 36, \"placement\": \"file\", \"file\": \"discs.txt\", "            \
    "\"radius\": "                                                                                 \
    "0.7},\n"                                                                                      \
    "\"dynamics\": {\"integrator\": \"event-driven\", \"walls\": \"" walls "\"},\n"                \
    "\"collisions\": {}, \"measure\": {\"equilibration\": 1, \"samples\": 10, \"every\": 1}}\n"

/// What all particles have in common is no heat, no pressure and no speed of theirs.
static void test_kinetic_gas_is_the_same_when_it_drifts(void **state) {
    static const char *const same[] = {
        "compressibility_factor", "collision_rate", "collision_rate_theory",
        "mean_free_path",         "temperature",    "pressure"};
    static struct run_program_result result;
    write_text(*state, "scene.json", DISCS("none"));
    for (int drift = 0; drift < 2; drift++) {
        write_discs(*state, 5 * drift);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", drift ? "drifts" : "rests");
        run_program_assert_code(&result, 0);
    }
    for (size_t k = 0; k < sizeof same / sizeof *same; k++)
        assert_close(results_number("drifts/summary.json", same[k]),
                     results_number("rests/summary.json", same[k]), 1e-6);
    // Theory is for the temperature of these velocities, not for that of the scene.
    const double temperature = results_number("rests/summary.json", "temperature");
    assert_true(fabs(temperature - 1) > 0.02);
}

/// Positions alone: velocities are drawn, and have the temperature of the scene exactly, which is
/// Σ m v²/(d N) where walls keep no momentum.
static void test_kinetic_gas_from_places_has_the_temperature_of_the_scene(void **state) {
    static struct run_program_result result;
    static char text[4096];
    int length = 0;
    for (int k = 0; k < 36; k++)
        length += snprintf(text + length, sizeof text - (size_t)length, "%g %g\n",
                           1 + 2.0 * (k % 6), 1 + 2.0 * (k / 6));
    write_text(*state, "discs.txt", text);
    write_text(*state, "scene.json", DISCS("none"));
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 0);
    assert_close(results_number("out/summary.json", "temperature"), 1, 1e-12);
    char outside[sizeof text + 1];
    snprintf(outside, sizeof outside, "-%s", text); // the first disc is at −1
    write_text(*state, "outside.txt", outside);
    small_inputs_write(*state, "scene.json", DISCS("xy"), "discs.txt", "outside.txt");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "none");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "beyond a wall");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_kinetic_gas_goes_on_with_the_same_bits,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_kinetic_gas_writes_what_it_measured,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_kinetic_gas_explains_and_describes_itself,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_kinetic_gas_is_the_same_when_it_drifts,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(
            test_kinetic_gas_from_places_has_the_temperature_of_the_scene,
            small_inputs_enter_without_gnuplot, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_kinetic_gas_refuses_with_file_and_key,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
