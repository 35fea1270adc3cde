// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fits whose samples another engine makes. The engine is a script that knows mesofit only by what
// it finds in the folder of a piece; it lets `mesofit simulate` move the particles, by DPD, which
// no inversion does by itself. A known potential is found, an interrupted fit has the same bits,
// and what is wrong with an engine is said in one line. LAMMPS, where there is one.
#include "shared/lammps_runs.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#define SETUP                                                                                      \
    "\"box\": [5, 5, 5], \"time_step\": 0.02, \"particles\": {\"count\": 250}, "                   \
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}"

/// The truth.
static const char scene[] =
    "{\"seed\": 3, " SETUP ", \"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"rdf\": {\"range\": 1.2, \"bins\": 30},\n"
    "\"measure\": {\"equilibration\": 500, \"samples\": 400, \"every\": 20}}\n";

#define ENGINE "\"engine\": {\"name\": \"command\", \"frames\": \"frames.extxyz\", \"steps\": 20}"
#define PLAN "\"replicas\": 4, \"samples\": 100, \"precision\": 0.008"
static const char run[] =
    "{\"seed\": 4, \"scene\": {" SETUP "},\n"
    "\"target\": {\"rdf\": {\"file\": \"truth/rdf.tsv\", \"errors_of\": \"samples\"}},\n"
    "\"unknowns\": {\"potential\": {\"truth\": {\"law\": \"soft-repulsion\", \"a\": 25}}},\n"
    "\"verification\": {\"replicas\": 2, \"equilibration\": 300, \"samples\": 100, \"every\": "
    "20},\n" ENGINE ",\n\"method\": {\"name\": \"auto\", " PLAN "}}\n";

/// The other engine. A file "trouble" beside the run file tells it to fail, once.
static const char engine[] =
    "import glob, json, os, subprocess, sys\n"
    "asked = json.load(open('engine.json'))\n"
    "trouble = '../../../../trouble'\n"
    "said = open(trouble).read() if os.path.exists(trouble) else ''\n"
    "if said == 'dies' and asked['piece'] == 2 and asked['replica'] == 3:\n"
    "    os.remove(trouble)\n"
    "    sys.exit('the licence has expired')\n"
    "scene = {'seed': asked['seed'], 'box': asked['box'], 'particles': {'count': 250},\n"
    "    'time_step': 0.005, 'temperature': 1.4 if said == 'hot' else 1,\n"
    "    'conservative': {'law': 'table', 'file': 'potential.tsv'},\n"
    "    'dissipative': {'law': 'power', 'sigma': 3},\n"
    "    'measure': {'equilibration': asked['equilibration'] + 20, 'samples': asked['frames'],\n"
    "                'every': asked['every']},\n"
    "    'snapshots': {'every': asked['every'], 'formats': ['json', 'extxyz']}}\n"
    "if 'before' in asked:\n"
    "    last = sorted(glob.glob(asked['before'] + '/out/snapshots/*.json'))[-1]\n"
    "    scene['particles'].update({'placement': 'file', 'file': last})\n"
    "json.dump(scene, open('scene.json', 'w'))\n"
    "subprocess.run([os.environ['MESOFIT'], 'simulate', 'scene.json', '--quiet', '--threads', '1'],"
    "    env={'PATH': ''})\n"
    "lines = open('out/snapshots/trajectory.extxyz').readlines()[252:]\n" // without the start
    "if said == 'short': lines = lines[:-252]\n"
    "open(asked['trajectory'], 'w').writelines(lines)\n"
    "table = open('out/thermodynamics.tsv').read().splitlines()\n"
    "names = [name.split('[')[0] for name in table[0].strip('# ').split('\\t')]\n"
    "rows = [line.split() for line in table[1:]][-asked['frames']:]\n"
    "def column(name): return [float(row[names.index(name)]) for row in rows]\n"
    "energy = [250 * value + (50 if said == 'energy' else 0) for value in"
    " column('potential_energy')]\n"
    "json.dump({'temperature': column('temperature'), 'pressure': column('pressure')[said == "
    "'numbers':],\n"
    "           'pair_energy': energy}, open('sample.json', 'w'))\n";

