// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit simulate` by Monte Carlo from outside: the same bits again, what its summary tells, and
// what it refuses.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/small_scenes.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define BY_MONTE_CARLO "\"dynamics\": {\"integrator\": \"monte-carlo\"}"

/// Chains with single beads; so many that two threads share the passes over them.
static const char scene[] =
    "{\"seed\": 3, \"box\": [8, 8, 8],\n"
    "\"bonds\": {\"backbone\": {\"law\": \"harmonic\", \"k\": 100, \"length\": 0.8}},\n"
    "\"angles\": {\"bend\": {\"law\": \"harmonic\", \"k\": 20, \"angle\": 120}},\n"
    "\"dihedrals\": {\"twist\": {\"law\": \"periodic\", \"k\": 1, \"multiplicity\": 3}},\n"
    "\"molecules\": {\"chain\": {\"count\": 150, \"chain\": {\"beads\": [\"A\", \"B\", \"B\", "
    "\"A\"],\n"
    "  \"bond\": \"backbone\", \"angle\": \"bend\", \"dihedral\": \"twist\"}}},\n"
    "\"particles\": {\"types\": {\"W\": 500}, \"mass\": {\"A\": 2, \"B\": 1, \"W\": 1}},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\"},\n"
    "\"dynamics\": {\"integrator\": \"monte-carlo\"},\n"
    "\"rdf\": {\"range\": 2, \"bins\": 20}, \"intermolecular_rdf\": {\"range\": 2, \"bins\": 20},\n"
    "\"bond_lengths\": {}, \"bond_angles\": {}, \"dihedral_angles\": {}, \"molecule_sizes\": {},\n"
    "\"structure_factor\": {\"q_maximum\": 3},\n"
    "\"snapshots\": {\"every\": 17, \"formats\": [\"extxyz\", \"lammps-dump\"]},\n"
    "\"measure\": {\"equilibration\": 150, \"samples\": 30, \"every\": 5}}\n";

static const char *const tables[] = {"thermodynamics.tsv",
                                     "rdf_A-A.tsv",
                                     "rdf_W-A.tsv",
                                     "bond_lengths.tsv",
                                     "bond_angles.tsv",
                                     "end_to_end.tsv",
                                     "dihedral_angles.tsv",
                                     "molecule_sizes.tsv",
                                     "intermolecular_rdf_A-A.tsv",
                                     "structure_factor.tsv",
                                     "configuration.tsv",
                                     "used.json",
                                     NULL};

/// Those of beads first, then those of molecules.
static const char *const acceptances[] = {"acceptance_beads", "acceptance_translate",
                                          "acceptance_rotate", "acceptance_pivot", NULL};

static void simulate(const char *file, const char *out, const char *threads) {
    static struct run_program_result result;
    RUN_PROGRAM(&result, "simulate", file, "-o", out, "--threads", threads);
    run_program_assert_code(&result, 0);
}

static void test_monte_carlo_has_the_same_bits_with_threads_and_from_used_settings(void **state) {
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    simulate("scene.json", "one", "1");
    simulate("scene.json", "two", "2");
    results_assert_same("one", "two", tables);
    simulate("one/used.json", "again", "1");
    results_assert_same("one", "again", tables);
}

static void check_pieces(struct temporary_folder *folder, const char *text, const char *from,
                         const char *to, const char *const *expected) {
    static const char *const words[] = {"simulate", "scene.json", "-o", "pieces", NULL};
    small_inputs_write(folder, "scene.json", text, from, to);
    simulate("scene.json", "whole", "1");
    run_program_in_pieces(0, words);
    results_assert_same("whole", "pieces", expected);
    for (size_t k = 0; acceptances[k] && (expected == tables || k == 0); k++)
        results_assert_number("pieces/summary.json", acceptances[k],
                              results_number("whole/summary.json", acceptances[k]));
}

static void test_interrupted_monte_carlo_goes_on_with_the_same_bits(void **state) {
    check_pieces(*state, scene, NULL, NULL, tables);
}

