// SPDX-License-Identifier: GPL-3.0-or-later
//
// What `mesofit measure` writes, `mesofit fit --target` takes: of one type of beads, of bonds of
// fixed length.
#include "shared/is_close.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FRAMES = 20, TRIMERS = 100 };
static const double edge = 4; // nm

static struct run_program_result result;

static double uniform(void) {
    return (rand() + 0.5) / (RAND_MAX + 1.0);
}

static double normal(void) {
    return sqrt(-2 * log(uniform())) * cos(2 * M_PI * uniform());
}

/// Three at right angles, in any direction.
static void turn(double axis[2][3]) {
    double length = 0, along = 0;
    for (int d = 0; d < 3; d++) {
        axis[0][d] = normal();
        axis[1][d] = normal();
    }
    for (int d = 0; d < 3; d++)
        length += axis[0][d] * axis[0][d];
    for (int d = 0; d < 3; d++)
        axis[0][d] /= sqrt(length);
    for (int d = 0; d < 3; d++)
        along += axis[0][d] * axis[1][d];
    length = 0;
    for (int d = 0; d < 3; d++) {
        axis[1][d] -= along * axis[0][d];
        length += axis[1][d] * axis[1][d];
    }
    for (int d = 0; d < 3; d++)
        axis[1][d] /= sqrt(length);
}

/// How a trimer is made: its types, mean and deviation of its bonds [nm] and of its angle
/// [degrees].
struct trimer {
    const char *type[3];
    double bond, bond_deviation, angle, angle_deviation;
};

static void write_trimer(FILE *file, const struct trimer *trimer) {
    double axis[2][3], place[3][3];
    const double angle = (trimer->angle + trimer->angle_deviation * normal()) * M_PI / 180;
    const double first = trimer->bond + trimer->bond_deviation * normal(),
                 second = trimer->bond + trimer->bond_deviation * normal();
    turn(axis);
    for (int d = 0; d < 3; d++) {
        place[1][d] = edge * uniform();
        place[0][d] = place[1][d] + first * axis[0][d];
        place[2][d] = place[1][d] + second * (cos(angle) * axis[0][d] + sin(angle) * axis[1][d]);
    }
    for (int n = 0; n < 3; n++)
        fprintf(file, "%s %.9f %.9f %.9f\n", trimer->type[n], 10 * place[n][0], 10 * place[n][1],
                10 * place[n][2]);
}

/// A gas of them, in Å.
static void write_gas(const char *name, const struct trimer *trimer) {
    FILE *file = fopen(name, "w");
    srand(5);
    for (int t = 0; t < FRAMES; t++) {
        fprintf(file,
                "%d\nLattice=\"%g 0 0 0 %g 0 0 0 %g\" Properties=species:S:1:pos:R:3 Time=%d\n",
                3 * TRIMERS, 10 * edge, 10 * edge, 10 * edge, 1000 * t);
        for (int m = 0; m < TRIMERS; m++)
            write_trimer(file, trimer);
    }
    fclose(file);
}

static void measure(const char *trajectory) {
    RUN_PROGRAM(&result, "measure", trajectory, "--molecules", "kinds.json", "--bins", "36",
                "--range", "1.8", "--static", "--temperature", "300", "-o", "target", "--force");
    run_program_assert_code(&result, 0);
}

static void explain(void) {
    RUN_PROGRAM(&result, "fit", "--target", "target", "--explain");
    run_program_assert_code(&result, 0);
}

static void test_one_type_keeps_its_name(void **state) {
    write_gas("gas.xyz", &(struct trimer){{"A", "A", "A"}, 0.3, 0.02, 120, 8});
    small_inputs_write(
        *state, "kinds.json",
        "{\"molecules\": {\"trimer\": {\"chain\": {\"beads\": [\"A\", \"A\", \"A\"], "
        "\"bond\": \"AA\", \"angle\": \"AAA\"}}}}\n",
        NULL, NULL);
    measure("gas.xyz");
    explain();
    assert_contains(result.out, "chosen: method \"auto\"");
    assert_null(strstr(result.out, "constraint"));
    small_inputs_write(*state, "kinds.json",
                       "{\"molecules\": {\"trimer\": {\"chain\": {\"type\": \"A\", \"length\": 3, "
                       "\"bond\": \"AA\", \"angle\": \"AAA\"}}}}\n",
                       NULL, NULL);
    measure("gas.xyz");
    explain();
}

/// The number behind a word in a text.
static double number_behind(const char *text, const char *words) {
    const char *found = strstr(text, words);
    assert_non_null(found);
    return strtod(found + strlen(words), NULL);
}

/// Bonds of a deviation of 0.2 % of their length are a constraint: k_B T/(1 % of 0.15 nm)², with
/// 8.314462618 J/(mol K) and 300 K. The angle is found from its distribution.
static void test_constrained_bonds_are_a_known_law(void **state) {
    write_gas("gas.xyz", &(struct trimer){{"A", "B", "A"}, 0.15, 0.0003, 100, 5});
    small_inputs_write(
        *state, "kinds.json",
        "{\"molecules\": {\"trimer\": {\"chain\": {\"beads\": [\"A\", \"B\", \"A\"], "
        "\"bond\": \"AB\", \"angle\": \"ABA\"}}}}\n",
        NULL, NULL);
    measure("gas.xyz");
    assert_contains(result.err, "bond \"AB\": a constraint, of a standard deviation of 0.0003 for");
    explain();
    assert_contains(result.out, "chosen: bond \"AB\": a constraint");
    assert_close_relative(number_behind(result.out, "a harmonic law of k = "),
                          8.314462618e-3 * 300 / (0.0015 * 0.0015), 1e-3);
    assert_null(strstr(result.out, "target bond_lengths"));
    assert_contains(result.out, "target bond_angles.ABA");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_one_type_keeps_its_name),
        TEST(test_constrained_bonds_are_a_known_law),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
