// SPDX-License-Identifier: GPL-3.0-or-later
//
// Frames of a mixture with a known law, as GROMACS's .trr and as H5MD, through a whole fit: measure
// with the forces, force matching, its potentials.
#include "io/data_table.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <hdf5.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { ATOMS = 150, FRAMES = 24 };

static const double edge = 3, strength[3] = {60, 35, 80}; // of A-A, A-B, B-B [kJ/mol]
static struct run_program_result result;
static double position[FRAMES][ATOMS][3], force[FRAMES][ATOMS][3]; // [nm], [kJ/mol/nm]

static bool is_b(int atom) {
    return atom % 3 == 0;
}

static double law_of(int pair, double r) {
    return r < 1 ? 0.5 * strength[pair] * (1 - r) * (1 - r) : 0;
}

static double next_number(void) {
    static uint64_t state = 7;
    state = state * 6364136223846793005u + 1442695040888963407u;
    return (double)(state >> 11) / 9007199254740992.0;
}

/// Beads anywhere, with the forces that they have on each other.
static void fill(void) {
    for (int t = 0; t < FRAMES; t++) {
        for (int k = 0; k < ATOMS; k++)
            for (int d = 0; d < 3; d++)
                position[t][k][d] = edge * next_number();
        for (int i = 0; i < ATOMS; i++)
            for (int j = 0; j < i; j++) {
                double way[3], square = 0;
                for (int d = 0; d < 3; d++) {
                    way[d] = position[t][i][d] - position[t][j][d];
                    way[d] -= edge * rint(way[d] / edge);
                    square += way[d] * way[d];
                }
                const double r = sqrt(square);
                for (int d = 0; r < 1 && d < 3; d++) {
                    const double push = strength[is_b(i) + is_b(j)] * (1 - r) * way[d] / r;
                    force[t][i][d] += push;
                    force[t][j][d] -= push;
                }
            }
    }
}

// Files -------------------------------------------------------------------------------------------

static void write_structure(void) {
    FILE *const gro = fopen("conf.gro", "w");
    fprintf(gro, "mixture\n%d\n", ATOMS);
    for (int k = 0; k < ATOMS; k++) {
        fprintf(gro, "%5d%-5s%5s%5d", k + 1, is_b(k) ? "B" : "A", is_b(k) ? "B" : "A", k + 1);
        for (int d = 0; d < 3; d++)
            fprintf(gro, "%8.3f", position[0][k][d]);
        fputc('\n', gro);
    }
    fprintf(gro, "%g %g %g\n", edge, edge, edge);
    fclose(gro);
}

static void put_integer(FILE *file, uint32_t number) {
    for (int shift = 24; shift >= 0; shift -= 8)
        fputc((int)(number >> shift & 0xff), file);
}

static void put_float(FILE *file, double number) {
    const float single = (float)number;
    uint32_t bits;
    memcpy(&bits, &single, sizeof bits);
    put_integer(file, bits);
}

static void write_trr(void) {
    enum { BOX = 9 * 4, VECTORS = ATOMS * 3 * 4 };
    FILE *const trr = fopen("a.trr", "wb");
    for (int t = 0; t < FRAMES; t++) {
        const uint32_t sizes[] = {0,       0, BOX,     0,     0,           0, 0,
                                  VECTORS, 0, VECTORS, ATOMS, (uint32_t)t, 0};
        put_integer(trr, 1993);
        put_integer(trr, 13);
        put_integer(trr, 12);
        fwrite("GMX_trn_file", 1, 12, trr);
        for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
            put_integer(trr, sizes[k]);
        put_float(trr, t);
        put_float(trr, 0);
        for (int k = 0; k < 9; k++)
            put_float(trr, k % 4 == 0 ? edge : 0);
        for (int k = 0; k < 3 * ATOMS; k++)
            put_float(trr, position[t][k / 3][k % 3]);
        for (int k = 0; k < 3 * ATOMS; k++)
            put_float(trr, force[t][k / 3][k % 3]);
    }
    fclose(trr);
}

static hid_t make_group(hid_t place, const char *name) {
    return H5Gcreate(place, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
}

static void write_texts(hid_t object, const char *name, const char *text, hsize_t count) {
    char texts[3][32] = {"", "", ""};
    const hid_t type = H5Tcopy(H5T_C_S1),
                space = count > 1 ? H5Screate_simple(1, &count, NULL) : H5Screate(H5S_SCALAR);
    for (hsize_t k = 0; k < count; k++)
        snprintf(texts[k], sizeof texts[k], "%s", text);
    H5Tset_size(type, sizeof texts[0]);
    const hid_t attribute = H5Acreate(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Awrite(attribute, type, texts) >= 0);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
}

static void put(hid_t place, const char *name, int rank, const hsize_t *size, const double *numbers,
                const char *unit) {
    const hid_t space = H5Screate_simple(rank, size, NULL);
    const hid_t dataset =
        H5Dcreate(place, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers) >= 0);
    write_texts(dataset, "unit", unit, 1);
    H5Dclose(dataset);
    H5Sclose(space);
}

