// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files in nm-ps and angstrom-fs: the same physics as in reduced units, and results that speak as
// the files do. Factors are those of λ = 0.7 nm, 300 K and 54 u, by
//   k_B T_0 = 8.31446261815324e-3 kJ/mol/K · T_0 and τ/ps = λ/nm sqrt(μ/u · (kJ/mol)/k_B T_0),
// since 1 u nm²/ps² is 1 kJ/mol.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include "io/units_text.h"

#include <glob.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { TEXT_SIZE = 4096, ROWS = 81 };
static const double lambda = 0.7, kelvins = 300, mass = 54;

static struct run_program_result result;

/// What lengths, energies, times and masses are in a system.
struct scale {
    const char *system;
    double length, energy, time, mass, temperature, pressure;
};

static struct scale scale_of(const char *system) {
    const double energy = 8.31446261815324e-3 * kelvins;
    const double pressure = 16.6053906717 * energy / (lambda * lambda * lambda); // bar
    struct scale scale = {system, lambda,  energy,  lambda * sqrt(mass / energy),
                          mass,   kelvins, pressure};
    if (strcmp(system, "angstrom-fs") == 0) {
        scale.length *= 10;
        scale.energy /= 4.184;
        scale.time *= 1e3;
        scale.pressure /= 1.01325;
    }
    return scale;
}

static const struct scale reduced = {"reduced", 1, 1, 1, 1, 1, 1};

/// "units" with the whole scale; nothing in a reduced file.
static void write_units(const struct scale *s, char *text, size_t size) {
    text[0] = '\0';
    if (strcmp(s->system, "reduced") != 0)
        snprintf(text, size,
                 "\"units\": {\"system\": \"%s\", \"length\": %.17g, \"temperature\": %.17g, "
                 "\"mass\": %.17g},\n",
                 s->system, s->length, s->temperature, s->mass);
}

/// A mixture with laws of every kind, a force beside the pairs, and what observables ask.
static void write_scene(struct temporary_folder *folder, const char *name, const struct scale *s) {
    char text[TEXT_SIZE], units[512];
    const double edge = 3 * s->length;
    write_units(s, units, sizeof units);
    snprintf(
        text, sizeof text,
        "{\"seed\": 7, %s\"box\": [%.17g, %.17g, %.17g],\n"
        "\"particles\": {\"types\": {\"A\": 41, \"B\": 40},\n"
        "    \"mass\": {\"A\": %.17g, \"B\": {\"minimum\": %.17g, \"maximum\": %.17g}}},\n"
        "\"temperature\": %.17g, \"time_step\": %.17g,\n"
        "\"conservative\": {\"A-A\": {\"law\": \"soft-repulsion\", \"a\": %.17g, \"cutoff\": "
        "%.17g},\n"
        "    \"A-B\": {\"law\": \"expression\", \"formula\": \"%.17g*(1 - r/%.17g)^2\", "
        "\"cutoff\": %.17g},\n"
        "    \"B-B\": {\"law\": \"table\", \"file\": \"%s.tsv\"}},\n"
        "\"interactions\": {\"harmonic-trap\": {\"stiffness\": [%.17g, 0, 0], \"centre\": "
        "[%.17g, 0, 0]}},\n"
        "\"dynamics\": {\"integrator\": \"velocity-verlet\"},\n"
        "\"measure\": {\"equilibration\": 10, \"samples\": 4, \"every\": 10},\n"
        "\"rdf\": {\"range\": %.17g}, \"snapshots\": {\"every\": 20, \"formats\": [\"json\"]},\n"
        "\"structure_factor\": {\"q_maximum\": %.17g}, \"motion\": {\"every\": 2, \"lags\": 5}}\n",
        units, edge, edge, edge, s->mass, 2 * s->mass, 3 * s->mass, s->temperature, 0.01 * s->time,
        25 * s->energy / s->length, s->length, 12 * s->energy, s->length, s->length, s->system,
        s->energy / (s->length * s->length), s->length, s->length, 8 / s->length);
    small_inputs_write(folder, name, text, NULL, NULL);
    size_t length = 0;
    for (int k = 0; k < 6; k++)
        length += (size_t)snprintf(text + length, sizeof text - length, "%.17g %.17g\n",
                                   0.2 * k * s->length, 10 * (1 - 0.2 * k) * s->energy);
    char table[64];
    snprintf(table, sizeof table, "%s.tsv", s->system);
    small_inputs_write(folder, table, text, NULL, NULL);
}

