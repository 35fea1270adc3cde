// SPDX-License-Identifier: GPL-3.0-or-later
//
// Force matching from outside: a mixture of chains with bonds, angles and dihedrals, simulated with
// known laws, measured with its forces, comes back; inversions begin with them where they are
// nearer; and what cannot be matched is said in one line.
#include "io/data_table.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct run_program_result result;

static const char scene[] =
    "{\"seed\": 11, \"box\": [3.6, 3.6, 3.6], \"time_step\": 0.005,\n"
    "\"bonds\": {\"backbone\": {\"law\": \"harmonic\", \"k\": 100, \"length\": 0.6}},\n"
    "\"angles\": {\"bend\": {\"law\": \"harmonic\", \"k\": 12, \"angle\": 110}},\n"
    "\"dihedrals\": {\"twist\": {\"law\": \"ryckaert-bellemans\", \"c1\": 1, \"c2\": 1.5}},\n"
    "\"molecules\": {\"chain\": {\"count\": 30, \"chain\": {\"beads\": [\"A\", \"B\", \"B\", "
    "\"A\"],\n"
    "  \"bond\": \"backbone\", \"angle\": \"bend\", \"dihedral\": \"twist\"}}},\n"
    "\"conservative\": {\"A-A\": {\"law\": \"soft-repulsion\", \"a\": 20},\n"
    "  \"A-B\": {\"law\": \"soft-repulsion\", \"a\": 12},\n"
    "  \"B-B\": {\"law\": \"soft-repulsion\", \"a\": 25}},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"measure\": {\"equilibration\": 1000, \"samples\": 60, \"every\": 40},\n"
    "\"snapshots\": {\"every\": 40, \"formats\": [\"lammps-dump\"]}}\n";

/// What is added to target.json to make it a run file.
static const char method[] =
    "{\"seed\": 1, \"unknowns\": {\"potential\": {}}, \"method\": {\"name\": \"force-matching\"},\n"
    "\"verification\": {\"replicas\": 2, \"samples\": 40, \"every\": 20, \"equilibration\": "
    "400},\n";

#define DUMP "truth/snapshots/trajectory.lammpstrj"
#define MEASURE(...)                                                                               \
    RUN_PROGRAM(&result, "measure", __VA_ARGS__, "--static", "--temperature", "120.272",           \
                "--q-range", "0", "--bins", "60", "--range", "1.2", "--force", "-o", "target")

static const char liquid[] =
    "{\"seed\": 3, \"box\": [4, 4, 4], \"time_step\": 0.02, \"particles\": {\"count\": 190},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 12},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"measure\": {\"equilibration\": 400, \"samples\": 60, \"every\": 20},\n"
    "\"snapshots\": {\"every\": 20, \"formats\": [\"lammps-dump\"]}}\n";

/// Chains with an energy of local densities, beside which bonded beads do not count.
static const char crowd[] =
    "{\"seed\": 5, \"box\": [4, 4, 4], \"time_step\": 0.01,\n"
    "\"bonds\": {\"backbone\": {\"law\": \"harmonic\", \"k\": 60, \"length\": 0.6}},\n"
    "\"molecules\": {\"chain\": {\"count\": 65, \"chain\": {\"type\": \"A\", \"length\": 3, "
    "\"bond\": \"backbone\"}}},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 18},\n"
    "\"many_body\": {\"crowd\": {\"weight\": {\"law\": \"sanyal-shell\", \"inner_cutoff\": 0.5,\n"
    "  \"cutoff\": 1.2}, \"energy\": {\"law\": \"polynomial\", \"origin\": 6, \"c1\": -0.6,\n"
    "  \"c2\": 0.15, \"c3\": -0.01}}},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 3},\n"
    "\"measure\": {\"equilibration\": 500, \"samples\": 80, \"every\": 25},\n"
    "\"snapshots\": {\"every\": 25, \"formats\": [\"lammps-dump\"]}}\n";

static int enter(void **state) {
    if (small_inputs_enter_without_gnuplot(state) != 0)
        return -1;
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "truth");
    run_program_assert_code(&result, 0);
    small_inputs_write(*state, "liquid.json", liquid, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "liquid.json", "-o", "liquid");
    run_program_assert_code(&result, 0);
    small_inputs_write(*state, "crowd.json", crowd, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "crowd.json", "-o", "crowd");
    run_program_assert_code(&result, 0);
    return 0;
}

