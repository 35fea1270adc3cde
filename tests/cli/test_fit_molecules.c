// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fits of molecules from outside: all potentials of a three-bead chain at once from what a
// simulation of known ones has measured, the same bits again, and files that cannot be right.
#include "io/data_table.h"

#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MOLECULES                                                                                  \
    "\"molecules\": {\"trimer\": {\"count\": 80, \"chain\": {\"beads\": [\"A\", \"B\", \"A\"],\n"  \
    "  \"bond\": \"backbone\", \"angle\": \"bend\"}}}"
#define FRICTION "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}"

/// The truth.
static const char scene[] =
    "{\"seed\": 11, \"box\": [4.4, 4.4, 4.4], \"time_step\": 0.005,\n"
    "\"bonds\": {\"backbone\": {\"law\": \"harmonic\", \"k\": 100, \"length\": 0.6}},\n"
    "\"angles\": {\"bend\": {\"law\": \"harmonic\", \"k\": 12, \"angle\": 110}},\n" MOLECULES ",\n"
    "\"conservative\": {\"A-A\": {\"law\": \"soft-repulsion\", \"a\": 20},\n"
    "  \"A-B\": {\"law\": \"soft-repulsion\", \"a\": 12},\n"
    "  \"B-B\": {\"law\": \"soft-repulsion\", \"a\": 25}},\n" FRICTION ",\n"
    "\"rdf\": {\"range\": 1.2, \"bins\": 24}, \"bond_lengths\": {\"bins\": 60},\n"
    "\"bond_angles\": {\"bins\": 45},\n"
    "\"measure\": {\"equilibration\": 2000, \"samples\": 400, \"every\": 25}}\n";

static const char run[] =
    "{\"seed\": 2, \"target\": {\"rdf\": {\"A-A\": {\"file\": \"truth/rdf_A-A.tsv\"},\n"
    "  \"A-B\": {\"file\": \"truth/rdf_A-B.tsv\"}, \"B-B\": {\"file\": \"truth/rdf_B-B.tsv\"}},\n"
    " \"bond_lengths\": {\"backbone\": {\"file\": \"truth/bond_lengths.tsv\"}},\n"
    " \"bond_angles\": {\"bend\": {\"file\": \"truth/bond_angles.tsv\"}}},\n"
    "\"scene\": {\"box\": [4.4, 4.4, 4.4], \"time_step\": 0.005,\n" MOLECULES ", " FRICTION "},\n"
    "\"method\": {\"name\": \"imc\", \"replicas\": 2, \"equilibration\": 40, \"samples\": 60,\n"
    "  \"iterations\": 4, \"precision\": 0.02},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 500, \"samples\": 60, \"every\": "
    "25}}\n";

static int enter(void **state) {
    if (small_inputs_enter_without_gnuplot(state) != 0)
        return -1;
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    twins_simulate("scene.json", "truth");
    return 0;
}

static const char *const tables[] = {"potential_A-A.tsv",
                                     "potential_A-B.tsv",
                                     "bonds_backbone.tsv",
                                     "angles_bend.tsv",
                                     "bonds_backbone_history.tsv",
                                     "bond_lengths_backbone.tsv",
                                     "bond_angles_bend.tsv",
                                     "now_bond_lengths_backbone.tsv",
                                     "now_bond_angles_bend.tsv",
                                     "history.tsv",
                                     NULL};

/// Threads, an interruption and the written file change no bits.
static void fit_again(struct temporary_folder *folder, const char *from, const char *to) {
    static struct run_program_result result;
    small_inputs_write(folder, "run.json", run, from, to);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "one", "--threads", "1", "--force");
    assert_true(result.code == 0 || result.code == 1);
    RUN_PROGRAM(&result, "fit", "one/used.json", "-o", "two", "--threads", "2", "--force");
    assert_true(result.code == 0 || result.code == 1);
    run_program_in_pieces(result.code,
                          (const char *const[]){"fit", "run.json", "-o", "three", NULL});
    results_assert_same("one", "two", tables);
    results_assert_same("one", "three", tables);
}

