// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_defaults.h"

#include "dynamics/respa.h"
#include "inversion/inversion.h"
#include "inversion/inversions.h"
#include "matching/matchings.h"
#include "matching/population.h"
#include "shared/is_close.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const struct run_options options = {.threads = 1};

/// A gas of soft beads, g = exp(−10 exp(−(r/0.5)²)), up to 4.5, whose parabolas are gentle.
static void write_target(void **state, double error) {
    char text[8192];
    int length = snprintf(text, sizeof text, "# r[lambda]\tg[1]\tg_error[1]\n");
    for (int k = 0; k < 150; k++) {
        const double r = (k + 0.5) * 0.03;
        length += snprintf(text + length, sizeof text - (size_t)length, "%.4f %.6f %g\n", r,
                           exp(-10 * exp(-r * r / 0.25)), error);
    }
    temporary_folder_write(*state, "rdf.tsv", text, (size_t)length);
}

static enum status read_run(void **state, struct fit_file *fit, const char *name,
                            const char *text) {
    return mf_fit_file_read(fit, temporary_folder_write(*state, name, text, strlen(text)),
                            &options);
}

#define TARGET "{\"target\": {\"rdf\": {\"file\": \"rdf.tsv\"}}, "

static void test_fit_defaults_choose_all_that_target_density_and_temperature_leave(void **state) {
    struct fit_file fit;
    write_target(state, 0.002);
    assert_ok(read_run(state, &fit, "run.json",
                       TARGET "\"scene\": {\"density\": 0.3, \"temperature\": 1}}"));
    const struct simulation_setup *setup = &fit.scene.setup;
    const struct inversion_parameters *settings = fit.method_parameters;
    const double range = mf_rdf_bins_range(&fit.problem.targets.bins);
    for (size_t k = 0; k < fit.choices.count; k++)
        print_message("%s\n", fit.choices.line[k]);
    assert_in_range(fit.choices.count, 5, FIT_MAX_CHOICES);
    assert_ptr_equal(fit.method, &mf_automatic);
    assert_in_range(setup->placement.count, 1000, 1e5);
    assert_close((double)setup->placement.count / mf_box_volume(&setup->box), 0.3, 1e-9);
    assert_true(mf_box_shortest(&setup->box) >= 2 * range);
    // g is 1 within its noise from 1.5 on, where 10 exp(−(r/0.5)²) is 0.001; 3.4 are 2.3 spacings.
    assert_true(range > 1.3 && range < 3.5);
    // The largest of −(ln g)'' is 40 (1 − r²/…) at most: 2 · 10/0.25 · 2 e^{−3/2} = 35.7.
    assert_true(setup->time_step <= sqrt(0.04 / (2 * 30)) && setup->time_step > 0.01);
    assert_true(fit.scene.omega.curves == 1 && mf_integrator_list[0] != NULL);
    assert_true(setup->integrator->dissipative);
    assert_in_range(settings->particles, 700, 1e5);
    assert_close(settings->precision, 0.002, 1e-3);
    assert_in_range(fit.verification.plan.samples, 50, 1e6);
    assert_int_equal(fit.verification.shorten, 1);
    mf_fit_file_clear(&fit);
}

/// Of two types in equal parts a quarter of all pairs are of either and half are unlike: in the
/// samples that tell g of all beads within 0.001, theirs is known within that times
/// sqrt((4 + 2 + 4)/3).
static void test_fit_defaults_ask_of_types_what_samples_of_all_beads_tell(void **state) {
    struct fit_file fit;
    write_target(state, 1e-5);
    assert_ok(read_run(state, &fit, "run.json",
                       "{\"target\": {\"rdf\": {\"A-A\": {\"file\": \"rdf.tsv\"}, "
                       "\"A-B\": {\"file\": \"rdf.tsv\"}, \"B-B\": {\"file\": \"rdf.tsv\"}}}, "
                       "\"scene\": {\"density\": 0.3, "
                       "\"particles\": {\"types\": {\"A\": 4000, \"B\": 4000}}}}"));
    assert_close(((const struct inversion_parameters *)fit.method_parameters)->precision,
                 0.001 * sqrt(10.0 / 3), 1e-6);
    mf_fit_file_clear(&fit);
}

