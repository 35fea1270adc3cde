// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit measure` on trajectories whose contents another program has told
// (tests/trajectories/README.md).
#include "io/data_table.h"
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>

enum { WATERS = 2744, PATH = 1024, MAX_WORDS = 16 };

static struct run_program_result result;

static char xtc[PATH], trr[PATH], gro[PATH], wrapped[PATH], dump[PATH];

static const char map[] = "{\"beads\": {\"W\": {\"residue\": \"SOL\"}},"
                          " \"masses\": {\"OW\": 15.9994, \"HW1\": 1.008, \"HW2\": 1.008}}";

static int enter(void **state) {
    const char *const folder = run_program_sources();
    snprintf(xtc, PATH, "%s/tests/trajectories/water.xtc", folder);
    snprintf(trr, PATH, "%s/tests/trajectories/water.trr", folder);
    snprintf(gro, PATH, "%s/tests/trajectories/water.gro", folder);
    snprintf(wrapped, PATH, "%s/tests/trajectories/water-atoms-wrapped.xtc", folder);
    snprintf(dump, PATH, "%s/tests/trajectories/lammps-plain.dump", folder);
    return small_inputs_enter_without_gnuplot(state);
}

#define MEASURE(...)                                                                               \
    do {                                                                                           \
        RUN_PROGRAM(&result, "measure", __VA_ARGS__);                                              \
        run_program_assert_code(&result, 0);                                                       \
    } while (0)

/// Mean number of pairs from `low` to `high` nm, by g in bins of 0.01 nm.
static double count_pairs(const char *file, double low, double high) {
    struct data_table table;
    double pairs = 0;
    assert_ok(mf_data_table_read(&table, file, 2));
    for (size_t k = 0; k < table.rows; k++) {
        const double r = table.values[table.columns * k], g = table.values[table.columns * k + 1];
        if (r > low && r < high)
            pairs += g * (pow(r + 0.005, 3) - pow(r - 0.005, 3));
    }
    mf_data_table_clear(&table);
    return pairs * 4 * acos(-1) / 3 * WATERS * (WATERS - 1.0) / 2 / pow(4.384, 3);
}

/// Counts of centres of mass, by another program from the trr.
static void test_measure_counts_the_pairs_that_there_are(void **state) {
    temporary_folder_write(*state, "map.json", map, sizeof map - 1);
    MEASURE(trr, "-s", gro, "--map", "map.json", "-o", "trr");
    assert_contains(result.err, "K by the velocities of the beads");
    assert_close(count_pairs("trr/rdf.tsv", 0.2, 0.3), (3977 + 4003) / 2.0, 0.01);
    assert_close(count_pairs("trr/rdf.tsv", 0.3, 0.4), (6737 + 6683) / 2.0, 0.01);
    assert_close(count_pairs("trr/rdf.tsv", 0.4, 0.5), (11831 + 11879) / 2.0, 0.01);
    // Σ M v² / (3 N k_B) of frames 0 and 1; three degrees of freedom are those of the whole.
    assert_close(results_number("trr/summary.json", "temperature"), (292.570 + 287.689) / 2, 0.2);
    assert_close(results_number("trr/summary.json", "particles"), WATERS, 0);
    assert_close(results_number("trr/summary.json", "density"), WATERS / pow(4.384, 3), 1e-4);
    // The longest waves are one along each edge.
    struct data_table waves;
    assert_ok(mf_data_table_read(&waves, "trr/structure_factor.tsv", 4));
    assert_close(waves.values[0], 2 * acos(-1) / 4.384, 1e-3);
    assert_close(waves.values[3], 3, 0);
    mf_data_table_clear(&waves);
    // Rounded to 0.001 nm, a few pairs are in other bins.
    MEASURE(xtc, "-s", gro, "-o", "xtc");
    assert_contains(result.err, "no VACF: there are no velocities");
    // 0.08 ps, in which molecules fly.
    assert_contains(result.err, "no D yet: the MSD still grows as t^1.87");
    assert_close(count_pairs("xtc/rdf.tsv", 0.2, 0.3), (3977 + 4003 + 4013 + 4041 + 4045) / 5.0, 5);
    MEASURE(wrapped, "-s", gro, "-o", "wrapped", "--quiet");
    assert_close(count_pairs("wrapped/rdf.tsv", 0.2, 0.3), count_pairs("xtc/rdf.tsv", 0.2, 0.3),
                 0.5);
    MEASURE(gro, "-o", "gro", "--quiet");
    assert_close(count_pairs("gro/rdf.tsv", 0.2, 0.3), 3977, 20);
    assert_false(temporary_folder_exists("gro/msd.tsv")); // of one frame
    char *summary = temporary_folder_read("gro/summary.json");
    assert_contains(summary, "\"kirkwood_buff_error\":\tnull");
    assert_contains(summary, "\"compressibility_error\":\tnull");
    free(summary);
}