/// Whatever the sampler; both find much the same.
static void test_fit_molecules_again_with_the_same_bits(void **state) {
    static const char *const samplers[] = {"dynamics", "monte-carlo"};
    for (int k = 0; k < 2; k++) {
        char method[64];
        snprintf(method, sizeof method, "\"imc\", \"sampler\": \"%s\"", samplers[k]);
        fit_again(*state, "\"imc\"", method);
        results_assert_text("one/used.json", "method.sampler", samplers[k]);
        assert_true(results_number("one/summary.json", "rdf_rmse") < 0.05);
    }
}

/// Sweeps of both replicas, as history.tsv counts them; single moves are not known.
static void test_fit_molecules_explains_what_the_last_iterations_take(void **state) {
    static struct run_program_result result;
    static const char words[] = "within 0.02, takes about ";
    struct data_table table;
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    const char *told = strstr(result.out, words);
    assert_non_null(told);
    assert_contains(told, "long molecules take up to ten times as many");
    const double sweeps = strtod(told + strlen(words), NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force", "--quiet");
    assert_ok(mf_data_table_read(&table, "out/history.tsv", 2));
    const size_t column = mf_data_table_find(&table, "engine_steps") - 1;
    const double *last = table.values + table.columns * (table.rows - 1) + column;
    const double taken = last[0] - last[-(ptrdiff_t)table.columns];
    mf_data_table_clear(&table);
    assert_true(taken > sweeps / 3 && taken < 3 * sweeps);
    small_inputs_write(*state, "run.json", run, "\"imc\"", "\"imc\", \"sampler\": \"monte-carlo\"");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    assert_null(strstr(result.out, "takes about"));
}

/// All bonds are in the bins: ∫ p dq = 1, of 160 bonds and 80 angles, and S − S* is their share.
static void test_fit_molecules_shows_lengths_and_angles_of_its_samples(void **state) {
    static struct run_program_result result;
    static const struct {
        const char *now, *verified;
        double terms;
    } group[] = {{"out/now_bond_lengths_backbone.tsv", "out/bond_lengths_backbone.tsv", 160},
                 {"out/now_bond_angles_bend.tsv", "out/bond_angles_bend.tsv", 80}};
    small_inputs_write(*state, "run.json", run, "\"iterations\": 4", "\"iterations\": 1");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force");
    for (int g = 0; g < 2; g++) {
        struct data_table now, verified;
        assert_ok(mf_data_table_read(&now, group[g].now, 1));
        assert_ok(mf_data_table_read(&verified, group[g].verified, 1));
        assert_int_equal(now.rows, verified.rows);
        double sum = 0;
        for (size_t k = 0; k < now.rows; k++) {
            const double *row = now.values + k * now.columns;
            const double width = now.values[now.columns] - now.values[0];
            assert_close(row[0], verified.values[k * verified.columns], 1e-9);
            assert_close(row[1], verified.values[k * verified.columns + 1], 1e-6);
            assert_close(row[4], group[g].terms * width * (row[2] - row[1]), 1e-3);
            sum += width * row[2];
        }
        assert_close(sum, 1, 1e-3);
        mf_data_table_clear(&now);
        mf_data_table_clear(&verified);
    }
}

static void test_fit_by_relative_entropy_again_with_the_same_bits(void **state) {
    fit_again(*state, "\"imc\"", "\"relative-entropy\"");
}

/// Three coefficients do not make g(r), nor one a bond's p: it has converged, and its
/// summary says how far the bond is off.
static void test_fit_by_relative_entropy_tells_what_its_form_does_not_meet(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "run.json", run, "\"imc\", \"replicas\": 2",
                       "\"relative-entropy\", \"coefficients\": 3, \"group_coefficients\": 1, "
                       "\"replicas\": 4");
    char *text = temporary_folder_read("run.json");
    small_inputs_write(*state, "run.json", text, "\"samples\": 60,\n  \"iterations\": 4",
                       "\"samples\": 150,\n  \"iterations\": 16");
    free(text);
    text = temporary_folder_read("run.json");
    small_inputs_write(*state, "run.json", text, "\"precision\": 0.02", "\"precision\": 0.01");
    free(text);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "found");
    run_program_assert_code(&result, 0);
    results_assert_text("found/summary.json", "status", "converged");
    assert_true(results_number("found/summary.json", "bond_lengths_rmse") >
                10 * results_number("found/summary.json", "bond_lengths_noise"));
}