/// What used.json says is what was chosen, so that nothing is left to be chosen again.
static void test_fit_defaults_stand_in_used_json(void **state) {
    struct fit_file fit, again;
    char path[1024];
    write_target(state, 0.002);
    assert_ok(read_run(state, &fit, "run.json", TARGET "\"scene\": {\"density\": 0.3}}"));
    snprintf(path, sizeof path, "%s", temporary_folder_file(*state, "used.json"));
    struct json_writer *writer = mf_json_writer_create();
    mf_fit_file_write(&fit, writer);
    assert_ok(mf_json_write(writer, path));
    mf_json_writer_free(writer);
    assert_ok(mf_fit_file_read(&again, path, &options));
    assert_int_equal(again.choices.count, 0);
    assert_identical(again.scene.setup.time_step, fit.scene.setup.time_step);
    assert_identical(again.scene.setup.box.length[0], fit.scene.setup.box.length[0]);
    assert_int_equal(again.scene.setup.placement.count, fit.scene.setup.placement.count);
    assert_int_equal(again.problem.targets.bins.count, fit.problem.targets.bins.count);
    assert_memory_equal(&again.verification, &fit.verification, sizeof fit.verification);
    assert_memory_equal(again.method_parameters, fit.method_parameters,
                        sizeof(struct inversion_parameters));
    assert_identical(mf_curve_value(&again.scene.omega.curve[0], 0.5),
                     mf_curve_value(&fit.scene.omega.curve[0], 0.5));
    mf_fit_file_clear(&fit);
    mf_fit_file_clear(&again);
}

static void test_fit_defaults_leave_what_the_file_says(void **state) {
    struct fit_file fit;
    write_target(state, 0.002);
    assert_ok(
        read_run(state, &fit, "run.json",
                 "{\"target\": {\"rdf\": {\"file\": \"rdf.tsv\", \"cutoff\": 3.5}}, "
                 "\"scene\": {\"box\": [9, 9, 9], \"particles\": {\"count\": 219}, "
                 "\"time_step\": 0.011, \"dynamics\": {\"integrator\": \"velocity-verlet\"}}, "
                 "\"verification\": {\"samples\": 77}}"));
    assert_identical(fit.scene.setup.time_step, 0.011);
    assert_identical(fit.scene.setup.box.length[0], 9);
    assert_int_equal(fit.scene.setup.placement.count, 219);
    assert_int_equal(fit.verification.plan.samples, 77);
    assert_int_equal(fit.verification.shorten, 0);
    assert_int_equal(fit.scene.omega.curves, 0);
    assert_close(mf_rdf_bins_range(&fit.problem.targets.bins), 3.5, 0.03);
    mf_fit_file_clear(&fit);
}

/// A file with a method has fixed defaults, but for what would leave the temperature to chance.
/// As many samples in all, in how many simulations ever.
static void test_fit_defaults_choose_samples_for_the_simulations_that_the_file_says(void **state) {
    struct fit_file few, many;
    write_target(state, 0.002);
#define SCENE "\"scene\": {\"density\": 0.3, \"temperature\": 1}, \"verification\": "
    assert_ok(read_run(state, &few, "few.json", TARGET SCENE "{\"replicas\": 1}}"));
    assert_ok(read_run(state, &many, "many.json", TARGET SCENE "{\"replicas\": 2}}"));
#undef SCENE
    const double one = (double)few.verification.plan.samples;
    const double two = (double)many.verification.plan.samples;
    print_message("%.0f samples of one, %.0f of two\n", one, two);
    assert_in_range(two, 51, 1e6); // more than there are at least
    assert_close(one, 2 * two, 2);
    mf_fit_file_clear(&few);
    mf_fit_file_clear(&many);
}

/// Twice the noise is that of a quarter of the samples: where samples are dear, and of so many
/// beads that each of them tells T.
static void test_fit_defaults_choose_no_more_samples_than_needed_where_they_are_dear(void **state) {
    struct fit_file cheap, dear;
    write_target(state, 0.002);
#define SCENE                                                                                      \
    "\"scene\": {\"density\": 0.3, \"temperature\": 1}, "                                          \
    "\"verification\": {\"replicas\": 1, \"every\": "
    assert_ok(read_run(state, &cheap, "cheap.json", TARGET SCENE "1}}"));
    assert_ok(read_run(state, &dear, "dear.json", TARGET SCENE "150}}"));
#undef SCENE
    print_message("%d samples, %d of dear ones\n", (int)cheap.verification.plan.samples,
                  (int)dear.verification.plan.samples);
    assert_in_range(dear.verification.plan.samples, 51, 1e6); // more than there are at least
    assert_close((double)cheap.verification.plan.samples,
                 4 * (double)dear.verification.plan.samples, 4);
    mf_fit_file_clear(&cheap);
    mf_fit_file_clear(&dear);
}