#define COMMAND "python3 ../../../../engine.py"

static struct run_program_result result;

static int enter(void **state) {
    if (small_inputs_enter(state) != 0)
        return -1;
    small_inputs_write(*state, "truth.json", scene, NULL, NULL);
    small_inputs_write(*state, "engine.py", engine, NULL, NULL);
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    twins_simulate("truth.json", "truth");
    return 0;
}

/// Few samples, for what does not ask how good a result is.
static void write_coarse(void *state, const char *file) {
    small_inputs_write(state, file, run, PLAN,
                       "\"replicas\": 4, \"equilibration\": 10, \"samples\": 30, \"precision\": "
                       "0.1, \"iterations\": 2");
    small_inputs_change(state, file, "\"equilibration\": 300, \"samples\": 100",
                        "\"equilibration\": 40, \"samples\": 10");
}

static bool is_there(const char *path) {
    struct stat found;
    return stat(path, &found) == 0;
}

static void test_a_known_potential_is_found(void **state) {
    (void)state;
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--engine", COMMAND);
    run_program_assert_code(&result, 0);
    const double ramp = results_number("out/summary.json", "truth_ramp");
    const double error = results_number("out/summary.json", "ramp_error");
    print_message("ramp %.3f +- %.3f\n", ramp, error);
    assert_true(fabs(ramp) < 5 * error);
    assert_true(results_number("out/summary.json", "truth_rms_without_ramp") < 0.15);
    assert_true(results_number("out/summary.json", "rdf_rmse") < 0.02);
    // The engine verified it, too, and said at which temperature.
    assert_in_range(1000 * results_number("out/summary.json", "temperature"), 950, 1050);
    assert_true(is_there("out/engine/verification/01/engine.json"));
    // The last two pieces of each replica stay.
    int pieces = 0;
    for (int n = 1; n < 100; n++) {
        char path[64];
        snprintf(path, sizeof path, "out/engine/%04d/01", n);
        pieces += is_there(path);
    }
    assert_int_equal(pieces, 2);
}

static void test_a_fit_whose_engine_died_goes_on_with_the_same_bits(void **state) {
    static const char *const same[] = {"potential.tsv", "rdf.tsv", NULL};
    write_coarse(*state, "coarse.json");
    RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "whole", "--engine", COMMAND);
    assert_in_range(result.code, 0, 1);
    temporary_folder_write(*state, "trouble", "dies", 4);
    RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "out", "--engine", COMMAND, "--quiet");
    run_program_assert_code(&result, 2);
    assert_int_equal(run_program_lines(result.err), 1);
    assert_non_null(strstr(result.err, "out/engine/0002/03: the licence has expired"));
    RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "out", "--engine", COMMAND, "--resume");
    assert_in_range(result.code, 0, 1);
    results_assert_same("whole", "out", same);
}

/// A fit of what is left beside a known part of the truth, which is linear in a.
static void write_known(void *state) {
    write_coarse(state, "known.json");
    small_inputs_change(state, "known.json", "\"box\"",
                        "\"known\": {\"law\": \"soft-repulsion\", \"a\": 15}, \"box\"");
    small_inputs_change(state, "known.json", "\"a\": 25", "\"a\": 10");
    small_inputs_change(state, "known.json", "\"iterations\": 2", "\"iterations\": 3");
    small_inputs_change(state, "known.json", "\"samples\": 10", "\"samples\": 40");
}