/// The numbers of a table, all after each other.
static size_t read_numbers(const char *file, double *values, size_t max) {
    char *text = temporary_folder_read(file), *rest, *at = text;
    size_t count = 0;
    while (*at == '#')
        at = strchr(at, '\n') + 1;
    for (double value; count < max; at = rest) {
        value = strtod(at, &rest);
        if (rest == at)
            break;
        values[count++] = value;
    }
    free(text);
    return count;
}

/// The last configuration and the summary of the same scene, each converted by hand.
static void assert_same_physics(const struct scale *s) {
    static double first[10 * ROWS], other[10 * ROWS];
    char file[256];
    const size_t count = read_numbers("reduced/configuration.tsv", first, 10 * ROWS);
    snprintf(file, sizeof file, "%s/configuration.tsv", s->system);
    assert_int_equal(count, 7 * ROWS); // x y z, velocities, mass
    assert_int_equal(read_numbers(file, other, 10 * ROWS), count);
    for (size_t k = 0; k < count; k++) {
        const double factor = k % 7 < 3 ? s->length : k % 7 < 6 ? s->length / s->time : s->mass;
        assert_close(other[k] / factor, first[k], 1e-7);
    }
    const struct {
        const char *key;
        double factor;
    } keys[] = {{"temperature", s->temperature},
                {"potential_energy", s->energy},
                {"pressure", s->pressure},
                {"motion.diffusion_msd", s->length * s->length / s->time},
                {"motion.fit_end", s->time}};
    snprintf(file, sizeof file, "%s/summary.json", s->system);
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
        assert_close_relative(results_number(file, keys[k].key) / keys[k].factor,
                              results_number("reduced/summary.json", keys[k].key), 1e-6);
    results_assert_text(file, "units.system", s->system);
    assert_close_relative(results_number(file, "units.time"), s->time, 1e-9);
}

static void simulate(const char *scene, const char *folder) {
    RUN_PROGRAM(&result, "simulate", scene, "-o", folder, "--quiet", "--threads", "1");
    run_program_assert_code(&result, 0);
}

static void test_scenes_are_the_same_physics_in_all_units(void **state) {
    const struct scale scales[] = {reduced, scale_of("nm-ps"), scale_of("angstrom-fs")};
    for (int k = 0; k < 3; k++) {
        write_scene(*state, "scene.json", &scales[k]);
        simulate("scene.json", scales[k].system);
    }
    assert_same_physics(&scales[1]);
    assert_same_physics(&scales[2]);
}

/// used.json is a file in the same units, and a run of it the same to the last bit.
static void test_used_json_of_physical_units_gives_the_same_bits(void **state) {
    static const char *const same[] = {"used.json",  "thermodynamics.tsv", "configuration.tsv",
                                       "motion.tsv", "rdf_A-B.tsv",        NULL};
    const struct scale s = scale_of("angstrom-fs");
    write_scene(*state, "scene.json", &s);
    simulate("scene.json", "first");
    simulate("first/used.json", "second");
    results_assert_same("first", "second", same);
}

/// The numbers of a line, all after each other.
static size_t numbers_of(const char *line, double *values, size_t max) {
    size_t count = 0;
    char *rest;
    for (double value; count < max; line = rest) {
        value = strtod(line, &rest);
        if (rest == line)
            break;
        values[count++] = value;
    }
    return count;
}

/// The same physics in two units side by side: but for index and seconds, the rows are the same.
static void test_compare_tells_all_in_the_units_of_the_first(void **state) {
    enum { MAX = 32, SECONDS = 1 };
    const struct scale scales[] = {scale_of("nm-ps"), scale_of("angstrom-fs")};
    for (int k = 0; k < 2; k++) {
        write_scene(*state, "scene.json", &scales[k]);
        simulate("scene.json", scales[k].system);
    }
    RUN_PROGRAM(&result, "compare", "nm-ps", "angstrom-fs", "-o", "both");
    run_program_assert_code(&result, 0);
    char *text = temporary_folder_read("both/compare.tsv");
    assert_contains(text, "pressure[bar]");
    char *second = strrchr(text, '\n');
    *second = '\0'; // the last line end
    second = strrchr(text, '\n');
    *second++ = '\0';
    double first_row[MAX], second_row[MAX];
    const size_t count = numbers_of(strrchr(text, '\n') + 1, first_row, MAX);
    assert_true(count > 8);
    assert_int_equal(numbers_of(second, second_row, MAX), count);
    for (size_t k = SECONDS + 1; k < count; k++)
        assert_close_relative(second_row[k], first_row[k], 1e-6);
    free(text);
}