static void test_fit_defaults_choose_friction_and_time_step_beside_a_method(void **state) {
    static const char scene[] =
        TARGET "\"scene\": {\"box\": [9.1, 9.1, 9.1], %s\"particles\": {\"count\": 226}}, "
               "\"method\": {\"name\": \"ibi\"}}";
    static const char *const moves[] = {"",
                                        "\"dynamics\": {\"integrator\": \"brownian\", "
                                        "\"friction\": 2}, ",
                                        "\"time_step\": 0.01, \"dissipative\": {\"law\": "
                                        "\"power\", \"sigma\": 3}, ",
                                        "\"dissipative_transverse\": {\"law\": \"power\", "
                                        "\"sigma\": 3}, "};
    static const size_t choices[] = {2, 1, 0, 1};
    write_target(state, 0.002);
    for (int k = 0; k < 4; k++) {
        struct fit_file fit;
        char text[2048];
        snprintf(text, sizeof text, scene, moves[k]);
        assert_ok(read_run(state, &fit, "run.json", text));
        assert_int_equal(fit.choices.count, choices[k]);
        assert_int_equal(fit.verification.shorten, k != 2); // there the file gives a step
        assert_int_equal(fit.scene.omega.curves > 0, k % 2 == 0);
        if (k != 1)
            assert_identical(fit.scene.setup.time_step, k == 2 ? 0.01 : 0.02);
        assert_int_equal(fit.verification.plan.samples, 50);
        assert_int_equal(fit.problem.targets.bins.count, 150);
        mf_fit_file_clear(&fit);
    }
}

/// All else is there: twice the range is narrower than a box of a thousand beads.
static void test_fit_defaults_choose_how_many_beads_beside_a_method(void **state) {
    struct fit_file fit;
    write_target(state, 0.002);
    assert_ok(read_run(state, &fit, "run.json",
                       TARGET
                       "\"scene\": {\"density\": 0.3, \"time_step\": 0.01, \"dissipative\": "
                       "{\"law\": \"power\", \"sigma\": 3}}, \"method\": {\"name\": \"ibi\"}, "
                       "\"verification\": {\"replicas\": 2, \"equilibration\": 10, \"every\": 2, "
                       "\"samples\": 10}}"));
    assert_int_equal(fit.choices.count, 1);
    assert_int_equal(fit.scene.setup.placement.count, 1000);
    mf_fit_file_clear(&fit);
}

/// Dimers whose spring of k = 4e4 makes ω = sqrt(2 k/m): steps of Verlet's integrator make the
/// variance wrong by (ω Δt)²/4, and impulses of pairs resonate with it where ω Δt is π. Not where
/// the file says how beads move, nor where stress or memory follow each step.
static void test_fit_defaults_cut_the_steps_of_pairs_for_bonds(void **state) {
    static const char *const said[][2] = {
        {"", ""},
        {"", ", \"time_step\": 0.01"},
        {"", ", \"dynamics\": {\"integrator\": \"velocity-verlet\"}"},
        {", \"shear_viscosity\": {\"value\": 1, \"error\": 0.1, \"fitted\": \"no\"}", ""},
        {"",
         ", \"memory\": {\"slow\": {\"time\": 0.5, \"omega\": {\"law\": \"power\", \"sigma\": 2, "
         "\"cutoff\": 1}}}"}};
    const double omega = sqrt(2 * 4e4);
    write_target(state, 0.002);
    for (int k = 0; k < 5; k++) {
        struct fit_file fit;
        char text[2048];
        snprintf(text, sizeof text,
                 "{\"target\": {\"rdf\": {\"file\": \"rdf.tsv\"}%s}, "
                 "\"scene\": {\"box\": [9.1, 9.1, 9.1]%s, \"bonds\": {\"stiff\": {\"law\": "
                 "\"harmonic\", \"k\": 4e4, \"length\": 0.5}}, \"molecules\": {\"dimer\": "
                 "{\"count\": 113, \"chain\": {\"type\": \"A\", \"length\": 2, \"bond\": "
                 "\"stiff\"}}}}}",
                 said[k][0], said[k][1]);
        assert_ok(read_run(state, &fit, "run.json", text));
        const struct simulation_setup *const setup = &fit.scene.setup;
        const int64_t inner = mf_respa_inner_steps(setup->integrator, setup->integrator_parameters);
        const double turn = omega * setup->time_step / (double)inner;
        print_message("step %g of %lld: %g of the variance\n", setup->time_step, (long long)inner,
                      turn * turn / 4);
        assert_true(k == 0 ? inner > 3 && omega * setup->time_step <= 0.9 : inner == 1);
        assert_true(k == 1 || turn * turn / 4 < (k < 3 ? 0.0031 : 0.0076)); // aboba: a tenth
        mf_fit_file_clear(&fit);
    }
}