/// No molecules, and potentials of three kinds.
static void test_interrupted_monte_carlo_of_a_mixture_goes_on_with_the_same_bits(void **state) {
    check_pieces(*state, small_scenes_mixture,
                 "\"dissipative\": {\"law\": \"power\", \"sigma\": 2.1213}", BY_MONTE_CARLO,
                 small_scenes_mixture_tables);
}

/// Frames of extended XYZ: beads in the order of their ids, eight of each chain.
static void check_chains_are_whole(const char *file, int chains, double edge) {
    enum { BEADS = 8 };
    FILE *stream = fopen(file, "r");
    assert_non_null(stream);
    char line[1024];
    int frames = 0;
    for (; fgets(line, sizeof line, stream); frames++) {
        double before[3] = {0};
        assert_int_equal(atoi(line), chains * BEADS);
        assert_non_null(fgets(line, sizeof line, stream));
        for (int bead = 0; bead < chains * BEADS; bead++) {
            double at[3], bond = 0;
            long image[3];
            assert_non_null(fgets(line, sizeof line, stream));
            assert_int_equal(sscanf(line, "X %lf %lf %lf %ld %ld %ld", &at[0], &at[1], &at[2],
                                    &image[0], &image[1], &image[2]),
                             6);
            for (int d = 0; d < 3; d++) {
                at[d] += edge * (double)image[d];
                bond += (at[d] - before[d]) * (at[d] - before[d]);
                before[d] = at[d];
            }
            assert_true(bead % BEADS == 0 || bond < 4);
        }
    }
    assert_true(frames > 3);
    fclose(stream);
}

/// Beads that leave the box are told in the image where their chain is.
static void test_chains_that_leave_the_box_stay_whole(void **state) {
    static const char chains[] =
        "{\"seed\": 5, \"box\": [5, 5, 5],\n"
        "\"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 20, \"length\": 0.7}},\n"
        "\"molecules\": {\"chain\": {\"count\": 45, \"exclude\": 0,\n"
        "  \"chain\": {\"type\": \"A\", \"length\": 8, \"bond\": \"spring\"}}},\n"
        "\"conservative\": {\"law\": \"soft-repulsion\"},\n"
        "\"rdf\": {\"range\": 2, \"bins\": 20},\n"
        "\"snapshots\": {\"every\": 40, \"formats\": [\"extxyz\"]},\n" BY_MONTE_CARLO ",\n"
        "\"measure\": {\"equilibration\": 200, \"samples\": 40, \"every\": 10}}\n";
    small_inputs_write(*state, "scene.json", chains, NULL, NULL);
    simulate("scene.json", "whole", "1");
    check_chains_are_whole("whole/snapshots/trajectory.extxyz", 45, 5);
}

/// Each shift of a free dimer is accepted. Beads alone feel the bond: their moves are tuned to 40
/// %.
static void test_the_summary_tells_how_many_moves_were_accepted(void **state) {
    static const char dimers[] =
        "{\"seed\": 4, \"box\": [9, 9, 9], \"particles\": {\"types\": {\"W\": 2}},\n"
        "\"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 1000, \"length\": 0.8}},\n"
        "\"molecules\": {\"dimer\": {\"count\": 200, \"chain\": {\"beads\": [\"A\", \"A\"],\n"
        "  \"bond\": \"spring\"}}}, \"bond_lengths\": {},\n" BY_MONTE_CARLO ",\n"
        "\"measure\": {\"equilibration\": 300, \"samples\": 30, \"every\": 3}}\n";
    small_inputs_write(*state, "scene.json", dimers, NULL, NULL);
    simulate("scene.json", "out", "1");
    const double beads = results_number("out/summary.json", "acceptance_beads");
    if (!(fabs(beads - 0.4) < 0.05))
        fail_msg("acceptance_beads: %g", beads);
    assert_true(results_number("out/summary.json", "acceptance_translate") > 0.999);
    results_assert_numbers("out/summary.json", acceptances);
}