static char contents[1 << 14];

static void read_text(const char *name) {
    FILE *const file = fopen(name, "r");
    assert_non_null(file);
    contents[fread(contents, 1, sizeof contents - 1, file)] = '\0';
    fclose(file);
}

/// Write it as target/run.json, with `to` in place of `from`, if that is not NULL.
static void write_text(const char *all, const char *from, const char *to) {
    const char *const at = from ? strstr(all, from) : NULL;
    FILE *const run = fopen("target/run.json", "w");
    assert_non_null(run);
    assert_true(from == NULL || at);
    if (at)
        fprintf(run, "%.*s%s%s", (int)(at - all), all, to, at + strlen(from));
    else
        fputs(all, run);
    fclose(run);
}

/// target.json with the method before its first key.
static void write_run(const char *from, const char *to) {
    static char all[1 << 15];
    read_text("target/target.json");
    snprintf(all, sizeof all, "%s%s", method, strchr(contents, '{') + 1);
    write_text(all, from, to);
}

/// The same of a run that there is.
static void write_run_again(const char *from, const char *to) {
    read_text("target/run.json");
    write_text(contents, from, to);
}

static double soft(double r, double a) {
    return r < 1 ? 0.5 * a * (1 - r) * (1 - r) : 0;
}

static double truth_of(int n, double q) {
    const double angle = (q - 110) * M_PI / 180, turn = cos((q - 180) * M_PI / 180);
    switch (n) {
    case 0:
        return soft(q, 20);
    case 1:
        return soft(q, 12);
    case 2:
        return soft(q, 25);
    case 3:
        return 50 * (q - 0.6) * (q - 0.6);
    case 4:
        return 6 * angle * angle;
    default:
        return turn + 1.5 * turn * turn;
    }
}

/// rms of what is off over its error, and of what is off [kJ/mol]; U is 0 where it is least.
static void compare(int n, const char *file, size_t error_column, double *z, double *off) {
    struct data_table table;
    double least = 0, sum = 0, squares = 0, count = 0;
    assert_ok(mf_data_table_read(&table, file, 2));
    for (int pass = 0; pass < 2; pass++)
        for (size_t k = 0; k < table.rows; k++) {
            const double *const row = table.values + k * table.columns;
            const double error = row[error_column];
            const double difference = row[1] - truth_of(n, row[0]);
            const bool known = error > 1e-9; // but where U is 0
            if (pass == 0 && n >= 3 && row[1] < 1e-9)
                least = difference;
            if (pass == 0 || !known)
                continue;
            sum += pow((difference - least) / error, 2);
            squares += pow(difference - least, 2);
            count++;
        }
    assert_true(count > 10);
    *z = sqrt(sum / count);
    *off = sqrt(squares / count);
    mf_data_table_clear(&table);
}

static void test_chains_come_back_with_all_their_terms(void **state) {
    static const char *const file[] = {"out/potential_A-A.tsv", "out/potential_A-B.tsv",
                                       "out/potential_B-B.tsv", "out/bonds_backbone.tsv",
                                       "out/angles_bend.tsv",   "out/dihedrals_twist.tsv"};
    double squares = 0;
    (void)state;
    MEASURE(DUMP, "--molecules", "scene.json", "--forces", "1.2");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "of 6 curves, in 16 blocks of 4 frames; their equations take");
    write_run(NULL, NULL);
    RUN_PROGRAM(&result, "fit", "target/run.json", "-o", "out", "--force");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "finished after 1 iterations");
    assert_contains(result.err, "100.0000 % of the mean square of the forces is that of these "
                                "potentials; g(r) was not fitted");
    assert_contains(result.err, "verified: rms of rdf - target");
    for (int n = 0; n < 6; n++) {
        double z, off;
        compare(n, file[n], n < 3 ? 3 : 2, &z, &off);
        print_message("%s: rms z %.2f, off %.2g kJ/mol\n", file[n], z, off);
        assert_true(z < 2);
        assert_true(off < 0.01);
        squares += z * z / 6;
    }
    assert_true(sqrt(squares) < 1.3);
}

/// Beyond its forces a potential would be 0, and known to be.
static void test_forces_that_end_before_the_potential_are_refused(void **state) {
    (void)state;
    MEASURE(DUMP, "--molecules", "scene.json", "--forces", "0.8");
    run_program_assert_code(&result, 0);
    write_run(NULL, NULL);
    RUN_PROGRAM(&result, "fit", "target/run.json", "-o", "out", "--force");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "target.forces: they end at r = 0.8 nm, the potential at 1.2 nm");
}