static const char *const tables[] = {
    "rdf.tsv", "msd.tsv", "etd.tsv", "structure_factor.tsv", "etd_error.tsv", "etd_bins.tsv", NULL};

static void test_measure_writes_the_same_bytes_when_threads_differ(void **state) {
    (void)state;
    MEASURE(xtc, "-s", gro, "-o", "one", "--threads", "1", "--window", "0.04", "--quiet");
    MEASURE(xtc, "-s", gro, "-o", "two", "--threads", "2", "--window", "0.04", "--quiet");
    MEASURE(xtc, "-s", gro, "-o", "three", "--threads", "3", "--window", "0.04", "--quiet");
    results_assert_same("one", "two", tables);
    results_assert_same("one", "three", tables);
    results_assert_same("one", "three", (const char *const[]){"target.json", NULL});
}

/// Times that are 0.02 ps apart and have a last digit of 0.008 ps.
static void test_measure_keeps_frames_whose_late_times_are_rounded(void **state) {
    enum { FRAMES = 40 };
    char text[FRAMES * 256];
    size_t length = 0;
    for (int k = 0; k < FRAMES; k++)
        length += (size_t)snprintf(
            text + length, sizeof text - length,
            "2\nLattice=\"30 0 0 0 30 0 0 0 30\" Properties=species:S:1:pos:R:3 Time=%.9g\n"
            "Ar %.9g 0 0\nAr %.9g 0 0\n",
            1e3 * (double)(float)(100000 + 0.02 * k), 5 + 0.005 * k, 9 - 0.005 * k);
    temporary_folder_write(*state, "late.xyz", text, length);
    MEASURE("late.xyz", "--window", "0.04", "-o", "late");
    assert_false(strstr(result.err, "left out"));
    assert_close(results_number("late/summary.json", "frames"), FRAMES, 0);
    assert_close(results_number("late/summary.json", "interval"), 0.02, 1e-9);
}

/// The usual window is a tenth of what is used, not of the file.
static void test_measure_has_motion_of_the_frames_that_are_used(void **state) {
    enum { FRAMES = 200 };
    char text[FRAMES * 256];
    size_t length = 0;
    for (int k = 0; k < FRAMES; k++)
        length += (size_t)snprintf(
            text + length, sizeof text - length,
            "2\nLattice=\"30 0 0 0 30 0 0 0 30\" Properties=species:S:1:pos:R:3 Time=%d\n"
            "Ar %05.3f 0 0\nAr %05.3f 0 0\n",
            1000 * k, 5 + 0.005 * k, 9 - 0.005 * k);
    temporary_folder_write(*state, "long.xyz", text, length);
    MEASURE("long.xyz", "--begin", "198", "-o", "two frames");
    assert_contains(result.err, "no motion, no escape times: 2 frames are no window");
    assert_null(strstr(result.err, "escape times of pairs"));
    MEASURE("long.xyz", "--begin", "179.5", "-o", "end", "--quiet");
    assert_close(results_number("end/summary.json", "frames"), 20, 0);
    assert_close(results_number("end/summary.json", "window"), 2, 1e-9);
    assert_true(temporary_folder_exists("end/msd.tsv"));
    MEASURE("long.xyz", "--units", "angstrom-fs", "-o", "angstrom");
    assert_contains(result.err, " angstrom^2/fs by the MSD from 1e+04 to 2e+04 fs, for this box");
    MEASURE("long.xyz", "--every", "2.5", "-o", "five"); // of 1 ps
    assert_contains(result.err, " nm^2/ps by the MSD from ");
    assert_contains(result.err, "--every 2.5: frames 5 ps apart are used");
    MEASURE("long.xyz", "--every", "2", "-o", "two");
    assert_null(strstr(result.err, "--every"));
}