/// With its key, nothing written.
static void test_monte_carlo_refuses_what_it_does_not_know(void **state) {
    static struct run_program_result result;
    static const struct {
        const char *key, *add;
    } refused[] = {
        {"motion", "\"motion\": {}"},
        {"etd", "\"etd\": {\"r_maximum\": 1.5}"},
        {"force_covariance", "\"force_covariance\": {}"},
        {"shear_viscosity", "\"shear_viscosity\": {}"},
        {"molecule_motion", "\"molecule_motion\": {}"},
        {"precision", "\"precision\": \"double\""},
        {"dissipative", "\"dissipative\": {\"law\": \"power\"}"},
        {"interactions.harmonic-trap",
         "\"interactions\": {\"harmonic-trap\": {\"stiffness\": [1, 1, 1]}}"},
        {"temperature", "\"temperature\": 0"},
    };
    for (size_t k = 0; k < sizeof refused / sizeof *refused; k++) {
        char to[256];
        snprintf(to, sizeof to, "\"seed\": 3, %s", refused[k].add);
        small_inputs_write(*state, "scene.json", scene, "\"seed\": 3", to);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "refused");
        run_program_assert_refused(&result, ".", refused[k].key, 1,
                                   (const char *const[]){refused[k].key, NULL});
    }
}

/// Its moves would have no energies to be judged by.
static void test_a_bond_that_is_torn_at_the_start_is_refused(void **state) {
    static struct run_program_result result;
    static const char dimer[] =
        "{\"box\": [8, 8, 8], \"bonds\": {\"rope\": {\"law\": \"fene\", \"k\": 5}},\n"
        "\"molecules\": {\"dimer\": {\"count\": 1, \"chain\": {\"beads\": [\"A\", \"A\"],\n"
        "  \"bond\": \"rope\"}}}, \"bond_lengths\": {},\n"
        "\"particles\": {\"placement\": \"file\", \"file\": \"start.tsv\"},\n" BY_MONTE_CARLO "}\n";
    static const char start[] = "1 1 1\n1 1 4\n";
    temporary_folder_write(*state, "start.tsv", start, strlen(start));
    small_inputs_write(*state, "scene.json", dimer, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "refused");
    run_program_assert_refused(&result, ".", "torn", 1,
                               (const char *const[]){"start.tsv: the bond of atoms 1 and 2", NULL});
}

/// Figures, too, are of sweeps, also where a scene has units beside.
static void test_tables_and_figures_count_sweeps_in_the_place_of_times(void **state) {
    static struct run_program_result result;
    char head[512];
    small_inputs_need_gnuplot();
    small_scenes_write(*state, small_scenes_dpd,
                       "\"dissipative\": {\"law\": \"power\", \"sigma\": 2.1213}", BY_MONTE_CARLO);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--quiet");
    run_program_assert_code(&result, 0);
    assert_string_equal(result.err, "");
    results_assert_table("out/thermodynamics.tsv", 8, 20);
    FILE *table = fopen("out/thermodynamics.tsv", "r");
    assert_non_null(fgets(head, sizeof head, table));
    fclose(table);
    assert_contains(head, "sweeps[1]");
    assert_null(strstr(head, "time"));
    assert_true(temporary_folder_exists("out/figures/simulation.png"));
}