static void assert_measure_refused(const char *part) {
    run_program_assert_code(&result, 2);
    assert_contains(result.err, part);
}

/// What a fit refuses, it does when it explains itself, too.
static void assert_fit_refused(const char *part) {
    RUN_PROGRAM(&result, "fit", "target/run.json", "--explain");
    assert_measure_refused(part);
    RUN_PROGRAM(&result, "fit", "target/run.json", "-o", "out", "--force");
    assert_measure_refused(part);
}

/// Three atoms of two elements in frames of a dump of LAMMPS.
static void write_dump(struct temporary_folder *folder, int frames, const char *columns,
                       const char *a, const char *b) {
    static char text[1 << 14];
    size_t length = 0;
    for (int t = 0; t < frames; t++)
        length += (size_t)snprintf(text + length, sizeof text - length,
                                   "ITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS "
                                   "pp pp pp\n0 30\n0 30\n0 30\nITEM: ATOMS id element mass x y z "
                                   "%s\n1 Ar 40 1 2 %d %s\n2 Xe 131 5 2 3 %s\n3 Ar 40 9 5 1 %s\n",
                                   t, columns, t, a, b, a);
    temporary_folder_write(folder, "a.dump", text, length);
}

static void measure_dump(void) {
    MEASURE("a.dump", "--file-units", "real", "--forces", "1");
}

/// One iteration of another method from there.
static void test_inversions_begin_with_forces(void **state) {
    (void)state;
    MEASURE(DUMP, "--molecules", "scene.json", "--forces", "1.2");
    write_run("\"force-matching\"", "\"imc\", \"start\": \"forces\", \"iterations\": 1, "
                                    "\"replicas\": 2, \"samples\": 60, \"equilibration\": 40, "
                                    "\"precision\": 0.05");
    RUN_PROGRAM(&result, "fit", "target/run.json", "-o", "out", "--force");
    assert_true(result.code == 0 || result.code == 1);
    assert_true(results_number("out/summary.json", "rdf_rmse") < 0.1);
}