/// A command that adds the known part by itself is given the rest, and the start is that of it.
static void test_an_engine_that_has_a_known_part_is_given_the_rest(void **state) {
    write_known(*state);
    small_inputs_change(*state, "engine.py", "{'law': 'table', 'file': 'potential.tsv'}",
                        "{'law': 'sum', 'of': {'rest': {'law': 'table', 'file': 'potential.tsv'},"
                        " 'known': {'law': 'soft-repulsion', 'a': 15}}}");
    small_inputs_change(*state, "engine.py", "           'pair_energy': energy}", "           }");
    RUN_PROGRAM(&result, "fit", "known.json", "-o", "out", "--engine", COMMAND);
    assert_in_range(result.code, 0, 1);
    assert_non_null(strstr(result.err, "the engine has it itself, and its tables are of the rest"));
    assert_true(results_number("out/summary.json", "start.error") < 0.2);
    print_message("rms %g\n", results_number("out/summary.json", "rdf_rmse"));
    assert_true(results_number("out/summary.json", "rdf_rmse") < 0.05);
    // By mesofit itself, which adds the known part.
    small_inputs_change(*state, "known.json", "\"replicas\": 2",
                        "\"by\": \"mesofit\", \"replicas\": 2");
    RUN_PROGRAM(&result, "fit", "known.json", "-o", "own", "--engine", COMMAND);
    print_message("rms %g\n", results_number("own/summary.json", "rdf_rmse"));
    assert_true(results_number("own/summary.json", "rdf_rmse") < 0.05);
}

/// An input that mesofit writes has both parts in its tables, as energies of the frames tell.
static void test_a_written_input_has_the_known_part(void **state) {
    lammps_runs_skip_without(NULL);
    write_known(*state);
    small_inputs_change(*state, "known.json", ENGINE,
                        "\"engine\": {\"name\": \"lammps\", \"time_step\": 0.005, \"steps\": "
                        "20}");
    RUN_PROGRAM(&result, "fit", "known.json", "-o", "out", "--engine", "lmp");
    assert_in_range(result.code, 0, 1);
    assert_non_null(strstr(result.err, "the tables of the engine are of both"));
    assert_true(results_number("out/summary.json", "rdf_rmse") < 0.05);
}

/// Whether the fit waits for samples; then they are made, as somebody else would.
static bool sample_what_is_listed(void) {
    struct stat found;
    if (stat("out/engine/waiting", &found) != 0 || found.st_size == 0)
        return false;
    assert_int_equal(system("said=$(while read folder; do sh \"$folder/run.sh\" " COMMAND
                            " 2>&1 || exit 1; done <out/engine/waiting) && [ -z \"$said\" ]"),
                     0);
    return true;
}

static void test_samples_made_later_give_the_same_bits(void **state) {
    static const char *const same[] = {"potential.tsv", "rdf.tsv", NULL};
    write_coarse(*state, "coarse.json");
    RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "whole", "--engine", COMMAND);
    assert_in_range(result.code, 0, 1);
    RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "out", "--engine", "later");
    run_program_assert_code(&result, 0);
    assert_non_null(strstr(result.err, "waits for samples"));
    int rounds = 0;
    for (; sample_what_is_listed(); rounds++)
        RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "out", "--engine", "later", "--resume");
    assert_in_range(rounds, 3, 20); // two iterations and the verification
    results_assert_same("whole", "out", same);
}

/// The job of Slurm, run by a shell: the pieces that were asked for are made by the command.
static void test_a_job_goes_on_with_the_same_bits(void **state) {
    static const char *const same[] = {"potential.tsv", "rdf.tsv", NULL};
    write_coarse(*state, "coarse.json");
    RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "whole", "--engine", COMMAND);
    RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "out", "--engine", "later");
    const int code = system("PATH=\"$(dirname \"$MESOFIT\"):$PATH\" sh out/engine/slurm.sh "
                            "coarse.json '" COMMAND "' >said 2>&1");
    assert_in_range(WEXITSTATUS(code), 0, 1);
    results_assert_same("whole", "out", same);
}