/// The numbers after a section's name in a file of tables, up to the next name.
static size_t read_section(const char *file, const char *name, double *numbers, size_t max) {
    char line[512];
    size_t count = 0;
    bool inside = false;
    FILE *stream = fopen(file, "r");
    assert_non_null(stream);
    while (fgets(line, sizeof line, stream) && count + 4 <= max) {
        double number[4];
        if (isalpha((unsigned char)line[0]) && line[0] != 'N')
            inside = strncmp(line, name, strlen(name)) == 0;
        else if (inside &&
                 sscanf(line, "%lf %lf %lf %lf", number, number + 1, number + 2, number + 3) == 4) {
            memcpy(numbers + count, number, sizeof number);
            count += 4;
        }
    }
    fclose(stream);
    return count;
}

/// A fit is exported with the laws of the scene that its tables make.
static void check_exports(void) {
    enum { MAX = 200000 };
    static struct run_program_result result;
    static double of_fit[MAX], of_scene[MAX];
    RUN_PROGRAM(&result, "export", "found", "--engine", "lammps", "-o", "lammps_found");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "export", "again", "--engine", "lammps", "-o", "lammps_again");
    run_program_assert_code(&result, 0);
    static const char *const sections[] = {"BOND_backbone", "ANGLE_bend", "PHI_A-A"};
    for (size_t k = 0; k < sizeof sections / sizeof *sections; k++) {
        const size_t count = read_section("lammps_found/mesofit.table", sections[k], of_fit, MAX);
        assert_true(count > 100);
        assert_int_equal(read_section("lammps_again/mesofit.table", sections[k], of_scene, MAX),
                         count);
        for (size_t n = 0; n < count; n++)
            assert_close(of_fit[n], of_scene[n], 1e-6 * (1 + fabs(of_scene[n])));
    }
}

/// What is found can be simulated: its tables are the scene's laws.
static void test_fit_molecules_result_runs_as_a_scene(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "found");
    assert_true(result.code == 0 || result.code == 1);
    const char again[] =
        "{\"seed\": 5, \"box\": [4.4, 4.4, 4.4], \"time_step\": 0.005,\n"
        "\"bonds\": {\"backbone\": {\"law\": \"table\", \"file\": \"found/bonds_backbone.tsv\"}},\n"
        "\"angles\": {\"bend\": {\"law\": \"table\", \"file\": "
        "\"found/angles_bend.tsv\"}},\n" MOLECULES ",\n"
        "\"conservative\": {\"A-A\": {\"law\": \"table\", \"file\": \"found/potential_A-A.tsv\"},\n"
        "  \"A-B\": {\"law\": \"table\", \"file\": \"found/potential_A-B.tsv\"},\n"
        "  \"B-B\": {\"law\": \"table\", \"file\": \"found/potential_B-B.tsv\"}},\n" FRICTION ",\n"
        "\"measure\": {\"equilibration\": 200, \"samples\": 40, \"every\": 25}}\n";
    small_inputs_write(*state, "again.json", again, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "again.json", "-o", "again");
    run_program_assert_code(&result, 0);
    check_exports();
}

/// A group with a law is known; its target is compared with the result.
static void test_fit_molecules_leaves_known_laws_alone(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "run.json", run, "\"scene\": {",
                       "\"scene\": {\"bonds\": {\"backbone\": {\"law\": \"harmonic\", \"k\": "
                       "100, \"length\": 0.6}}, ");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "known");
    assert_true(result.code == 0 || result.code == 1);
    assert_int_equal(access("known/bond_lengths_backbone.tsv", F_OK), 0);
    assert_int_not_equal(access("known/bonds_backbone.tsv", F_OK), 0);
    assert_int_equal(access("known/angles_bend.tsv", F_OK), 0);
    // The true bond in a liquid that is nearly the true one.
    const double rmse = results_number("known/summary.json", "bond_lengths_rmse");
    assert_true(rmse < 10 * results_number("known/summary.json", "bond_lengths_noise"));
}