/// Multiply b in target/forces.tsv, as if forces were so many times as large.
static void change_forces(double factor) {
    static char text[1 << 18];
    FILE *file = fopen("target/forces.tsv", "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    file = fopen("target/forces.tsv", "w");
    for (char *rest, *line = strtok_r(text, "\n", &rest); line;
         line = strtok_r(NULL, "\n", &rest)) {
        int column = 0;
        for (char *at = line, *end; line[0] != '#'; at = end, column++) {
            const double number = strtod(at, &end);
            if (end == at)
                break;
            fprintf(file, "%s%.15g", column ? "\t" : "", (column ? factor : 1) * number);
        }
        fprintf(file, line[0] == '#' ? "%s\n" : "\n", line);
    }
    fclose(file);
}

/// A column of out/history.tsv in an iteration.
static double history(size_t iteration, const char *name) {
    struct data_table table;
    assert_ok(mf_data_table_read(&table, "out/history.tsv", 2));
    const size_t column = mf_data_table_find(&table, name);
    assert_true(column > 0 && iteration < table.rows);
    const double value = table.values[iteration * table.columns + column - 1];
    mf_data_table_clear(&table);
    return value;
}

#define AUTO                                                                                       \
    "\"auto\", \"iterations\": 3, \"replicas\": 2, \"samples\": 60, \"equilibration\": 40, "       \
    "\"precision\": 0.05"

/// Forces of pairs and bonds are near at once; those that are three times too large are not, and
/// the fit goes on from what g(r) says.
static void test_auto_goes_on_from_the_nearer_start(void **state) {
    (void)state;
    MEASURE(DUMP, "--molecules", "scene.json", "--forces", "1.2");
    write_run("\"force-matching\"", AUTO);
    RUN_PROGRAM(&result, "fit", "target/run.json", "-o", "out", "--force");
    assert_true(history(0, "forces") == 1);
    assert_true(history(0, "rdf_rms") < 0.05);
    assert_contains(result.err, "begun with the forces of the target, ");
    results_assert_text("out/summary.json", "start.from", "forces");
    for (int wrong = 0; wrong < 2; wrong++) {
        MEASURE("liquid/snapshots/trajectory.lammpstrj", "--forces", "1.2");
        if (wrong)
            change_forces(3);
        write_run("\"force-matching\"", AUTO);
        RUN_PROGRAM(&result, "fit", "target/run.json", "-o", "out", "--force");
        assert_true(result.code == 0 || result.code == 1);
        assert_true(history(0, "forces") == 1);
        print_message("errors of g: %.3f from forces\n", history(0, "rdf_rms"));
        if (!wrong)
            continue;
        assert_true(history(0, "rdf_rms") > 2 * history(1, "rdf_rms"));
        assert_true(history(1, "forces") == 0 && history(2, "forces") == 0);
        assert_contains(result.err, "begun with what g(r) of the target says, nearer than its");
        results_assert_text("out/summary.json", "start.from", "g(r)");
    }
}

/// Σ of ⟨w⟩·c over the nodes of all curves, with the slopes of the truth.
static double find_virial(void) {
    struct data_table table;
    double sum = 0, last = 0;
    int n = 0;
    assert_ok(mf_data_table_read(&table, "target/forces.tsv", 2));
    const size_t blocks = (table.columns - 1) / 2;
    for (size_t row = 0; row < table.rows; row++) {
        const double q = table.values[row * table.columns], small = 1e-5;
        n += q < last;
        last = q;
        const double force = -(truth_of(n, q + small) - truth_of(n, q - small)) / (2 * small);
        for (size_t b = 0; b < blocks && n <= 3; b++)
            sum += force * table.values[row * table.columns + 1 + blocks + b];
    }
    mf_data_table_clear(&table);
    return sum / 61; // frames
}

/// The virial of pairs and bonds is that of the simulation; a pressure that is asked for is had.
static void test_a_pressure_is_met(void **state) {
    static const double density = 120 / (3.6 * 3.6 * 3.6), bar = 16.6053907;
    const double pressure = results_number("truth/summary.json", "pressure");
    (void)state;
    MEASURE(DUMP, "--molecules", "scene.json", "--forces", "1.2");
    const double found = density + find_virial();
    print_message("pressure %.3f of the simulation, %.3f of the virial\n", pressure, found);
    assert_true(fabs(found - pressure) < 0.02 * pressure);
    write_run("\"forces\"", "\"pressure\": {\"value\": 200, \"error\": 1}, \"forces\"");
    RUN_PROGRAM(&result, "fit", "target/run.json", "-o", "out", "--force");
    run_program_assert_code(&result, 0);
    const double had = results_number("out/summary.json", "pressure");
    print_message("pressure %.1f bar of 200, %.1f without\n", had, bar * pressure);
    assert_true(fabs(had - 200) < 0.2 * fabs(bar * pressure - 200));
}

#define MEASURE_CROWD(...)                                                                         \
    MEASURE("crowd/snapshots/trajectory.lammpstrj", "--molecules", "crowd.json",                   \
            "--weighted-density", "0.5,1.2", __VA_ARGS__)

#define SOUGHT                                                                                     \
    "\"many_body\": {\"crowd\": {\"weight\": {\"law\": \"sanyal-shell\", \"inner_cutoff\": 0.5, "  \
    "\"cutoff\": 1.2}"

/// The curvature of f, which no convention changes; rms of what is off where its error is known. By
/// the convention that f has no slope its error is no larger than its noise.
static double compare_curvatures(const char *file) {
    struct data_table table;
    double squares = 0, count = 0;
    assert_ok(mf_data_table_read(&table, file, 2));
    const double width = table.values[3] - table.values[0];
    for (size_t row = 1; row + 1 < table.rows; row++) {
        const double *const at = table.values + row * 3;
        if (!isfinite(at[-1]) || !isfinite(at[5]))
            continue;
        assert_true(at[2] < 0.01);
        const double curvature = (at[-2] - 2 * at[1] + at[4]) / (width * width);
        squares += pow(curvature - (0.3 - 0.06 * (at[0] - 6)), 2);
        count++;
    }
    mf_data_table_clear(&table);
    assert_true(count > 10);
    return sqrt(squares / count);
}

/// f and Φ of chains come back together; pairs alone explain less, and know nothing of the density.
static void test_an_energy_of_densities_comes_back(void **state) {
    (void)state;
    MEASURE_CROWD("--forces", "1.2");
    run_program_assert_code(&result, 0);
    write_run("\"fitted\":\t\"no\",", "");
    write_run_again("\"scene\":\t{", "\"scene\": {" SOUGHT "}},");
    RUN_PROGRAM(&result, "fit", "target/run.json", "-o", "out", "--force");
    run_program_assert_code(&result, 0);
    assert_contains(result.err, "100.0000 % of the mean square of the forces");
    const double off = compare_curvatures("out/many_body_crowd.tsv");
    print_message("curvature of f off by %.2g of 0.3 kJ/mol\n", off);
    assert_true(off < 0.01);
    const double pressure = results_number("out/summary.json", "pressure");
    write_run_again("\"forces\"", "\"pressure\": {\"value\": 60, \"error\": 1}, \"forces\"");
    RUN_PROGRAM(&result, "fit", "target/run.json", "-o", "out", "--force");
    const double had = results_number("out/summary.json", "pressure");
    const double left = 1 - history(0, "explained");
    print_message("pressure %.1f bar of 60, %.1f without, for %.2f %% of the forces\n", had,
                  pressure, 100 * left);
    assert_true(fabs(had - 60) < 0.3 * fabs(pressure - 60));
    assert_true(left < 0.024); // 0.0265 where pairs make up for it without f
    write_run(NULL, NULL);
    RUN_PROGRAM(&result, "fit", "target/run.json", "-o", "out", "--force");
    assert_contains(result.err, "% of the mean square of the forces");
    assert_true(strstr(result.err, "100.0000 %") == NULL);
}

/// f alone, beside pairs whose law is known.
static const char alone[] =
    "{\"seed\": 1, \"units\": \"nm-ps\", \"method\": {\"name\": \"force-matching\"}, \"target\": "
    "{\n"
    "\"weighted_density\": {\"file\": \"weighted_density.tsv\", \"inner_cutoff\": 0.5, \"cutoff\": "
    "1.2},\n"
    "\"forces\": {\"file\": \"forces.tsv\", \"gram_file\": \"forces_gram.tsv\"}},\n"
    "\"scene\": {\"density\": 3.05, \"particles\": {\"count\": 1000}, \"temperature\": 120.272,\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 18, \"cutoff\": 1}, " SOUGHT "}}}}";

static void test_densities_that_cannot_be_matched_are_said(void **state) {
    (void)state;
    MEASURE_CROWD("--forces", "1.1");
    assert_measure_refused("--forces 1.1: they must reach as far as --weighted-density, 1.2 nm");
    MEASURE_CROWD("--forces", "1.2");
    write_run("\"scene\":\t{", "\"scene\": {" SOUGHT ", \"energy\": {\"law\": \"polynomial\", "
                               "\"c2\": 0.1}}},");
    assert_fit_refused("scene.many_body: the forces of a local density whose energy is known");
    write_text(alone, NULL, NULL);
    assert_fit_refused("scene.conservative: the forces of pairs whose law is known");
    MEASURE("crowd/snapshots/trajectory.lammpstrj", "--molecules", "crowd.json", "--forces", "1.2");
    RUN_PROGRAM(&result, "measure", "crowd/snapshots/trajectory.lammpstrj", "--molecules",
                "crowd.json", "--weighted-density", "0.5,1.2", "--static", "--temperature",
                "120.272", "--q-range", "0", "--bins", "60", "--range", "1.2", "-o", "density");
    write_run("\"rdf\":", "\"weighted_density\": {\"file\": \"../density/weighted_density.tsv\", "
                          "\"inner_cutoff\": 0.5, \"cutoff\": 1.2}, \"rdf\":");
    write_run_again("\"scene\":\t{", "\"scene\": {" SOUGHT "}},");
    assert_fit_refused("target.forces: it has no local density with the weight of \"crowd\": "
                       "measure --forces and --weighted-density together");
}

static void test_forces_that_cannot_be_matched_are_said(void **state) {
    write_dump(*state, 12, "", "", "");
    measure_dump();
    assert_measure_refused("a.dump: has no forces, which --forces needs: of GROMACS a .trr");
    write_dump(*state, 12, "fx fy fz", "0 0 0", "0 0 0");
    measure_dump();
    assert_measure_refused("a.dump: frame 0: all forces are 0: --forces needs those of the");
    write_dump(*state, 12, "fx fy fz", "1 2 3", "0 0 0");
    measure_dump();
    assert_measure_refused("a.dump: frame 0: the forces of all beads \"Xe\" are 0");
    write_dump(*state, 12, "fx fy fz", "1e200 2 3", "2 1 0");
    measure_dump();
    assert_measure_refused("its forces are too large");
    write_dump(*state, 12, "fx", "1", "2");
    measure_dump();
    assert_measure_refused("a.dump: has no forces, which --forces needs");
    write_dump(*state, 1, "fx fy fz", "1 2 3", "2 1 0");
    measure_dump();
    assert_measure_refused("a.dump: 1 frame with forces tells no errors: --forces needs 8 or more");
    write_dump(*state, 2, "fx fy fz", "1 2 3", "2 1 0");
    measure_dump();
    assert_measure_refused("a.dump: 2 frames with forces tell no errors: --forces needs 8 or more");
    write_dump(*state, 12, "fx fy fz", "1 2 x", "2 1 0");
    measure_dump();
    assert_measure_refused("a.dump:10: frame 0: a force is not a finite number");
    write_dump(*state, 12, "fx fy fz", "1 2 3", "2 1 0");
    MEASURE("a.dump", "--file-units", "real", "--forces", "1.6");
    assert_measure_refused("the range of --forces");
    MEASURE("a.dump", "--file-units", "real", "--forces", "-1");
    assert_measure_refused("--forces takes a number above 0");
}

/// What a reader cannot see in one frame, or in the frames alone.
static void test_forces_of_some_frames_and_atoms_are_said(void **state) {
    static char text[1 << 14];
    (void)state;
    write_dump(*state, 12, "fx fy fz", "1 2 3", "2 1 0");
    MEASURE("a.dump", "--forces", "1");
    assert_measure_refused("a.dump: the file has no units: give them by --file-units");
    FILE *file = fopen("a.dump", "r");
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    for (char *at = text; (at = strstr(at, "3 Ar 40 9 5 1 1 2 3")) != NULL; at++)
        memcpy(at, "3 Ar 40 9 5 1 0 0 0", 19);
    temporary_folder_write(*state, "a.dump", text, strlen(text));
    measure_dump();
    assert_measure_refused("a.dump: the forces of 1 of 3 beads are 0 in all frames");
    for (char *at = strstr(text, "TIMESTEP\n11\n"); (at = strstr(at, " 1 2 3\n")) != NULL; at++)
        memcpy(at, " 0 0 0", 6);
    for (char *at = strstr(text, "TIMESTEP\n11\n"); (at = strstr(at, " 2 1 0\n")) != NULL; at++)
        memcpy(at, " 0 0 0", 6);
    temporary_folder_write(*state, "a.dump", text, strlen(text));
    measure_dump();
    assert_measure_refused("a.dump: frame 11: all forces are 0: give frames that have them");
}

static void test_a_fit_without_the_forces_is_refused(void **state) {
    (void)state;
    MEASURE(DUMP, "--molecules", "scene.json");
    run_program_assert_code(&result, 0);
    write_run(NULL, NULL);
    assert_fit_refused("\"force-matching\" needs the forces of a trajectory: \"mesofit measure "
                       "--forces R\" keeps them");
    write_run("\"force-matching\"", "\"imc\", \"start\": \"forces\"");
    assert_fit_refused("method.start: \"forces\" needs a target that");
    MEASURE(DUMP, "--molecules", "scene.json", "--forces", "1.2");
    write_run("forces_gram.tsv", "rdf_A-A.tsv");
    assert_fit_refused("rdf_A-A.tsv: its rows and columns are not those of the other file");
    write_run("\"forces.tsv\"", "\"rdf_A-A.tsv\"");
    assert_fit_refused("rdf_A-A.tsv: its heading does not fit its rows and columns");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_chains_come_back_with_all_their_terms),
        cmocka_unit_test(test_forces_that_end_before_the_potential_are_refused),
        cmocka_unit_test(test_inversions_begin_with_forces),
        cmocka_unit_test(test_auto_goes_on_from_the_nearer_start),
        cmocka_unit_test(test_a_pressure_is_met),
        cmocka_unit_test(test_an_energy_of_densities_comes_back),
        cmocka_unit_test(test_densities_that_cannot_be_matched_are_said),
        cmocka_unit_test(test_forces_that_cannot_be_matched_are_said),
        cmocka_unit_test(test_forces_of_some_frames_and_atoms_are_said),
        cmocka_unit_test(test_a_fit_without_the_forces_is_refused),
    };
    return cmocka_run_group_tests(tests, enter, small_inputs_leave);
}