static void test_broken_samples_are_waited_for_again(void **state) {
    static const char *const same[] = {"potential.tsv", "rdf.tsv", NULL};
    write_coarse(*state, "coarse.json");
    RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "whole", "--engine", COMMAND);
    RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "out", "--engine", "later");
    temporary_folder_write(*state, "trouble", "short", 5);
    assert_true(sample_what_is_listed());
    unlink("trouble");
    RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "out", "--engine", "later", "--resume");
    run_program_assert_code(&result, 2);
    for (int rounds = 0; sample_what_is_listed(); rounds++) {
        assert_true(rounds < 20);
        RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "out", "--engine", "later", "--resume");
    }
    results_assert_same("whole", "out", same);
}

static void test_what_is_wrong_with_an_engine_is_said(void **state) {
    static const struct {
        const char *trouble, *word;
        int code;
    } cases[] = {{"energy", "of the same configuration the engine has the energy", 2},
                 {"numbers", "expected a list of 32 numbers, one of each frame, found 31", 2},
                 {"short", "it ends after 31 of the 32 frames", 2},
                 {"hot", "the engine samples at a temperature that is", 1}};
    write_coarse(*state, "coarse.json");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        temporary_folder_write(*state, "trouble", cases[k].trouble, strlen(cases[k].trouble));
        RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "out", "--engine", COMMAND, "--quiet",
                    "--force");
        run_program_assert_code(&result, cases[k].code);
        if (strstr(result.err, cases[k].word) == NULL)
            fail_msg("%s: %s", cases[k].trouble, result.err);
        assert_int_equal(run_program_lines(result.err), 1);
    }
    unlink("trouble");
    assert_int_equal(mkdir("mine", 0777), 0);
    assert_int_equal(mkdir("mine/engine", 0777), 0);
    temporary_folder_write(*state, "mine/engine/script.py", "", 0);
    RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "mine", "--engine", COMMAND, "--quiet");
    run_program_assert_code(&result, 2);
    assert_non_null(strstr(result.err, "mine/engine: a folder of this name is there"));
    assert_true(is_there("mine/engine/script.py"));
    RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "new", "--engine", "no-such-engine",
                "--quiet");
    run_program_assert_code(&result, 2);
    assert_non_null(strstr(result.err, "no-such-engine"));
}

/// The tables of a piece, as `export` writes them for the engine that the command drives.
static void test_tables_in_the_form_of_another_engine(void **state) {
    static const struct {
        const char *tables, *file;
    } cases[] = {{"lammps", "mesofit.table"}, {"hoomd", "A-A.txt"},         {"espresso", "A-A.txt"},
                 {"openmm", "A-A.txt"},       {"gromacs", "table_A_A.xvg"}, {"dl_poly", "TABLE"},
                 {"votca", "A-A.pot"}};
    write_coarse(*state, "coarse.json");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char tables[64], path[64];
        snprintf(tables, sizeof tables, "\"steps\": 20, \"tables\": \"%s\"", cases[k].tables);
        small_inputs_change(*state, "coarse.json", "\"steps\": 20", tables);
        RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "out", "--engine", "later", "--force");
        run_program_assert_code(&result, 0);
        snprintf(path, sizeof path, "out/engine/0001/01/%s", cases[k].file);
        if (!is_there(path))
            fail_msg("%s has no %s", cases[k].tables, path);
        small_inputs_change(*state, "coarse.json", tables, "\"steps\": 20");
    }
    // Rows of OpenMM's, of which the first is that of potential.tsv.
    char *own = temporary_folder_read("out/engine/0001/01/potential.tsv");
    small_inputs_change(*state, "coarse.json", "\"steps\": 20",
                        "\"steps\": 20, \"tables\": \"openmm\"");
    RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "out", "--engine", "later", "--force");
    char *other = temporary_folder_read("out/engine/0001/01/A-A.txt");
    double r, phi, force, own_r, own_phi, own_force;
    assert_int_equal(sscanf(strchr(other, '\n'), "%lf %lf %lf", &r, &phi, &force), 3);
    assert_int_equal(sscanf(strchr(own, '\n'), "%lf %lf %lf", &own_r, &own_phi, &own_force), 3);
    assert_true(fabs(own_phi - (phi - force * (own_r - r))) < 0.01 * own_phi);
    free(own);
    free(other);
}