/// A Verlet step makes the variance of a harmonic length too large by (ω Δt)²/4, ω² = 2 k/m: 0.003
/// with k = 10⁵ at Δt = 0.000245, and one digit of that is taken. With aboba, the default, a
/// tenth instead of a quarter is reckoned with, and 0.00039 is allowed.
static void test_fit_molecules_default_time_step_knows_stiff_laws(void **state) {
    static const char stiff[] =
        "{\"target\": {\"rdf\": {\"A-A\": {\"file\": \"truth/rdf_A-A.tsv\"},\n"
        "  \"A-B\": {\"file\": \"truth/rdf_A-B.tsv\"}, \"B-B\": {\"file\": "
        "\"truth/rdf_B-B.tsv\"}},\n"
        " \"bond_angles\": {\"bend\": {\"file\": \"truth/bond_angles.tsv\"}}},\n"
        "\"scene\": {\"box\": [4.4, 4.4, 4.4],\n"
        " \"bonds\": {\"backbone\": {\"law\": \"harmonic\", \"k\": 1e5, \"length\": "
        "0.6}},\n" MOLECULES "}}\n";
    static struct run_program_result result;
    small_inputs_write(*state, "run.json", stiff, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    // ω = sqrt(2 k/m) = 447: a tenth of the step is 0.09/ω, by which Verlet's variance is 0.2 %
    // off.
    assert_contains(result.out, "time step 0.002 tau, in which bonds, angles and dihedrals take "
                                "10");
    small_inputs_write(*state, "run.json", stiff, "\"box\"",
                       "\"dynamics\": {\"integrator\": \"aboba\"}, " FRICTION ", \"box\"");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "time step 0.0003 tau");
    small_inputs_write(*state, "run.json", stiff, "\"box\"",
                       "\"dynamics\": {\"integrator\": \"dpd-verlet\"}, " FRICTION ", \"box\"");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "time step 0.0002 tau");
}

/// A method beside them changes nothing of what molecules need for their verification.
static void test_fit_molecules_with_a_method_has_friction_and_a_verification(void **state) {
    static struct run_program_result result;
    static const char *const chosen[] = {"chosen: time step ",
                                         "chosen: friction omega = ", "chosen: verification: "};
    small_inputs_write(*state, "run.json", run, ", " FRICTION, "");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, chosen[1]);
    assert_null(strstr(result.out, chosen[0]));
    assert_null(strstr(result.out, chosen[2]));
    small_inputs_write(*state, "run.json", run, "\"time_step\": 0.005,", "");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    assert_contains(result.out, chosen[0]);
    assert_null(strstr(result.out, chosen[1]));
    // A time step of its own leaves the rest of the verification to be chosen, as if there were
    // none.
    for (int k = 0; k < 2; k++) {
        small_inputs_write(*state, "run.json", run,
                           "\"verification\": {\"replicas\": 2, "
                           "\"equilibration\": 500, \"samples\": 60, "
                           "\"every\": 25}",
                           k ? "\"verification\": {\"time_step\": 0.0025}"
                             : "\"verification\": {}");
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        assert_contains(result.out, chosen[2]);
    }
}