/// No table of a run in nm has a reduced unit in the names of its columns.
static void assert_speaks_physical_units(const char *folder) {
    static const char *const words[] = {"[lambda", "lambda]", "tau", "k_B", "T_0", "mu/"};
    char pattern[256];
    glob_t found;
    snprintf(pattern, sizeof pattern, "%s/*.tsv", folder);
    assert_int_equal(glob(pattern, 0, NULL, &found), 0);
    for (size_t k = 0; k < found.gl_pathc; k++) {
        char *text = temporary_folder_read(found.gl_pathv[k]), *rest;
        for (char *line = strtok_r(text, "\n", &rest); line && *line == '#';
             line = strtok_r(NULL, "\n", &rest))
            for (size_t n = 0; n < sizeof words / sizeof *words; n++)
                if (strstr(line, words[n]))
                    fail_msg("%s: %s", found.gl_pathv[k], line);
        free(text);
    }
    globfree(&found);
}

static void test_tables_of_simulations_speak_physical_units(void **state) {
    const struct scale s = scale_of("nm-ps");
    write_scene(*state, "scene.json", &s);
    simulate("scene.json", "out");
    assert_speaks_physical_units("out");
}

/// A fit of Φ, ω's σ and the trap by one generation, to what another scene in nm shows.
static void test_fits_speak_physical_units(void **state) {
    small_inputs_write(
        *state, "scene.json",
        "{\"seed\": 7, \"units\": \"nm-ps\", \"box\": [2.1, 2.1, 2.1],\n"
        "\"particles\": {\"count\": 81, \"mass\": 54}, \"temperature\": 300, \"time_step\": 0.05,\n"
        "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 89, \"cutoff\": 0.7},\n"
        "\"dissipative\": {\"law\": \"power\", \"sigma\": 12, \"cutoff\": 0.7},\n"
        "\"rdf\": {\"range\": 1.0, \"bins\": 20}, \"motion\": {\"every\": 4, \"lags\": 10},\n"
        "\"measure\": {\"equilibration\": 50, \"samples\": 40, \"every\": 10}}\n",
        NULL, NULL);
    simulate("scene.json", "out");
    small_inputs_write(
        *state, "run.json",
        "{\"seed\": 3, \"units\": \"nm-ps\",\n"
        "\"target\": {\"rdf\": {\"file\": \"out/rdf.tsv\"}, \"msd\": {\"file\": "
        "\"out/motion.tsv\"},\n"
        "    \"pressure\": {\"value\": 300, \"error\": 10, \"fitted\": \"no\"},\n"
        "    \"diffusion\": {\"value\": 0.1, \"error\": 0.01, \"fitted\": \"no\"}},\n"
        "\"unknowns\": {\"potential\": {\"coefficients\": 5}, \"numbers\": {\"dissipative.sigma\": "
        "{\"minimum\": 5, \"maximum\": 20}}},\n"
        "\"scene\": {\"box\": [2.1, 2.1, 2.1], \"particles\": {\"count\": 81, \"mass\": 54},\n"
        "    \"temperature\": 300, \"time_step\": 0.05,\n"
        "    \"dissipative\": {\"law\": \"power\", \"sigma\": 12, \"cutoff\": 0.7}},\n"
        "\"method\": {\"name\": \"genetic\", \"population\": 4, \"generations\": 1,\n"
        "\"equilibration\": 20, \"samples\": 20, \"every\": 10, \"temperature_tolerance\": 0.5},\n"
        "\"verification\": {\"replicas\": 2, \"equilibration\": 20, \"samples\": 20, \"every\": "
        "10}}\n",
        NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "fit");
    assert_in_range(result.code, 0, 1);
    assert_speaks_physical_units("fit");
    const double sigma = results_parameter("fit/summary.json", "dissipative.sigma", "value");
    assert_true(sigma >= 5 && sigma <= 20);
    assert_true(fabs(results_number("fit/summary.json", "temperature") - 300) < 60);
    // A cube of λ holds three beads: (3 · 2.1³/81)^(1/3) nm.
    assert_close_relative(results_number("fit/summary.json", "units.length"), 2.1 * cbrt(3.0 / 81),
                          1e-14);
    results_assert_number("fit/summary.json", "units.mass", 54);
    assert_non_null(strstr(result.err, "nm-ps: lambda = 0.7 nm, T_0 = 300 K, mu = 54 u"));
    assert_non_null(strstr(result.err, " bar"));
    assert_non_null(strstr(result.err, " kJ/mol"));
}