static void refuse(void *state, const char *from, const char *to, const char *command,
                   const char *word) {
    const char *words[] = {word, NULL};
    small_inputs_write(state, "wrong.json", run, from, to);
    if (command)
        RUN_PROGRAM(&result, "fit", "wrong.json", "-o", "wrong", "--engine", command, "--quiet");
    else
        RUN_PROGRAM(&result, "fit", "wrong.json", "-o", "wrong", "--quiet");
    run_program_assert_refused(&result, "wrong", word, 1, words);
}

static void test_wrong_settings_are_refused(void **state) {
    refuse(*state, NULL, NULL, NULL, "--engine \"COMMAND\"");
    refuse(*state, ENGINE, "\"core\": {}", COMMAND, "the run file has no \"engine\"");
    RUN_PROGRAM(&result, "fit", "wrong.json", "--engine", COMMAND, "--explain");
    run_program_assert_code(&result, 2);
    assert_non_null(strstr(result.err, "the run file has no \"engine\""));
    // Where a program of one's own does all that moves, no friction of ours is told, else it is.
    for (int own = 0; own < 2; own++) {
        small_inputs_write(*state, "wrong.json", run,
                           ", \"dissipative\": {\"law\": \"power\", \"sigma\": 3}", "");
        if (!own)
            small_inputs_change(*state, "wrong.json", "\"verification\": {",
                                "\"verification\": {\"by\": \"mesofit\", ");
        RUN_PROGRAM(&result, "fit", "wrong.json", "--engine", COMMAND, "--explain");
        run_program_assert_code(&result, 0);
        assert_int_equal(strstr(result.out, "chosen: friction") == NULL, own);
    }
    refuse(*state, ", \"frames\": \"frames.extxyz\"", "", COMMAND, "engine.frames: missing");
    refuse(*state, "\"steps\": 20", "\"input\": \"in.lmp\"", COMMAND, "engine.input");
    refuse(*state, "\"name\": \"command\", \"frames\": \"frames.extxyz\"",
           "\"name\": \"lammps\", \"tables\": \"openmm\"", COMMAND, "engine.tables");
    refuse(*state, "\"name\": \"auto\", " PLAN, "\"name\": \"cma-es\"", COMMAND,
           "it samples for inversions alone");
    refuse(*state, "\"steps\": 20", "\"types\": {\"1 2; shell\": \"A\"}", COMMAND,
           "letters, digits");
    refuse(*state, "\"steps\": 20", "\"types\": {\"1\": \"Q\"}", COMMAND, "engine.types.1");
}

/// An input whose styles stand in a file that it includes, with a known part beside the table.
static const char input[] = "units lj\natom_style atomic\nregion box block 0 5 0 5 0 5\n"
                            "create_box 1 box\ncreate_atoms 1 random 250 4711 box\nmass 1 1\n"
                            "include ff.lmp\ninclude mesofit.lmp\nminimize 1e-3 1e-3 100 1000\n"
                            "velocity all create ${temperature} ${seed}\n"
                            "fix bath all langevin 1 1 0.3 ${seed}\nfix move all nve\n"
                            "timestep 0.005\ninclude mesofit-run.lmp\n";