static void test_measure_names_the_times_that_a_file_has(void **state) {
    (void)state;
    RUN_PROGRAM(&result, "measure", xtc, "-s", gro, "--begin", "1e6", "-o", "late");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "water.xtc: no frame is left to be measured: there are times from "
                                "0 to 0.08 ps\n");
    RUN_PROGRAM(&result, "measure", xtc, "-s", gro, "--begin", "0.01", "--end", "0.015", "-o", "x");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "there are times from 0 to 0.02 ps and later\n");
}

/// water.xtc, and where its frames begin and end.
static unsigned char bytes[200000];
static size_t begin[8];

/// Headers tell the bytes that follow them.
static void read_frames(void) {
    enum { HEADER = 92, SIZE = 88 };
    FILE *stream = fopen(xtc, "rb");
    const size_t all = fread(bytes, 1, sizeof bytes, stream);
    size_t frames = 0;
    fclose(stream);
    for (; begin[frames] < all; frames++) {
        const unsigned char *const size = bytes + begin[frames] + SIZE;
        const size_t packed = (size_t)size[1] << 16 | (size_t)size[2] << 8 | size[3];
        begin[frames + 1] = begin[frames] + HEADER + (packed + 3) / 4 * 4;
    }
    assert_int_equal(frames, 5);
}

/// Frames `first` … `end` − 1.
static void write_frames(struct temporary_folder *folder, const char *name, size_t first,
                         size_t end) {
    read_frames();
    temporary_folder_write(folder, name, (const char *)bytes + begin[first],
                           begin[end] - begin[first]);
}

static void test_measure_joins_files_when_a_run_was_restarted(void **state) {
    write_frames(*state, "a.xtc", 0, 3);
    write_frames(*state, "b.xtc", 1, 5); // from an earlier checkpoint on
    MEASURE(xtc, "-s", gro, "-o", "whole", "--window", "0.04", "--quiet");
    MEASURE("a.xtc", "b.xtc", "-s", gro, "-o", "parts", "--window", "0.04");
    assert_contains(result.err, "b.xtc: 2 frames of times that had been were left out");
    char *target = temporary_folder_read("parts/target.json");
    assert_contains(target, "\"title\":\t\"a.xtc\"");
    free(target);
    results_assert_same("whole", "parts", tables);
    MEASURE(xtc, "-s", gro, "-o", "every", "--every", "0.04", "--begin", "0.01", "--end", "0.07",
            "--static", "--quiet");
    assert_close(results_number("every/summary.json", "frames"), 2, 0); // 0.02 and 0.06 ps
}

static void test_measure_uses_what_is_whole_when_a_file_breaks_off(void **state) {
    write_frames(*state, "four.xtc", 0, 4);
    write_frames(*state, "five.xtc", 0, 5);
    char *five = temporary_folder_read("five.xtc");
    FILE *stream = fopen("five.xtc", "rb");
    fseek(stream, 0, SEEK_END);
    const long size = ftell(stream);
    fclose(stream);
    temporary_folder_write(*state, "broken.xtc", five, (size_t)size - 1000);
    free(five);
    RUN_PROGRAM(&result, "measure", "broken.xtc", "-s", gro, "-o", "no", "--quiet");
    run_program_assert_refused(
        &result, ".", "broken", 1,
        (const char *const[]){"broken.xtc: frame 4, byte", "ends", "--allow-truncated", NULL});
    assert_false(temporary_folder_exists("no/rdf.tsv"));
    MEASURE("broken.xtc", "-s", gro, "-o", "broken", "--allow-truncated");
    assert_contains(result.err, "broken.xtc: frame 4, byte");
    MEASURE("four.xtc", "-s", gro, "-o", "four", "--quiet");
    results_assert_same("broken", "four", (const char *const[]){"rdf.tsv", NULL});
}

/// The frames of water.xtc over and over, at times that go on: a header of 16 bytes has the time
/// last.
static void write_long(const char *name) {
    enum { COPIES = 250, TIME = 12 };
    FILE *stream = fopen(name, "wb");
    for (int frame = 0; frame < 5 * COPIES; frame++) {
        unsigned char *const header = bytes + begin[frame % 5];
        const float time = 0.02F * (float)frame;
        uint32_t word;
        memcpy(&word, &time, sizeof word);
        for (int k = 0; k < 4; k++)
            header[TIME + k] = (unsigned char)(word >> (24 - 8 * k));
        fwrite(header, 1, begin[frame % 5 + 1] - begin[frame % 5], stream);
    }
    assert_int_equal(fclose(stream), 0);
}