/// Molecules are sampled in a smaller system where that halves the scene: not for the integrals of
/// its waves, nor in mixtures, nor where they might meet their own images there.
static void test_fit_defaults_sample_molecules_in_half_of_the_scene_or_all(void **state) {
    static const struct {
        const char *target;
        int count, length;
        const char *others;
        bool smaller;
    } cases[] = {{"", 2000, 2, "", true},
                 {"", 100, 40, "", false},
                 {", \"kirkwood_buff\": {\"value\": -1, \"error\": 0.1}", 2000, 2, "", false},
                 {"", 2000, 2,
                  ", \"one\": {\"count\": 1, \"chain\": {\"type\": \"A\", \"length\": 3, \"bond\": "
                  "\"spring\"}}",
                  false}};
    write_target(state, 0.002);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct fit_file fit;
        char text[2048];
        snprintf(text, sizeof text,
                 "{\"target\": {\"rdf\": {\"file\": \"rdf.tsv\"}%s}, "
                 "\"scene\": {\"box\": [24, 24, 24], \"bonds\": {\"spring\": {\"law\": "
                 "\"harmonic\", \"k\": 100, \"length\": 0.5}}, \"molecules\": {\"dimer\": "
                 "{\"count\": %d, \"chain\": {\"type\": \"A\", \"length\": %d, \"bond\": "
                 "\"spring\"}}%s}}}",
                 cases[k].target, cases[k].count, cases[k].length, cases[k].others);
        assert_ok(read_run(state, &fit, "run.json", text));
        const int64_t particles =
            ((const struct inversion_parameters *)fit.method_parameters)->particles;
        assert_in_range(particles, cases[k].smaller ? 700 : 0, cases[k].smaller ? 2000 : 0);
        mf_fit_file_clear(&fit);
    }
}

/// A long box is sampled at a size whose short edges hold the range twice.
static void test_fit_defaults_sample_a_long_box_that_holds_the_range(void **state) {
    struct fit_file fit;
    write_target(state, 0.002);
    assert_ok(read_run(state, &fit, "run.json",
                       "{\"target\": {\"rdf\": {\"file\": \"rdf.tsv\"}}, \"scene\": {\"box\": "
                       "[150, 14, 14], \"particles\": {\"count\": 8500}}}"));
    const double particles =
        (double)((const struct inversion_parameters *)fit.method_parameters)->particles;
    const double edge = 14 * cbrt(particles / 8500);
    const double range = mf_rdf_bins_range(&fit.problem.targets.bins);
    print_message("%g beads, short edge %g, range %g\n", particles, edge, range);
    assert_true(edge >= 2 * range);
    mf_fit_file_clear(&fit);
}