static void test_lammps_runs_an_input(void **state) {
    lammps_runs_skip_without(NULL);
    write_coarse(*state, "coarse.json");
    small_inputs_change(*state, "coarse.json", "\"seed\": 4",
                        "\"seed\": 4, \"title\": \"a\\nshell touch pwned\"");
    small_inputs_change(
        *state, "coarse.json", ENGINE,
        "\"engine\": {\"name\": \"lammps\", \"input\": \"in.user\", \"steps\": 20}");
    small_inputs_write(*state, "in.user", input, NULL, NULL);
    small_inputs_write(
        *state, "ff.lmp",
        "pair_style hybrid/overlay table linear 4000 soft 1\npair_coeff * * soft 0\n", NULL, NULL);
    small_inputs_write(*state, "log.lammps", "mine\n", NULL, NULL);
    small_inputs_write(*state, "run.sh", "mine\n", NULL, NULL);
    RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "out", "--engine", "lmp");
    assert_in_range(result.code, 0, 1);
    results_assert_text("out/summary.json", "verified_by", "lammps");
    assert_false(is_there("out/engine/0002/01/pwned"));
    static const char *const mine[] = {"log.lammps", "run.sh"};
    for (int k = 0; k < 2; k++) {
        char *text = temporary_folder_read(mine[k]);
        assert_string_equal(text, "mine\n");
        free(text);
    }
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps", "-o", "exported");
    run_program_assert_code(&result, 0);
    assert_non_null(strstr(result.err, "This is the potential alone"));
    char *text = temporary_folder_read("out/engine/0002/01/mesofit.lmp");
    assert_non_null(strstr(text, "pair_coeff 1 1 table mesofit.table"));
    assert_null(strstr(text, "pair_style"));
    free(text);
}

static void test_lammps_inputs_that_cannot_be(void **state) {
    static const struct {
        const char *from, *to, *word;
    } cases[] = {{"include mesofit.lmp", "# include mesofit.lmp", "include mesofit.lmp"},
                 {"fix move all nve", "write_data ff.lmp", "ff.lmp: it is read, and `write_data`"},
                 {"units lj", "units real", "its units are real where the run file has no"},
                 {"${seed}", "12345", "have the same frames"}};
    lammps_runs_skip_without(NULL);
    write_coarse(*state, "coarse.json");
    small_inputs_change(*state, "coarse.json", ENGINE,
                        "\"engine\": {\"name\": \"lammps\", \"input\": \"in.user\"}");
    small_inputs_write(
        *state, "ff.lmp",
        "pair_style hybrid/overlay table linear 4000 soft 1\npair_coeff * * soft 0\n", NULL, NULL);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        small_inputs_write(*state, "in.user", input, cases[k].from, cases[k].to);
        if (strcmp(cases[k].from, "${seed}") == 0) // both of them
            small_inputs_change(*state, "in.user", "${seed}", "12345");
        RUN_PROGRAM(&result, "fit", "coarse.json", "-o", "out", "--engine", "lmp", "--quiet",
                    "--force");
        run_program_assert_code(&result, 2);
        if (strstr(result.err, cases[k].word) == NULL)
            fail_msg("%s: %s", cases[k].to, result.err);
    }
}

static void test_lammps_finds_the_potential(void **state) {
    lammps_runs_skip_without(NULL);
    small_inputs_write(*state, "run.json", run, ENGINE,
                       "\"engine\": {\"name\": \"lammps\", \"time_step\": 0.005, \"steps\": 20}");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--engine", "lmp");
    run_program_assert_code(&result, 0);
    assert_true(fabs(results_number("out/summary.json", "truth_ramp")) <
                5 * results_number("out/summary.json", "ramp_error"));
    assert_true(results_number("out/summary.json", "truth_rms_without_ramp") < 0.15);
}

/// At constant pressure boxes change, and the density is a target: the pressure that the truth has
/// at its density leads back to that.
static void test_lammps_meets_a_density(void **state) {
    char text[512];
    lammps_runs_skip_without(NULL);
    snprintf(text, sizeof text,
             "fix bath all langevin 1 1 0.3 ${seed}\nfix move all nph iso %.6g %.6g 1\n",
             results_number("truth/summary.json", "pressure"),
             results_number("truth/summary.json", "pressure"));
    small_inputs_write(*state, "in.user", input,
                       "fix bath all langevin 1 1 0.3 ${seed}\nfix move all nve\n", text);
    small_inputs_write(*state, "ff.lmp", "# nothing else is known\n", NULL, NULL);
    small_inputs_write(*state, "run.json", run, ENGINE,
                       "\"engine\": {\"name\": \"lammps\", \"input\": \"in.user\", \"steps\": 20}");
    small_inputs_change(*state, "run.json", "\"samples\"}}",
                        "\"samples\"}, \"density\": {\"value\": 2, \"error\": 0.004}}");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--engine", "lmp");
    run_program_assert_code(&result, 0);
    assert_non_null(strstr(result.err, ", density "));
    assert_true(results_number("out/summary.json", "density_rmse") <
                3 * results_number("out/summary.json", "density_noise"));
    assert_true(results_number("out/summary.json", "rdf_rmse") < 0.02);
    assert_true(results_number("out/summary.json", "truth_rms_without_ramp") < 0.15);
    assert_true(fabs(results_number("out/summary.json", "truth_ramp")) <
                5 * results_number("out/summary.json", "ramp_error"));
}