/// Some seconds of work, of which there is time for a part.
static void test_measure_writes_what_it_has_when_it_is_stopped(void **state) {
    (void)state;
    read_frames();
    write_long("long.xtc");
    const struct run_program_how how = {.interrupt_with = SIGINT, .interrupt_after = 0.2};
    run_program(&result, &how,
                (const char *const[]){"measure", "long.xtc", "-s", gro, "-o", "stopped",
                                      "--threads", "1", NULL});
    run_program_assert_code(&result, 130);
    assert_contains(result.err, "mesofit: interrupted after ");
    results_assert_text("stopped/summary.json", "status", "interrupted");
    const double frames = results_number("stopped/summary.json", "frames");
    assert_true(frames > 0 && frames < 1250);
    assert_true(temporary_folder_exists("stopped/target.json"));
    assert_true(temporary_folder_exists("stopped/rdf.tsv"));
    run_program_assert_no_partial("stopped");
}

static void test_measure_speaks_angstrom_when_asked(void **state) {
    (void)state;
    MEASURE(trr, "-s", gro, "-o", "nm", "--quiet");
    MEASURE(trr, "-s", gro, "-o", "angstrom", "--units", "angstrom-fs");
    assert_contains(result.err, "g(r) to 19.7 angstrom in 197 bins");
    assert_contains(result.err, "S(q) to 4.013 1/angstrom");
    assert_close_relative(results_number("angstrom/used.json", "range"),
                          10 * results_number("nm/used.json", "range"), 1e-12);
    results_assert_text("angstrom/used.json", "units", "angstrom-fs");
    char *table = temporary_folder_read("angstrom/rdf.tsv");
    assert_contains(table, "# r[angstrom]\tg[1]\tg_error[1]\n0.05\t");
    free(table);
    assert_close_relative(results_number("angstrom/summary.json", "density"),
                          1e-3 * results_number("nm/summary.json", "density"), 1e-12);
    assert_close_relative(results_number("angstrom/summary.json", "interval"), 20, 1e-12);
    MEASURE(xtc, "-s", gro, "-o", "motion", "--units", "angstrom-fs");
    assert_contains(result.err,
                    "escape times of pairs from 2.5 to 5 angstrom, in windows of 40 fs");
    assert_null(strstr(result.err, " nm"));
    assert_null(strstr(result.err, " ps"));
}

static void test_measure_tells_types_apart_when_the_map_does(void **state) {
    static const char two[] = "{\"beads\": {\"O\": {\"residue\": \"SOL\", \"atoms\": \"OW\"},"
                              "\"H\": {\"residue\": \"SOL\", \"atoms\": \"HW1 HW2\"}}}";
    temporary_folder_write(*state, "two.json", two, sizeof two - 1);
    MEASURE(xtc, "-s", gro, "--map", "two.json", "-o", "two");
    assert_contains(result.err, "without pairs of one molecule");
    assert_true(temporary_folder_exists("two/rdf_O-O.tsv"));
    assert_true(temporary_folder_exists("two/rdf_H-H.tsv"));
    struct data_table table;
    assert_ok(mf_data_table_read(&table, "two/rdf_O-H.tsv", 3));
    // The hydrogens' middle is 0.06 nm from the own oxygen, and 0.1 nm from no other one.
    for (size_t k = 0; k < 10; k++)
        assert_close(table.values[3 * k + 1], 0, 0);
    mf_data_table_clear(&table);
    char *target = temporary_folder_read("two/target.json");
    assert_contains(target, "\"O-H\":");
    assert_contains(target, "\"types\":");
    free(target);
    // Rigid bonds: oxygens alone have 279 K, halves of molecules 214 K.
    MEASURE(trr, "-s", gro, "--map", "two.json", "-o", "halves", "--quiet");
    target = temporary_folder_read("halves/target.json");
    assert_null(strstr(target, "temperature"));
    free(target);
    // There are no bonds, and friction is for one mass: motion is not fitted, so that a fit begins.
    MEASURE(xtc, "-s", gro, "--map", "two.json", "-o", "moving", "--window", "0.04",
            "--temperature", "298");
    assert_contains(result.err, "without --molecules a fit has no bonds");
    assert_contains(result.err, "no target of a fit that has them");
    assert_contains(result.err, "masses of beads differ");
    RUN_PROGRAM(&result, "fit", "--target", "moving", "--explain");
    run_program_assert_code(&result, 0);
}