/// Bonds of k = 100 and mass 1: Ω² = 200, so that a Verlet step of 0.04 adds 8 % to their variance,
/// and 0.005, or aboba, hardly anything.
static void test_fit_warns_of_steps_too_long_for_bonds(void **state) {
    static const struct {
        const char *step, *word;
    } steps[] = {
        {"\"dynamics\": {\"integrator\": \"dpd-verlet\"}, \"time_step\": 0.04", "wrong by 8 %"},
        {"\"time_step\": 0.2", "blow up"}};
    static const char *const fine[] = {"\"time_step\": 0.005", "\"time_step\": 0.04"};
    static struct run_program_result result;
    for (size_t k = 0; k < 2; k++) {
        small_inputs_write(*state, "run.json", run, "\"time_step\": 0.005", fine[k]);
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        assert_null(strstr(result.out, "time_step"));
    }
    for (size_t k = 0; k < 2; k++) {
        small_inputs_write(*state, "run.json", run, "\"time_step\": 0.005", steps[k].step);
        RUN_PROGRAM(&result, "fit", "run.json", "--explain");
        run_program_assert_code(&result, 0);
        assert_contains(result.out, "warning: scene.time_step: with 0.");
        assert_contains(result.out, steps[k].word);
    }
}

struct wrong {
    const char *from, *to, *words[3];
};

/// Of chains of five beads, stretched out with the range of g(r): 4 · 0.6 + 1.2; chains of
/// nine, 6.0 long, may do so in the scene of 4.4, and not in less.
static void test_fit_molecules_refuses_a_box_in_which_they_meet_themselves(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "run.json", run, "[\"A\", \"B\", \"A\"]",
                       "[\"A\", \"B\", \"A\", \"A\", \"B\"]");
    small_inputs_change(*state, "run.json", "\"count\": 80", "\"count\": 48");
    small_inputs_change(*state, "run.json", "\"imc\"", "\"imc\", \"particles\": 110");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "refused");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "method.particles: 110 make a box whose shortest edge, 3.39");
    assert_contains(result.err, "is below what keeps a molecule apart from its own image, 3.5");
    assert_contains(result.err, "are the least");
    small_inputs_write(*state, "run.json", run, "[\"A\", \"B\", \"A\"]",
                       "[\"A\", \"B\", \"A\", \"A\", \"B\", \"A\", \"A\", \"B\", \"A\"]");
    small_inputs_change(*state, "run.json", "\"count\": 80", "\"count\": 30");
    small_inputs_change(*state, "run.json", "\"imc\"", "\"imc\", \"particles\": 200");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "refused");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "is below that of the scene, in which a molecule may already meet "
                                "its own image, 4.4; 270 are the least");
    small_inputs_change(*state, "run.json", "\"particles\": 200", "\"particles\": 270");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
}

static void test_fit_molecules_refuses_what_cannot_be(void **state) {
    static const struct wrong wrong[] = {
        {"\"imc\"", "\"hnc\"", {"method.name: \"hnc\" does not fit molecules", NULL}},
        {"\"name\": \"imc\", \"replicas\": 2, \"equilibration\": 40, \"samples\": 60,\n"
         "  \"iterations\": 4, \"precision\": 0.02",
         "\"name\": \"formulas\"",
         {"method.name: \"formulas\" does not fit molecules", NULL}},
        {"\"truth/bond_angles.tsv\"",
         "\"truth/bond_lengths.tsv\"",
         {"target.bond_angles.bend.file: ", "as if in radians", NULL}},
        {"\"replicas\": 2, \"equilibration\": 40",
         "\"particles\": 12",
         {"method.particles: 12 make a box whose shortest edge, 1.", "are the least", NULL}},
    };
    static struct run_program_result result;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        small_inputs_write(*state, "run.json", run, wrong[k].from, wrong[k].to);
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "refused");
        run_program_assert_code(&result, 2);
        for (size_t w = 0; wrong[k].words[w]; w++)
            assert_contains(result.err, wrong[k].words[w]);
    }
}