static void test_a_target_of_time_is_refused_in_a_scene_by_monte_carlo(void **state) {
    static struct run_program_result result;
    static const char msd[] = "0 0 0.1\n0.1 0.2 0.1\n0.2 0.4 0.1\n0.3 0.6 0.1\n0.4 0.8 0.1\n";
    temporary_folder_write(*state, "target.tsv", small_inputs_target, strlen(small_inputs_target));
    temporary_folder_write(*state, "msd.tsv", msd, strlen(msd));
    static const char run[] =
        "{\"target\": {\"rdf\": {\"file\": \"target.tsv\"}, \"msd\": {\"file\": \"msd.tsv\"}},\n"
        "\"scene\": {\"particles\": {\"count\": 81}, \"time_step\": 0.02,\n" BY_MONTE_CARLO
        ", \"box\": [3, 3, 3]},\n"
        "\"method\": {\"name\": \"genetic\", \"samples\": 100}}\n";
    temporary_folder_write(*state, "run.json", run, strlen(run));
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "refused");
    run_program_assert_refused(&result, ".", "msd", 1, (const char *const[]){"target.msd", NULL});
}

/// The verification of a fit is by dynamics, unless its scene asks for moves.
static void test_a_fit_is_verified_by_monte_carlo_when_its_scene_says_so(void **state) {
    static struct run_program_result result;
    temporary_folder_write(*state, "target.tsv", small_inputs_target, strlen(small_inputs_target));
    small_inputs_write(*state, "run.json", small_inputs_run,
                       "\"dissipative\": {\"law\": \"power\", \"sigma\": 2}", BY_MONTE_CARLO);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out");
    if (result.code != 0 && result.code != 1)
        run_program_assert_code(&result, 0);
    results_assert_numbers(
        "out/summary.json",
        (const char *const[]){"rdf_rmse", "pressure", "temperature_configurational", NULL});
}

#define TEST_WITHOUT_FIGURES(name)                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

/// Sweeps are no steps.
static void test_explanation_counts_sweeps(void **state) {
    static struct run_program_result result;
    static const char chains[] =
        "{\"box\": [8, 8, 8], \"time_step\": 0.005,\n"
        "\"bonds\": {\"backbone\": {\"law\": \"harmonic\", \"k\": 100, \"length\": 0.8}},\n"
        "\"molecules\": {\n"
        "\"short\": {\"count\": 9, \"chain\": {\"type\": \"A\", \"length\": 4, \"bond\": "
        "\"backbone\"}}},\n"
        "\"conservative\": {\"law\": \"soft-repulsion\"}%s,\n"
        "\"rdf\": {\"range\": 2, \"bins\": 20}, \"measure\": {\"samples\": 30, \"every\": 5}}\n";
    char text[2048];
    snprintf(text, sizeof text, chains, ", " BY_MONTE_CARLO);
    small_inputs_write(*state, "chains.json", text, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "chains.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, " sweeps/s ");
    assert_contains(result.out, "one of each in a sweep: shifted, turned, or an arm of it\n");
    snprintf(text, sizeof text, chains, "");
    small_inputs_write(*state, "moved.json", text, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "moved.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, " steps/s ");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST_WITHOUT_FIGURES(
            test_monte_carlo_has_the_same_bits_with_threads_and_from_used_settings),
        TEST_WITHOUT_FIGURES(test_interrupted_monte_carlo_goes_on_with_the_same_bits),
        TEST_WITHOUT_FIGURES(test_interrupted_monte_carlo_of_a_mixture_goes_on_with_the_same_bits),
        TEST_WITHOUT_FIGURES(test_chains_that_leave_the_box_stay_whole),
        TEST_WITHOUT_FIGURES(test_explanation_counts_sweeps),
        TEST_WITHOUT_FIGURES(test_the_summary_tells_how_many_moves_were_accepted),
        TEST_WITHOUT_FIGURES(test_monte_carlo_refuses_what_it_does_not_know),
        TEST_WITHOUT_FIGURES(test_a_bond_that_is_torn_at_the_start_is_refused),
        cmocka_unit_test_setup_teardown(test_tables_and_figures_count_sweeps_in_the_place_of_times,
                                        small_inputs_enter, small_inputs_leave),
        TEST_WITHOUT_FIGURES(test_a_target_of_time_is_refused_in_a_scene_by_monte_carlo),
        TEST_WITHOUT_FIGURES(test_a_fit_is_verified_by_monte_carlo_when_its_scene_says_so),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