/// g(r) of a liquid does not know the shape of the box: one that is tilted as far as LAMMPS lets it
/// gives the same potential.
static void test_lammps_in_a_tilted_box(void **state) {
    lammps_runs_skip_without(NULL);
    small_inputs_write(*state, "in.user", input, "region box block 0 5 0 5 0 5",
                       "region box prism 0 5 0 5 0 5 2.4 -2.4 2.4");
    small_inputs_write(*state, "ff.lmp", "# nothing else is known\n", NULL, NULL);
    small_inputs_write(*state, "run.json", run, ENGINE,
                       "\"engine\": {\"name\": \"lammps\", \"input\": \"in.user\", \"steps\": 20}");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--engine", "lmp", "--quiet");
    run_program_assert_code(&result, 2);
    assert_non_null(strstr(result.err, "it is tilted: what is found in such a box is verified by"));
    small_inputs_change(*state, "run.json", "\"verification\": {",
                        "\"verification\": {\"by\": \"mesofit\", ");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--engine", "lmp", "--force");
    run_program_assert_code(&result, 0);
    assert_true(results_number("out/summary.json", "truth_rms_without_ramp") < 0.15);
    assert_true(fabs(results_number("out/summary.json", "truth_ramp")) <
                5 * results_number("out/summary.json", "ramp_error"));
}

static void test_densities_that_cannot_be_are_refused(void **state) {
    static const struct {
        const char *from, *to, *word;
    } cases[] = {
        {ENGINE ",", "", "target.density: mesofit samples at constant volume"},
        {ENGINE, "\"engine\": {\"name\": \"lammps\"}", "give one of your own with `fix npt`"},
        {"\"density\"", "\"pressure\": {\"value\": 1, \"error\": 1}, \"density\"",
         "leave \"pressure\" out"},
        {"\"verification\": {", "\"verification\": {\"by\": \"mesofit\", ",
         "is at constant volume"}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        small_inputs_write(*state, "run.json", run, "\"samples\"}}",
                           "\"samples\"}, \"density\": {\"value\": 2, \"error\": 0.004}}");
        small_inputs_change(*state, "run.json", cases[k].from, cases[k].to);
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--engine", COMMAND, "--quiet");
        run_program_assert_code(&result, 2);
        if (strstr(result.err, cases[k].word) == NULL)
            fail_msg("%s: %s", cases[k].to, result.err);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_a_known_potential_is_found, enter, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_a_fit_whose_engine_died_goes_on_with_the_same_bits,
                                        enter, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_an_engine_that_has_a_known_part_is_given_the_rest,
                                        enter, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_a_written_input_has_the_known_part, enter,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_samples_made_later_give_the_same_bits, enter,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_a_job_goes_on_with_the_same_bits, enter,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_broken_samples_are_waited_for_again, enter,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_what_is_wrong_with_an_engine_is_said, enter,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_tables_in_the_form_of_another_engine, enter,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_wrong_settings_are_refused, enter, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_lammps_inputs_that_cannot_be, enter,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_lammps_runs_an_input, enter, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_lammps_finds_the_potential, enter, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_densities_that_cannot_be_are_refused, enter,
                                        small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_lammps_meets_a_density, enter, small_inputs_leave),
        cmocka_unit_test_setup_teardown(test_lammps_in_a_tilted_box, enter, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