#define BOX "\"box\": [3, 3, 3], \"particles\": {\"count\": 81}"
#define REDUCED(length)                                                                            \
    "\"units\": {\"length\": " length ", \"temperature\": 300, \"mass\": 3e-26}, "
#define PHYSICAL "\"units\": \"nm-ps\", \"time_step\": 0.01, "

static void test_bad_units_are_one_line_with_file_and_key(void **state) {
    static const struct {
        const char *scene, *message;
    } bad[] = {
        {"{\"units\": \"nm-fs\", " BOX "}", "scene.json: units: \"nm-fs\" is unknown"},
        {"{\"units\": {\"system\": \"si\"}, \"temperature\": 300, " BOX "}",
         "scene.json: units.system: \"si\" is unknown"},
        {"{\"units\": \"nm-ps\", " BOX "}", "scene.json: temperature: missing"},
        {"{\"units\": \"nm-ps\", \"temperature\": 0, \"dynamics\": {\"integrator\": "
         "\"brownian\"}, " BOX "}",
         "scene.json: temperature: 0 K gives no unit of energy"},
        {"{" PHYSICAL "\"temperature\": 300, \"box\": [3, 3, 3], \"particles\": {\"count\": 81, "
         "\"mass\": -5}}",
         "scene.json: particles.mass: -5 is out of range; allowed: above 0 u"},
        {"{" PHYSICAL "\"temperature\": 300, \"box\": [-3, 3, 3], \"particles\": {\"count\": 81}}",
         "scene.json: box[0]: -3 is out of range; allowed: above 0"},
        {"{" PHYSICAL "\"temperature\": 300, \"box\": [1.9, 3, 3], \"particles\": {\"count\": 81}, "
         "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 50, \"cutoff\": 1}}",
         "scene.json: the box is too small: its shortest edge 1.9 nm is below twice the cutoff 1 "
         "nm"},
        {"{" PHYSICAL "\"temperature\": 300, \"box\": [0.3, 0.3, 0.3], \"particles\": {\"count\": "
         "81, \"mass\": 18}}",
         "scene.json: box: 18 u a bead make 89.7 g/cm^3"},
        {"{" PHYSICAL "\"temperature\": 300, \"box\": [3, 3, 3], \"particles\": {\"count\": 81, "
         "\"mass\": 2.99e-26}}",
         "scene.json: particles.mass: 2.99e-26 u is less than any atom has: masses are "
         "in u, which is g/mol; 1 kg is 6.02214e+26 u"},
        {"{" PHYSICAL
         "\"temperature\": 300, \"box\": [3, 3, 3], \"particles\": {\"types\": {\"A\": "
         "80, \"B\": 80}, \"mass\": {\"A\": 18, \"B\": 0.032}}}",
         "scene.json: particles.mass: 0.032 u is less than any atom has: masses are in "
         "u, which is g/mol; 1 kg/mol is 1000 u"},
        {"{" PHYSICAL "\"temperature\": 300, " BOX
         ", \"conservative\": {\"law\": \"table\", \"file\": \"bad.tsv\"}}",
         "bad.tsv: column 1: \"ps\" is not a unit of the same kind as nm"},
        {"{" PHYSICAL "\"temperature\": 300, " BOX
         ", \"conservative\": {\"law\": \"table\", \"file\": \"other.tsv\"}}",
         "other.tsv: column 1: \"lambda\" needs the lambda that it was written with"},
        {"{" REDUCED("0.5") BOX ", \"conservative\": {\"law\": \"table\", \"file\": \"nm.tsv\"}}",
         "nm.tsv: column 1 is in nm, and the file that names it is reduced, with 0.5 nm for 1"},
        {"{" REDUCED("1") BOX ", \"conservative\": {\"law\": \"table\", \"file\": \"nm.tsv\"}}",
         "nm.tsv: column 2 is in kJ/mol, and the file that names it is reduced, with 2.49434 "},
    };
    small_inputs_write(*state, "nm.tsv", "# r[nm]\tphi[kJ/mol]\n0 1\n1 0\n1.1 0\n", NULL, NULL);
    small_inputs_write(*state, "bad.tsv", "# r[ps]\tphi[kJ/mol]\n0 1\n1 0\n2 0\n", NULL, NULL);
    small_inputs_write(*state, "other.tsv", "# r[lambda]\tphi[k_B.T_0]\n0 1\n1 0\n2 0\n", NULL,
                       NULL);
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        small_inputs_write(*state, "scene.json", bad[k].scene, NULL, NULL);
        RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
        run_program_assert_code(&result, 2);
        if (run_program_lines(result.err) != 1)
            fail_msg("not one line: %s", result.err);
        if (strstr(result.err, bad[k].message) == NULL)
            fail_msg("not \"%s\" but %s", bad[k].message, result.err);
    }
}