/// Values with times.
static void write_element(hid_t place, const char *name, const double *values, const char *unit) {
    const hsize_t vectors[] = {FRAMES, ATOMS, 3}, frames = FRAMES;
    double time[FRAMES];
    for (int t = 0; t < FRAMES; t++)
        time[t] = t;
    const hid_t group = make_group(place, name);
    put(group, "value", 3, vectors, values, unit);
    put(group, "step", 1, &frames, time, "");
    put(group, "time", 1, &frames, time, "ps");
    H5Gclose(group);
}

static void write_h5md(void) {
    static double small[FRAMES][ATOMS][3]; // in angstrom
    const double edges[3] = {10 * edge, 10 * edge, 10 * edge};
    const hsize_t three = 3;
    const hid_t file = H5Fcreate("a.h5", H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t particles = make_group(file, "particles"), group = make_group(particles, "all"),
                box = make_group(group, "box");
    for (int n = 0; n < FRAMES * ATOMS * 3; n++)
        (&small[0][0][0])[n] = 10 * (&position[0][0][0])[n];
    write_element(group, "position", &small[0][0][0], "Angstrom");
    for (int n = 0; n < FRAMES * ATOMS * 3; n++)
        (&small[0][0][0])[n] = 0.1 * (&force[0][0][0])[n];
    write_element(group, "force", &small[0][0][0], "kJ mol-1 Angstrom-1");
    write_texts(box, "boundary", "periodic", 3);
    put(box, "edges", 1, &three, edges, "Angstrom");
    H5Gclose(box);
    H5Gclose(group);
    H5Gclose(particles);
    H5Fclose(file);
}

// The fit -----------------------------------------------------------------------------------------

/// target.json with the method before its first key.
static void write_run(void) {
    static char text[1 << 14];
    FILE *file = fopen("target/target.json", "r");
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    file = fopen("target/run.json", "w");
    fprintf(file,
            "{\"seed\": 1, \"unknowns\": {\"potential\": {}}, \"method\": {\"name\": "
            "\"force-matching\"}, \"verification\": {\"replicas\": 2, \"samples\": 20, \"every\": "
            "5, \"equilibration\": 40},\n%s",
            strchr(text, '{') + 1);
    fclose(file);
}

static double find_deviation(int pair, const char *name) {
    struct data_table table;
    double sum = 0, count = 0;
    assert_ok(mf_data_table_read(&table, name, 2));
    for (size_t k = 0; k < table.rows; k++) {
        const double *const row = table.values + k * table.columns;
        if (row[0] < 0.3 || row[0] > 1)
            continue;
        sum += pow(row[1] - law_of(pair, row[0]), 2);
        count++;
    }
    mf_data_table_clear(&table);
    assert_true(count > 20);
    return sqrt(sum / count);
}

static void test_known_laws_come_back_from_each_format(void **state) {
    static const char *const files[] = {"a.trr", "a.h5"}, *const names[] = {
                                                              "out/potential_A-A.tsv",
                                                              "out/potential_A-B.tsv",
                                                              "out/potential_B-B.tsv"};
    fill();
    write_structure();
    write_trr();
    write_h5md();
    small_inputs_write(*state, "map.json",
                       "{\"masses\": {\"A\": 10, \"B\": 10}, \"beads\": {\"A\": {\"residue\": "
                       "\"A\"}, \"B\": {\"residue\": \"B\"}}}",
                       NULL, NULL);
    for (int k = 0; k < 2; k++) {
        RUN_PROGRAM(&result, "measure", files[k], "-s", "conf.gro", "--map", "map.json", "--forces",
                    "1.2", "--range", "1.2", "--bins", "60", "--q-range", "0", "--static",
                    "--temperature", "300", "--force", "-o", "target");
        run_program_assert_code(&result, 0);
        write_run();
        RUN_PROGRAM(&result, "fit", "target/run.json", "-o", "out", "--force");
        run_program_assert_code(&result, 0);
        assert_contains(result.err, "100.0000 % of the mean square of the forces");
        for (int pair = 0; pair < 3; pair++) {
            const double off = find_deviation(pair, names[pair]);
            print_message("%s: %s off by %.2g kJ/mol\n", files[k], names[pair], off);
            assert_true(off < 0.01);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_known_laws_come_back_from_each_format,
                                        small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