static const struct {
    const char *words[MAX_WORDS];
    const char *says[3];
} refusals[] = {
    {{"XTC", "-s", "missing.gro"}, {"missing.gro"}},
    {{"missing.xtc", "-s", "GRO"}, {"missing.xtc"}},
    {{"XTC", "-s", "small.gro"}, {"has 8232 atoms", "small.gro has 3"}},
    {{"XTC", "-s", "map.json"}, {"-s: map.json: not a trajectory: read are"}},
    {{"XTC", "-s", "XTC"}, {"-s: ", "\"xtc\" says where atoms are, and not what: give a .gro"}},
    {{"XTC", "-s", "GRO", "--map", "oxygen.json"}, {"oxygen.json: atom 2", "belongs to no bead"}},
    {{"XTC", "-s", "GRO", "--map", "wrong.json"}, {"wrong.json: residue 1", "atoms \"CA\""}},
    {{"odd.gro", "--map", "map.json"},
     {"map.json: residue 2 \"SOL\" (atom 4) has 2 atoms", "the first of its name has 3"}},
    {{"unboxed.gro"}, {"unboxed.gro: frame 0 has no box"}},
    {{"XTC", "-s", "GRO", "--range", "2.3"}, {"frame 0: the range of g(r), 2.3 nm", "2.192"}},
    {{"XTC", "-s", "GRO", "--escape", "2.3"}, {"the range of escape times, 2.3 nm"}},
    {{"XTC", "-s", "GRO", "--velocities", "file"}, {"frame 0 has no velocities"}},
    {{"late.xtc", "early.xtc", "-s", "GRO"}, {"early.xtc: frame 0 is out of order"}},
    {{"early.xtc", "last.xtc", "-s", "GRO"}, {"last.xtc: frame 0, at 0.08", "not 0.02"}},
    {{"XTC", "-s", "GRO", "--begin", "7"}, {"no frame is left"}},
    {{"XTC", "-s", "GRO", "--begin", "-5"}, {"--begin takes a number from 0 on, not \"-5\""}},
    {{"XTC", "-s", "GRO", "--q-range", "1"},
     {"frame 0: S(q), which --q-range 0 leaves out: q_maximum 1 is below"}},
    {{"XTC", "-s", "GRO", "--waves", "0"}, {"--waves takes a whole number from 1"}},
    {{"XTC", "-s", "GRO", "--range", "far"}, {"--range takes a number above 0"}},
    {{"XTC", "-s", "GRO", "--bins", "0"}, {"--bins takes a whole number"}},
    {{"XTC", "-s", "GRO", "--units", "mile"}, {"--units takes nm-ps|angstrom-fs"}},
    {{"XTC", "-s", "GRO", "--window", "0.02"}, {"--window 0.02", "0.02 ps apart"}},
    {{"DUMP", "-s", "GRO"}, {"lammps-plain.dump"}},
    {{"XTC", "-s", "GRO", "--file-units", "real"}, {"\"xtc\" defines its units"}},
};