/// Groups and types that the molecules do not have, or that nothing finds: one line for each.
static void test_fit_molecules_tells_a_wrong_name_in_one_line(void **state) {
    static const struct {
        const char *from, *to, *words;
    } wrong[] = {
        {"\"bend\": {\"file\"", "\"bond\": {\"file\"",
         "target.bond_angles.bond: no molecule has such an angle; did you mean \"bend\"?"},
        {"\"bond_lengths\": {",
         "\"bond_lengths\": {\"leg\": {\"file\": \"truth/bond_lengths.tsv\"}, ",
         "run.json: target.bond_lengths.leg: no molecule has such a bond; known: backbone"},
        {",\n \"bond_angles\": {\"bend\": {\"file\": \"truth/bond_angles.tsv\"}}", "",
         "scene.molecules.trimer.chain.angle: \"bend\" has no law in \"scene.angles\" and is not "
         "in \"target.bond_angles\""},
        {"\"method\"",
         "\"unknowns\": {\"potential\": {}, \"bonds\": {\"backbones\": {}}}, \"method\"",
         "unknowns.bonds.backbones: no molecule has such a bond; did you mean \"backbone\"?"},
        {"\"method\"",
         "\"unknowns\": {\"potential\": {}, \"bonds\": {\"backbone\": {}}}, \"method\"",
         "scene.molecules.trimer.chain.angle: \"bend\" has no law in \"scene.angles\" and is not "
         "in \"unknowns.angles\""},
        {"[\"A\", \"B\", \"A\"]", "[\"A\"]",
         "scene.molecules.trimer.chain.bond: a bond is of 2 beads, and the chain has 1"},
        {"[\"A\", \"B\", \"A\"]", "[\"A\", \"A\", \"A\"]",
         "target.rdf.A-A: pairs are named in mixtures, and there is only A; write {\"file\": …}"},
        {"\"A-B\": {\"file\"", "\"A-Q\": {\"file\"",
         "run.json: target.rdf.A-Q: unknown pair; expected A-A, A-B, B-B"},
        {"\"A-B\": {\"file\"", "\"B-A\": {\"file\": \"truth/rdf_A-B.tsv\"}, \"A-B\": {\"file\"",
         "run.json: target.rdf.A-B: duplicate pair, in both orders"},
        {"\"bond_lengths\": {",
         "\"kirkwood_buff\": {\"A-B\": {\"value\": 1, \"error\": 1}}, \"bond_lengths\": {",
         "run.json: target.kirkwood_buff.A-B: pairs are named in mixtures, and there is only "
         "trimer; write {\"value\": …, \"error\": …}"},
    };
    static struct run_program_result result;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        small_inputs_write(*state, "run.json", run, wrong[k].from, wrong[k].to);
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "refused");
        run_program_assert_code(&result, 2);
        assert_int_equal(run_program_lines(result.err), 1);
        assert_contains(result.err, wrong[k].words);
    }
}

/// 37 beads would hold the range, but of 12.3 chains there are 12.
static void test_fit_molecules_names_a_number_that_whole_molecules_make(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "bad.json", run, "[4.4, 4.4, 4.4]", "[4.5, 4.5, 4.5]");
    char *text = temporary_folder_read("bad.json");
    small_inputs_write(*state, "bad.json", text, "\"replicas\": 2, \"equilibration\": 40",
                       "\"particles\": 37");
    free(text);
    RUN_PROGRAM(&result, "fit", "bad.json", "-o", "bad", "--force");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "; 38 are the least");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_fit_molecules_again_with_the_same_bits, enter,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_by_relative_entropy_again_with_the_same_bits,
                                        enter, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_molecules_explains_what_the_last_iterations_take,
                                        enter, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_molecules_shows_lengths_and_angles_of_its_samples,
                                        enter, small_inputs_leave),
        cmocka_unit_test_setup_teardown(
            test_fit_by_relative_entropy_tells_what_its_form_does_not_meet, enter,
            small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_molecules_result_runs_as_a_scene, enter,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_molecules_leaves_known_laws_alone, enter,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_molecules_default_time_step_knows_stiff_laws,
                                        enter, small_inputs_leave),
        cmocka_unit_test_setup_teardown(
            test_fit_molecules_with_a_method_has_friction_and_a_verification, enter,
            small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_warns_of_steps_too_long_for_bonds, enter,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_molecules_names_a_number_that_whole_molecules_make,
                                        enter, small_inputs_leave),
        cmocka_unit_test_setup_teardown(
            test_fit_molecules_refuses_a_box_in_which_they_meet_themselves, enter,
            small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_molecules_refuses_what_cannot_be, enter,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_fit_molecules_tells_a_wrong_name_in_one_line, enter,
                                        small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
