// SPDX-License-Identifier: GPL-3.0-or-later
//
// What goes wrong with an engine that is no engine: each in one line that says what is true, and
// where. The engines are words of a shell, which fail as LAMMPS, a licence, a disk or a user would.
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define SETUP                                                                                      \
    "\"box\": [5, 5, 5], \"time_step\": 0.02, \"particles\": {\"count\": 250}, "                   \
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3}"

static const char scene[] =
    "{\"seed\": 3, " SETUP ", \"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"rdf\": {\"range\": 1.2, \"bins\": 30},\n"
    "\"measure\": {\"equilibration\": 200, \"samples\": 100, \"every\": 20}}\n";

#define COMMAND "\"name\": \"command\", \"frames\": \"frames.xyz\""
static const char run[] =
    "{\"seed\": 4, \"scene\": {" SETUP "},\n"
    "\"target\": {\"rdf\": {\"file\": \"truth/rdf.tsv\", \"errors_of\": \"samples\"}},\n"
    "\"engine\": {" COMMAND "},\n"
    "\"method\": {\"name\": \"auto\", \"replicas\": 2, \"samples\": 32, \"iterations\": 2}}\n";

/// Frames of beads at random, as many as are wanted, of which a word says what is wrong.
static const char frames[] =
    "import json, random, sys\n"
    "wrong = sys.argv[1]\n"
    "asked = json.load(open('engine.json'))\n"
    "draw = random.Random(1 if wrong == 'seed' else asked['seed'])\n"
    "unit = 0.1 if wrong == 'unit' else 1\n"
    "kind = 'B' if wrong == 'type' else 'A'\n"
    "beads = 249 if wrong == 'lost' else 250\n"
    "box = 6 if wrong == 'box' else 5\n"
    "with open(asked['trajectory'], 'w') as out:\n"
    "    for frame in range(asked['frames']):\n"
    "        if wrong == 'still': draw.seed(asked['seed'])\n"
    "        out.write('%d\\nLattice=\"%g 0 0 0 %g 0 0 0 %g\" Properties=species:S:1:pos:R:3 "
    "Units=lj\\n' % (beads, box, box, box))\n"
    "        for k in range(beads):\n"
    "            place = [5 * unit * draw.random() for _ in range(3)]\n"
    "            if wrong == 'nan' and k == 7: place[1] = float('nan')\n"
    "            out.write('%s %g %g %g\\n' % (kind, *place))\n";

static struct run_program_result result;

static int enter(void **state) {
    if (small_inputs_enter(state) != 0)
        return -1;
    small_inputs_write(*state, "truth.json", scene, NULL, NULL);
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    small_inputs_write(*state, "lammps.json", run, COMMAND, "\"name\": \"lammps\"");
    small_inputs_write(*state, "frames.py", frames, NULL, NULL);
    twins_simulate("truth.json", "truth");
    return 0;
}

/// One line that has a word, and this code.
static void fails(const char *file, const char *engine, int code, const char *word) {
    RUN_PROGRAM(&result, "fit", file, "-o", "out", "--engine", engine, "--quiet", "--force");
    run_program_assert_code(&result, code);
    if (strstr(result.err, word) == NULL || run_program_lines(result.err) != 1)
        fail_msg("%s: %s", engine, result.err);
}

static void test_commands_that_fail(void **state) {
    (void)state;
    fails("run.json", "no-such-engine", 2, "no-such-engine: not found");
    fails("run.json", "sh -c 'exit 3'", 2, "ended with exit code 3 and said nothing");
    fails("run.json", "sh -c 'kill -KILL $$'", 2, "Killed");
    fails("run.json", "sh -c 'echo no licence >&2; exit 1'", 2, "out/engine/0001/01: no licence;");
    fails("lammps.json", "sh -c 'exit 3'", 2, "ended with exit code 3 and said nothing");
    fails("lammps.json", "sh -c 'echo ERROR: Unknown pair style; exit 1'", 2,
          "ERROR: Unknown pair style; the end of what it said is in engine.log there");
    // The potential's fault, but that it began with has no shorter step.
    fails("lammps.json", "sh -c 'echo ERROR: Lost atoms: original 250 current 249; exit 1'", 1,
          "ERROR: Lost atoms");
}

static void test_commands_that_leave_nothing(void **state) {
    (void)state;
    fails("run.json", "true", 2, "frames.xyz: the command has left no such file");
    fails("lammps.json", "true", 2, "frames.lammpstrj: the command has left no such file");
    fails("run.json", "sh -c ': >frames.xyz'", 2, "frames.xyz: the file is empty");
    fails("run.json", "sh -c 'echo done >frames.xyz'", 2, "expected the number of atoms");
}