/// Lengths of a bond of k = 3000 in bins from a third to all of their standard deviation, 0.018,
/// which each have the mean of a normal density: its frequency is found within an eighth.
static void test_fit_defaults_know_a_bond_by_coarse_bins(void **state) {
    static const double width[] = {0.006, 0.012, 0.018};
    const double deviation = sqrt(1.0 / 3000), omega = sqrt(2 * 3000);
    write_target(state, 0.002);
    for (int k = 0; k < 3; k++) {
        struct fit_file fit;
        char text[8192];
        int length = snprintf(text, sizeof text, "# r[lambda]\tp[1/lambda]\tp_error[1/lambda]\n");
        for (double r = 0.5 * width[k]; r < 1; r += width[k])
            length += snprintf(text + length, sizeof text - (size_t)length, "%.4f %.8g 0.01\n", r,
                               (erf((r + 0.5 * width[k] - 0.601) / deviation * M_SQRT1_2) -
                                erf((r - 0.5 * width[k] - 0.601) / deviation * M_SQRT1_2)) /
                                   (2 * width[k]));
        temporary_folder_write(*state, "bonds.tsv", text, (size_t)length);
        snprintf(text, sizeof text,
                 "{\"target\": {\"rdf\": {\"file\": \"rdf.tsv\"}, \"bond_lengths\": {\"stick\": "
                 "{\"file\": \"bonds.tsv\"}}}, \"scene\": {\"box\": [9.1, 9.1, 9.1], "
                 "\"molecules\": {\"dimer\": {\"count\": 113, \"chain\": {\"type\": \"A\", "
                 "\"length\": 2, \"bond\": \"stick\"}}}}}");
        assert_ok(read_run(state, &fit, "run.json", text));
        const struct simulation_setup *const setup = &fit.scene.setup;
        const int64_t inner = mf_respa_inner_steps(setup->integrator, setup->integrator_parameters);
        const double turn = omega * setup->time_step / (double)inner;
        print_message("bins of %g: step %g of %lld: %g of the variance\n", width[k],
                      setup->time_step, (long long)inner, turn * turn / 4);
        assert_true(inner > 1 && omega * setup->time_step <= 0.9 * 9 / 8);
        assert_true(turn * turn / 4 < 0.003 * pow(9.0 / 8, 2));
        mf_fit_file_clear(&fit);
    }
}

/// A bead without velocities relaxes in γ/2Φ'', which a step of Euler's must stay far below, and
/// diffuses: twice the friction makes all of that twice as slow.
static void test_fit_defaults_choose_time_steps_by_the_friction_without_velocities(void **state) {
    static const char *const integrators[] = {"euler-maruyama", "brownian"};
    double time_step[2][2];
    write_target(state, 0.002);
    for (int k = 0; k < 4; k++) {
        struct fit_file fit;
        char text[2048];
        snprintf(text, sizeof text,
                 TARGET "\"scene\": {\"box\": [9.1, 9.1, 9.1], \"particles\": {\"count\": 226}, "
                        "\"dynamics\": {\"integrator\": \"%s\", \"friction\": %d}}, "
                        "\"method\": {\"name\": \"ibi\"}}",
                 integrators[k / 2], 10 * (k % 2 + 1));
        assert_ok(read_run(state, &fit, "run.json", text));
        time_step[k / 2][k % 2] = fit.scene.setup.time_step;
        mf_fit_file_clear(&fit);
    }
    // 1 % of the variance for the largest of −(ln g)'', 35.7 at most.
    assert_true(time_step[0][0] / 10 * 2 * 34 / 2 <= 0.0101);
    // A fiftieth of the way to neighbours, of which the shell is 2.24 wide at most, is 0.03.
    assert_true(sqrt(2 * time_step[1][0] / 10) <= 0.03);
    for (int k = 0; k < 2; k++) {
        assert_true(time_step[k][0] > 1e-3);
        assert_close(time_step[k][1] / time_step[k][0], 2, 1e-9);
    }
}

/// Friction across pairs that is to be found holds the temperature, too: one along pairs would make
/// it another.
static void test_fit_defaults_choose_no_friction_where_that_across_pairs_is_found(void **state) {
    static const char vacf[] = "0 1\n0.05 0.9\n0.1 0.8\n0.15 0.7\n";
    struct fit_file fit;
    write_target(state, 0.002);
    temporary_folder_write(*state, "vacf.tsv", vacf, strlen(vacf));
    assert_ok(read_run(state, &fit, "run.json",
                       "{\"target\": {\"rdf\": {\"file\": \"rdf.tsv\", \"fitted\": \"no\"}, "
                       "\"vacf\": {\"file\": \"vacf.tsv\"}}, "
                       "\"unknowns\": {\"omega_transverse\": {}}, "
                       "\"scene\": {\"box\": [9.1, 9.1, 9.1], \"particles\": {\"count\": 226}, "
                       "\"conservative\": {\"law\": \"gaussian\", \"epsilon\": 1}}, "
                       "\"method\": {\"name\": \"gauss-newton\"}}"));
    assert_int_equal(fit.scene.omega.curves, 0);
    assert_int_equal(fit.choices.count, 1); // the time step
    mf_fit_file_clear(&fit);
}