static void write_bad_files(struct temporary_folder *folder) {
    static const char small[] = "three atoms\n3\n"
                                "    1SOL     OW    1   0.100   0.100   0.100\n"
                                "    1SOL    HW1    2   0.200   0.100   0.100\n"
                                "    1SOL    HW2    3   0.100   0.200   0.100\n"
                                "   3.0 3.0 3.0\n";
    static const char odd[] = "two waters\n5\n"
                              "    1SOL     OW    1   0.100   0.100   0.100\n"
                              "    1SOL    HW1    2   0.200   0.100   0.100\n"
                              "    1SOL    HW2    3   0.100   0.200   0.100\n"
                              "    2SOL     OW    4   1.100   0.100   0.100\n"
                              "    2SOL    HW1    5   1.200   0.100   0.100\n"
                              "   3.0 3.0 3.0\n";
    static const char unboxed[] = "two atoms\n2\n"
                                  "    1SOL     OW    1   0.100   0.100   0.100\n"
                                  "    2SOL     OW    2   0.200   0.100   0.100\n"
                                  "   0.0 0.0 0.0\n";
    static const char oxygen[] = "{\"beads\": {\"O\": {\"residue\": \"SOL\", \"atoms\": \"OW\"}}}";
    static const char wrong[] = "{\"beads\": {\"O\": {\"residue\": \"SOL\", \"atoms\": \"CA\"}}}";
    temporary_folder_write(folder, "small.gro", small, sizeof small - 1);
    temporary_folder_write(folder, "odd.gro", odd, sizeof odd - 1);
    temporary_folder_write(folder, "unboxed.gro", unboxed, sizeof unboxed - 1);
    temporary_folder_write(folder, "map.json", map, sizeof map - 1);
    temporary_folder_write(folder, "oxygen.json", oxygen, sizeof oxygen - 1);
    temporary_folder_write(folder, "wrong.json", wrong, sizeof wrong - 1);
    write_frames(folder, "early.xtc", 0, 2);
    write_frames(folder, "late.xtc", 2, 4);
    write_frames(folder, "last.xtc", 4, 5);
}

/// Velocities that know nothing of the last ones, 1 ps apart: trapezoids make a D of them that has
/// nothing to do with how far the atoms go. Those that fall by a tenth from frame to frame do not.
static void test_measure_warns_of_velocities_that_are_far_apart(void **state) {
    enum { FRAMES = 60, ATOMS = 20 };
    static char text[FRAMES * (ATOMS + 2) * 80];
    for (int slow = 0; slow < 2; slow++) {
        double velocity[ATOMS][3] = {{0}}, place[ATOMS][3] = {{0}};
        size_t length = 0;
        srand(3);
        for (int k = 0; k < FRAMES; k++) {
            length +=
                (size_t)snprintf(text + length, sizeof text - length,
                                 "%d\nLattice=\"30 0 0 0 30 0 0 0 30\" Properties=species:S:1:"
                                 "pos:R:3:vel:R:3 Time=%d\n",
                                 ATOMS, 1000 * k);
            for (int n = 0; n < ATOMS; n++) {
                for (int d = 0; d < 3; d++) {
                    const double kick = 2 * (rand() / (RAND_MAX + 1.0)) - 1;
                    velocity[n][d] = slow ? 0.9 * velocity[n][d] + 0.4 * kick : kick;
                    place[n][d] += 0.1 * velocity[n][d];
                }
                length += (size_t)snprintf(text + length, sizeof text - length,
                                           "Ar %.4f %.4f %.4f %.6f %.6f %.6f\n", place[n][0],
                                           place[n][1] + n, place[n][2], 1e-3 * velocity[n][0],
                                           1e-3 * velocity[n][1], 1e-3 * velocity[n][2]);
            }
        }
        temporary_folder_write(*state, "fast.xyz", text, length);
        MEASURE("fast.xyz", "--window", "10", "-o", "fast");
        const bool warned = strstr(result.err, "too far apart for D by the VACF");
        assert_int_equal(warned, !slow);
    }
}

/// --file-units is of the file of LAMMPS, be it the trajectory or the structure.
static void test_measure_takes_units_of_one_file_when_the_other_has_its_own(void **state) {
    static const char atoms[] = "two atoms\n2\n"
                                "    1ARG     C1    1   0.100   0.100   0.100\n"
                                "    2ARG     C1    2   0.500   0.100   0.100\n"
                                "   3.0 3.0 3.0\n";
    static const char frames[] = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\n"
                                 "ITEM: BOX BOUNDS pp pp pp\n0 30\n0 30\n0 30\n"
                                 "ITEM: ATOMS id type x y z\n1 1 1 1 1\n2 1 5 1 1\n";
    static const char data[] = "LAMMPS\n\n2 atoms\n1 atom types\n\n0 30 xlo xhi\n0 30 ylo yhi\n"
                               "0 30 zlo zhi\n\nMasses\n\n1 39.95\n\nAtoms # molecular\n\n"
                               "1 1 1 1 1 1\n2 2 1 5 1 1\n";
    temporary_folder_write(*state, "two.gro", atoms, sizeof atoms - 1);
    temporary_folder_write(*state, "two.lammpstrj", frames, sizeof frames - 1);
    temporary_folder_write(*state, "two.data", data, sizeof data - 1);
    MEASURE("two.lammpstrj", "-s", "two.gro", "--file-units", "real", "-o", "named", "--quiet");
    assert_close(results_number("named/summary.json", "density"), 2 / 27.0, 1e-9);
    MEASURE("two.gro", "-s", "two.data", "--file-units", "real", "-o", "weighed", "--quiet");
    assert_close(results_number("weighed/summary.json", "density"), 2 / 27.0, 1e-9);
}