static void test_frames_of_something_else(void **state) {
    static const char *const cases[][2] = {
        {"unit", "look at the unit of their positions"},
        {"lost", "249 atoms of the engine are the beads, of which the scene has 250"},
        {"box", "the box is 6 by 6 by 6 where the scene's is 5 by 5 by 5"},
        {"nan", "frame 0: a coordinate is not a finite number"},
        {"still", "all beads are where they were in the frame before"},
        {"seed", "the seed that each is given is not used"}};
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char engine[64];
        snprintf(engine, sizeof engine, "python3 ../../../../frames.py %s", cases[k][0]);
        fails("run.json", engine, 2, cases[k][1]);
    }
    small_inputs_write(*state, "run.json", run, "{\"count\": 250}",
                       "{\"types\": {\"A\": 150, \"C\": 100}}");
    small_inputs_change(*state, "run.json",
                        "{\"file\": \"truth/rdf.tsv\", \"errors_of\": \"samples\"}",
                        "{\"A-A\": {\"file\": \"truth/rdf.tsv\"}, \"A-C\": {\"file\": "
                        "\"truth/rdf.tsv\"}, \"C-C\": {\"file\": \"truth/rdf.tsv\"}}");
    fails("run.json", "python3 ../../../../frames.py type", 2,
          "0 atoms of the engine are A, of which the scene has 150; \"types\" of \"engine\"");
}

static void test_two_fits_in_one_folder(void **state) {
    const struct timespec pause = {.tv_nsec = 50000000};
    const pid_t first = fork();
    (void)state;
    if (first == 0) {
        execl(getenv("MESOFIT"), "mesofit", "fit", "run.json", "-o", "out", "--engine", "sleep 60",
              "--quiet", (char *)NULL);
        _exit(127);
    }
    for (int k = 0; k < 400 && access("out/engine/0001/01/engine.json", F_OK) != 0; k++)
        nanosleep(&pause, NULL);
    fails("run.json", "true", 2, "out: another process is running in this folder");
    kill(first, SIGINT);
    waitpid(first, NULL, 0);
}

/// Full before the engine begins, and within one of its frames.
static void test_a_disk_that_is_full(void **state) {
    static const char *const cases[][2] = {{"size=100k", "true"},
                                           {"size=300k", "python3 ../../../../../frames.py none"}};
    (void)state;
    assert_int_equal(mkdir("disk", 0777), 0);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        if (mount("tmpfs", "disk", "tmpfs", 0, cases[k][0]) != 0) {
            print_message("skipped: to mount a small disk takes root\n");
            skip();
        }
        RUN_PROGRAM(&result, "fit", "run.json", "-o", "disk/out", "--engine", cases[k][1],
                    "--quiet");
        const bool begun = access("disk/out/engine/0001/01/frames.xyz", F_OK) == 0;
        umount("disk");
        run_program_assert_code(&result, 2);
        assert_contains(result.err, "No space left on device");
        assert_int_equal(run_program_lines(result.err), 1);
        assert_int_equal(begun, k == 1);
    }
}

/// A box that Monte Carlo of ours would have no room in, another engine may have: it is said in the
/// units of the file, or not at all.
static void test_a_box_that_is_small(void **state) {
    small_inputs_change(*state, "run.json", "\"seed\": 4", "\"seed\": 4, \"units\": \"nm-ps\"");
    small_inputs_change(*state, "run.json", "\"box\": [5, 5, 5]",
                        "\"temperature\": 300, \"box\": [2.45, 2.45, 2.45]");
    small_inputs_change(*state, "run.json", "{\"count\": 250}", "{\"count\": 30, \"mass\": 18}");
    small_inputs_change(*state, "run.json", ", \"dissipative\": {\"law\": \"power\", \"sigma\": 3}",
                        "");
    assert_int_equal(system("sed 's/lambda/nm/' truth/rdf.tsv >rdf.tsv"), 0);
    small_inputs_change(*state, "run.json", "truth/rdf.tsv", "rdf.tsv");
    RUN_PROGRAM(&result, "fit", "run.json", "--engine", "true", "--explain");
    run_program_assert_code(&result, 0);
    small_inputs_change(*state, "run.json", "\"engine\": {" COMMAND "},", "");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "its shortest edge 2.45 nm must be at least 2.1 times the cutoff");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_commands_that_fail),       TEST(test_commands_that_leave_nothing),
        TEST(test_frames_of_something_else), TEST(test_two_fits_in_one_folder),
        TEST(test_a_disk_that_is_full),      TEST(test_a_box_that_is_small),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