/// Half of a box that is given ends g(r), all of the last bin within it.
static void test_fit_defaults_cut_g_at_half_of_a_box_that_is_given(void **state) {
    struct fit_file fit;
    write_target(state, 0.002);
    assert_ok(read_run(state, &fit, "run.json",
                       TARGET
                       "\"scene\": {\"box\": [5.6, 5.6, 5.6], \"particles\": {\"count\": 53}}}"));
    const double range = mf_rdf_bins_range(&fit.problem.targets.bins);
    assert_true(range <= 2.8 && range > 2.7);
    mf_fit_file_clear(&fit);
}

/// A method without a name is chosen, and what the file says of it stays.
static void test_fit_defaults_choose_a_method_beside_its_parameters(void **state) {
    struct fit_file fit, plain;
    write_target(state, 0.002);
    assert_ok(read_run(state, &plain, "plain.json",
                       TARGET "\"scene\": {\"density\": 0.3, \"temperature\": 1}}"));
    assert_ok(read_run(state, &fit, "run.json",
                       TARGET "\"scene\": {\"density\": 0.3, \"temperature\": 1}, \"method\": "
                              "{\"start\": \"mean-force\", \"precision\": 0.05}}"));
    const struct inversion_parameters *settings = fit.method_parameters;
    assert_ptr_equal(fit.method, plain.method);
    assert_int_equal(settings->start, INVERSION_FROM_MEAN_FORCE);
    assert_close(settings->precision, 0.05, 0);
    assert_int_equal(settings->particles,
                     ((const struct inversion_parameters *)plain.method_parameters)->particles);
    assert_close(mf_rdf_bins_range(&fit.problem.targets.bins),
                 mf_rdf_bins_range(&plain.problem.targets.bins), 0);
    mf_fit_file_clear(&plain);
    mf_fit_file_clear(&fit);
    // 0, as many as the scene has, is a number that the file gives.
    assert_ok(read_run(state, &fit, "all.json",
                       TARGET "\"scene\": {\"density\": 0.3, \"temperature\": 1}, \"method\": "
                              "{\"particles\": 0}}"));
    settings = fit.method_parameters;
    assert_int_equal(settings->particles, 0);
    mf_fit_file_clear(&fit);
    // To find omega an inversion is not the method.
    assert_int_equal(
        read_run(state, &fit, "both.json",
                 "{\"target\": {\"rdf\": {\"file\": \"rdf.tsv\"}, \"diffusion\": {\"value\": 0.1, "
                 "\"error\": 0.01}}, \"scene\": {\"density\": 0.3, \"temperature\": 1}, "
                 "\"method\": {\"start\": \"mean-force\"}}"),
        STATUS_BAD_INPUT);
    assert_non_null(strstr(mf_status_message(), "give the \"name\" of the method"));
    mf_fit_file_clear(&fit);
}

/// Rows that are ten times finer than the gas asks for are joined, and its g ends where it is 1.
static void test_fit_defaults_join_fine_rows_and_end_g_with_its_structure(void **state) {
    enum { ROWS = 1200, SIZE = 40 * ROWS };
    static const char none[] = "\"method\": {\"name\": \"ibi\"}, ";
    struct fit_file fit;
    char *text = malloc(SIZE), run[1024];
    size_t length = 0;
    for (int k = 0; k < ROWS; k++) {
        const double r = (k + 0.5) * 0.005;
        length += (size_t)snprintf(text + length, SIZE - length, "%.4f %.6f 0.004\n", r,
                                   exp(-10 * exp(-r * r / 0.25)));
    }
    temporary_folder_write(*state, "fine.tsv", text, length);
    free(text);
    for (int given = 0; given < 2; given++) {
        snprintf(
            run, sizeof run,
            "{%s\"target\": {\"rdf\": {\"file\": \"fine.tsv\"}}, \"scene\": {\"density\": 0.3%s}}",
            given ? none : "", given ? ", \"particles\": {\"count\": 1000}" : "");
        assert_ok(read_run(state, &fit, "run.json", run));
        const struct rdf_bins *bins = &fit.problem.targets.bins;
        print_message("%zu bins of %g\n", bins->count, bins->width);
        if (given) { // a file with a method: no more than 400
            assert_int_equal(bins->count, 400);
        } else {
            // Cubics through bins of 0.1 are off by 3/128 · 0.1⁴ times 1200 at most, 0.003.
            assert_true(bins->width > 0.04 && bins->width < 0.15);
            // 10 exp(−4 r²) = 0.03 at r = 1.2; 2.3 spacings are 3.4.
            assert_close(mf_rdf_bins_range(bins), 2.3 * pow(0.3, -1.0 / 3), 0.15);
        }
        mf_fit_file_clear(&fit);
    }
}