static void test_measure_refuses_what_does_not_fit_in_a_line(void **state) {
    write_bad_files(*state);
    for (size_t k = 0; k < sizeof refusals / sizeof *refusals; k++) {
        const char *words[MAX_WORDS + 5] = {"measure", "--quiet", "-o", "bad"};
        for (size_t n = 0; refusals[k].words[n]; n++) {
            const char *const word = refusals[k].words[n];
            words[4 + n] = strcmp(word, "XTC") == 0    ? xtc
                           : strcmp(word, "GRO") == 0  ? gro
                           : strcmp(word, "DUMP") == 0 ? dump
                                                       : word;
        }
        run_program(&result, &(struct run_program_how){0}, words);
        run_program_assert_refused(&result, ".", refusals[k].says[0], 1, refusals[k].says);
        assert_false(temporary_folder_exists("bad/rdf.tsv"));
        assert_false(temporary_folder_exists("bad/target.json"));
    }
}

static void test_measure_spares_what_it_did_not_write(void **state) {
    (void)state;
    MEASURE(xtc, "-s", gro, "-o", "again", "--static", "--quiet");
    MEASURE(xtc, "-s", gro, "-o", "again", "--static", "--quiet"); // may replace itself
    remove("again/used.json");
    RUN_PROGRAM(&result, "measure", xtc, "-s", gro, "-o", "again", "--static", "--quiet");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "--force replaces it, -o OTHER keeps it"); // of what run is it?
    MEASURE(xtc, "-s", gro, "-o", "again", "--static", "--quiet", "--force");
}

/// A .trr has velocities, an .xtc has none; atoms of water are parts of molecules.
static void test_measure_says_why_it_does_not_know_the_temperature(void **state) {
    static const char words[] =
        "unknown temperature (velocities of parts of molecules do not tell it";
    small_inputs_write(*state, "water.json",
                       "{\"molecules\": {\"SOL\": {\"beads\": [\"OW\", \"HW1\", \"HW2\"], "
                       "\"bonds\": {\"OH\": [[1, 2], [1, 3]]}}}}",
                       NULL, NULL);
    MEASURE(trr, "-s", gro, "--molecules", "water.json", "-o", "parts");
    assert_contains(result.err, words);
    assert_contains(result.err, "next: mesofit fit --target parts --temperature T finds ");
    MEASURE(xtc, "-s", gro, "--molecules", "water.json", "-o", "places");
    assert_contains(result.err, "unknown temperature (there are no velocities): give it by");
}

int main(void) {
#define TEST(name) cmocka_unit_test_setup_teardown(name, enter, small_inputs_leave)
    const struct CMUnitTest tests[] = {
        TEST(test_measure_counts_the_pairs_that_there_are),
        TEST(test_measure_names_the_times_that_a_file_has),
        TEST(test_measure_writes_the_same_bytes_when_threads_differ),
        TEST(test_measure_keeps_frames_whose_late_times_are_rounded),
        TEST(test_measure_has_motion_of_the_frames_that_are_used),
        TEST(test_measure_joins_files_when_a_run_was_restarted),
        TEST(test_measure_uses_what_is_whole_when_a_file_breaks_off),
        TEST(test_measure_writes_what_it_has_when_it_is_stopped),
        TEST(test_measure_says_why_it_does_not_know_the_temperature),
        TEST(test_measure_speaks_angstrom_when_asked),
        TEST(test_measure_tells_types_apart_when_the_map_does),
        TEST(test_measure_warns_of_velocities_that_are_far_apart),
        TEST(test_measure_takes_units_of_one_file_when_the_other_has_its_own),
        TEST(test_measure_refuses_what_does_not_fit_in_a_line),
        TEST(test_measure_spares_what_it_did_not_write),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