/// Where the program chooses lambda by the density, a law has no length by default: 2.5 lambda of
/// one density would be another potential at the next.
static void test_lengths_of_laws_have_no_default_that_follows_the_density(void **state) {
    static const char scene[] =
        "{\"units\": \"nm-ps\", \"temperature\": 300, \"box\": [3, 3, 3],\n"
        "\"particles\": {\"count\": 81, \"mass\": 40}, \"time_step\": 0.001,\n"
        "\"conservative\": {\"law\": \"lennard-jones\", \"sigma\": 0.34},\n"
        "\"dissipative\": {\"law\": \"none\"},\n"
        "\"measure\": {\"equilibration\": 1, \"samples\": 1}}\n";
    small_inputs_write(*state, "scene.json", scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out");
    run_program_assert_code(&result, 2);
    assert_int_equal(run_program_lines(result.err), 1);
    assert_contains(result.err, "scene.json: conservative.cutoff: missing: expected a number in nm "
                                "(it is 0 beyond); the default, 2.5 lambda, would "
                                "change with the density");
    small_inputs_write(*state, "scene.json", scene, "0.34", "0.34, \"cutoff\": 0.85");
    simulate("scene.json", "out");
    small_inputs_write(*state, "scene.json", scene, "\"nm-ps\"",
                       "{\"system\": \"nm-ps\", \"length\": 0.34}");
    simulate("scene.json", "known"); // lambda is the file's own
    assert_close(results_number("known/used.json", "conservative.cutoff"), 0.85, 1e-12);
}

/// Every unit of every field table: in brackets in the third cell of a row of keys.
static void test_units_of_all_field_tables_are_known(void **state) {
    (void)state;
    if (system("\"$MESOFIT\" describe --format markdown >page.md") != 0)
        fail_msg("describe fails");
    char *page = temporary_folder_read("page.md"), *rest;
    size_t rows = 0;
    for (char *line = strtok_r(page, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        char key[256], what[2048], unit[256];
        struct units_text parsed;
        for (char *bar; (bar = strstr(line, "\\|"));) // of choices
            bar[1] = '/';
        if (sscanf(line, "`%255[^`]` | %2047[^|]| %*[^][|][%255[^]]", key, what, unit) != 3)
            continue;
        rows++;
        if (!mf_units_text_parse(&parsed, unit, 3))
            fail_msg("%s: \"%s\" is not a unit", key, unit);
    }
    assert_true(rows > 100); // all others are pure numbers and texts
    free(page);
}

/// 3 beads of 18.015 u in a cubic nanometre are 0.0897 g/cm³.
static void test_a_mass_density_needs_a_mass(void **state) {
    static const char run[] =
        "{\"units\": \"nm-ps\", \"target\": {\"rdf\": {\"file\": \"target.tsv\"}},\n"
        "\"scene\": {\"density\": 3, \"temperature\": 298}}";
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    small_inputs_write(*state, "run.json", run, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "mu = 1 u (no mass is given: times have no meaning), tau");
    assert_contains(result.out, "; density 3 nm^-3, 1 + rho G");
    small_inputs_write(*state, "run.json", run, "298", "298, \"particles\": {\"mass\": 18.015}");
    RUN_PROGRAM(&result, "fit", "run.json", "--explain");
    run_program_assert_code(&result, 0);
    assert_contains(result.out, "mu = 18.015 u, tau");
    assert_contains(result.out, "; density 3 nm^-3 = 0.0897 g/cm^3, 1 + rho G");
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_scenes_are_the_same_physics_in_all_units),
        TEST(test_used_json_of_physical_units_gives_the_same_bits),
        TEST(test_compare_tells_all_in_the_units_of_the_first),
        TEST(test_tables_of_simulations_speak_physical_units),
        TEST(test_fits_speak_physical_units),
        TEST(test_a_mass_density_needs_a_mass),
        TEST(test_bad_units_are_one_line_with_file_and_key),
        TEST(test_lengths_of_laws_have_no_default_that_follows_the_density),
        TEST(test_units_of_all_field_tables_are_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