/// Water's third layer, 1.03 high at 0.68 nm, has forces; the fourth, 1.01 at 0.9 nm, is made by
/// it.
static void test_fit_defaults_end_g_of_water_behind_its_third_layer(void **state) {
    struct fit_file fit;
    char folder[512], run[1024];
    assert_non_null(getcwd(folder, sizeof folder));
    snprintf(run, sizeof run,
             "{\"target\": {\"rdf\": {\"file\": \"%s/targets/spce-votca/CG-CG.dist.tgt\", "
             "\"format\": \"votca\"}}, \"scene\": {\"box\": [4.031, 4.031, 4.031], \"particles\": "
             "{\"count\": 2180}, \"units\": {\"length\": 1, \"temperature\": 300, \"mass\": "
             "2.992e-26}}}",
             folder);
    assert_ok(read_run(state, &fit, "run.json", run));
    const struct rdf_bins *bins = &fit.problem.targets.bins;
    print_message("%zu bins of %g to %g\n", bins->count, bins->width, mf_rdf_bins_range(bins));
    assert_true(mf_rdf_bins_range(bins) > 0.68 && mf_rdf_bins_range(bins) < 0.8);
    assert_close(bins->width, 0.01, 1e-6); // its peak has four rows and no row to spare
    mf_fit_file_clear(&fit);
}

/// Escape times ask for ω, too, and for a time step that divides their interval; bins come from the
/// names of the columns.
static void test_fit_defaults_find_omega_where_targets_move(void **state) {
    static const char etd[] = "# time[tau]\tE(r0=0.55)[1]\tE(r0=0.65)[1]\tE(r0=0.75)[1]\n"
                              "0 1 1 1\n0.07 1 0.9 0.6\n0.14 0.9 0.7 0.4\n0.21 0.8 0.6 0.3\n";
    struct fit_file fit;
    write_target(state, 0.002);
    temporary_folder_write(*state, "etd.tsv", etd, strlen(etd));
    assert_ok(read_run(state, &fit, "run.json",
                       "{\"target\": {\"rdf\": {\"file\": \"rdf.tsv\"}, \"etd\": {\"file\": "
                       "\"etd.tsv\"}}, \"scene\": {\"density\": 0.3}}"));
    assert_ptr_equal(fit.method, &mf_successive);
    assert_true(fit.unknown[UNKNOWN_POTENTIAL].wanted && fit.unknown[UNKNOWN_OMEGA].wanted);
    const double steps = 0.07 / fit.scene.setup.time_step;
    assert_close(steps, round(steps), 1e-9);
    assert_close(target_files_etd(&fit.files)->grid.r_minimum, 0.5, 1e-12);
    assert_close(target_files_etd(&fit.files)->grid.r_maximum, 0.8, 1e-12);
    const struct unknown_parameters *omega = &fit.unknown[UNKNOWN_OMEGA].parameters;
    assert_true(omega->cutoff > 0.8 && omega->maximum > 0);
    mf_fit_file_clear(&fit);
}

static void test_fit_defaults_choose_no_count_beside_a_file_of_places(void **state) {
    struct fit_file fit;
    write_target(state, 0.002);
    temporary_folder_write(*state, "places.tsv", "0 0 0\n1 1 1\n", 12);
    assert_fails(read_run(state, &fit, "run.json",
                          TARGET "\"scene\": {\"density\": 0.3, \"particles\": {\"placement\": "
                                 "\"file\", \"file\": \"places.tsv\"}}}"),
                 STATUS_BAD_INPUT, "scene.particles.count: missing");
    mf_fit_file_clear(&fit);
}

/// However noisy or exact the target, however thin or dense the liquid: what is chosen is never out
/// of the range of its own key.
static void test_fit_defaults_choose_nothing_that_the_reader_refuses(void **state) {
    static const double errors[] = {1e-12, 0.002, 0.3, 7.8, 1e6};
    static const double densities[] = {1e-9, 1e-3, 0.3};
    for (size_t e = 0; e < sizeof errors / sizeof *errors; e++)
        for (size_t d = 0; d < sizeof densities / sizeof *densities; d++) {
            struct fit_file fit;
            char run[512];
            write_target(state, errors[e]);
            snprintf(run, sizeof run, TARGET "\"scene\": {\"density\": %g}}", densities[d]);
            const enum status status = read_run(state, &fit, "run.json", run);
            if (status != STATUS_OK)
                fail_msg("error %g, density %g: %s", errors[e], densities[d], mf_status_message());
            mf_fit_file_clear(&fit);
        }
}

static void test_fit_defaults_tell_faults_once_and_only_what_is_missing(void **state) {
    struct fit_file fit;
    write_target(state, 0.002);
    assert_fails(read_run(state, &fit, "a.json", TARGET "\"scene\": {\"temperature\": 1}}"),
                 STATUS_BAD_INPUT, "scene.box: missing: it or \"density\" is required");
    mf_fit_file_clear(&fit);
    assert_fails(read_run(state, &fit, "b.json",
                          TARGET "\"scene\": {\"density\": 0.3, \"box\": [9, 9, 9]}}"),
                 STATUS_BAD_INPUT, "scene.density: \"box\" is given, too");
    mf_fit_file_clear(&fit);
    assert_fails(read_run(state, &fit, "c.json", TARGET "\"scene\": 5}"), STATUS_BAD_INPUT,
                 "scene: expected an object, found the number 5");
    assert_null(strchr(mf_status_message(), '\n'));
    mf_fit_file_clear(&fit);
    assert_fails(
        read_run(state, &fit, "d.json",
                 "{\"target\": {\"pressure\": {\"value\": 1}}, \"scene\": {\"density\": 1}}"),
        STATUS_BAD_INPUT, "method: missing");
    mf_fit_file_clear(&fit);
}

#define IN_FOLDER(name)                                                                            \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        IN_FOLDER(test_fit_defaults_choose_all_that_target_density_and_temperature_leave),
        IN_FOLDER(test_fit_defaults_ask_of_types_what_samples_of_all_beads_tell),
        IN_FOLDER(test_fit_defaults_stand_in_used_json),
        IN_FOLDER(test_fit_defaults_leave_what_the_file_says),
        IN_FOLDER(test_fit_defaults_choose_samples_for_the_simulations_that_the_file_says),
        IN_FOLDER(test_fit_defaults_choose_no_more_samples_than_needed_where_they_are_dear),
        IN_FOLDER(test_fit_defaults_choose_friction_and_time_step_beside_a_method),
        IN_FOLDER(test_fit_defaults_choose_how_many_beads_beside_a_method),
        IN_FOLDER(test_fit_defaults_choose_no_count_beside_a_file_of_places),
        IN_FOLDER(test_fit_defaults_cut_the_steps_of_pairs_for_bonds),
        IN_FOLDER(test_fit_defaults_sample_molecules_in_half_of_the_scene_or_all),
        IN_FOLDER(test_fit_defaults_sample_a_long_box_that_holds_the_range),
        IN_FOLDER(test_fit_defaults_know_a_bond_by_coarse_bins),
        IN_FOLDER(test_fit_defaults_choose_time_steps_by_the_friction_without_velocities),
        IN_FOLDER(test_fit_defaults_choose_no_friction_where_that_across_pairs_is_found),
        IN_FOLDER(test_fit_defaults_cut_g_at_half_of_a_box_that_is_given),
        IN_FOLDER(test_fit_defaults_choose_a_method_beside_its_parameters),
        IN_FOLDER(test_fit_defaults_join_fine_rows_and_end_g_with_its_structure),
        IN_FOLDER(test_fit_defaults_end_g_of_water_behind_its_third_layer),
        IN_FOLDER(test_fit_defaults_find_omega_where_targets_move),
        IN_FOLDER(test_fit_defaults_choose_nothing_that_the_reader_refuses),
        IN_FOLDER(test_fit_defaults_tell_faults_once_and_only_what_is_missing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
