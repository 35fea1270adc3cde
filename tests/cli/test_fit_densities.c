// SPDX-License-Identifier: GPL-3.0-or-later
//
// `mesofit fit` of an energy of local densities that the scene leaves out: found from p(ρ) beside
// the potential of pairs or alone, the same bits in pieces, what comes of it in a scene, and what
// is refused.
#include "shared/is_close.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"
#include "shared/twins.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static struct run_program_result result;

#define FLUID                                                                                      \
    "\"box\": [4.64, 4.64, 4.64], \"particles\": {\"count\": 100}, \"time_step\": 0.02,\n"         \
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 4.5},\n"
#define PAIRS "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
#define CUTOFFS "\"inner_cutoff\": 0.5, \"cutoff\": 1.2"
#define DENSITY(energy)                                                                            \
    "\"many_body\": {\"crowd\": {\"weight\": {\"law\": \"sanyal-shell\", " CUTOFFS "}" energy "}}"
#define TRUTH ", \"energy\": {\"law\": \"polynomial\", \"c1\": 0.5, \"c2\": 1, \"origin\": 2.4}"
#define MEASURE "\"measure\": {\"equilibration\": 2000, \"samples\": 3000, \"every\": 10},\n"
#define OBSERVABLES                                                                                \
    "\"rdf\": {\"range\": 1.5, \"bins\": 30},\n"                                                   \
    "\"weighted_density\": {" CUTOFFS ", \"bins\": 60, \"maximum\": 9}"

/// 2.2 neighbours by the weight: f costs beads that have fewer or more.
static const char twin[] =
    "{\"seed\": 51, " FLUID PAIRS DENSITY(TRUTH) ",\n" MEASURE OBSERVABLES "}\n";

#define RDF "\"rdf\": {\"file\": \"target/rdf.tsv\"}, "
#define P_OF_RHO "\"weighted_density\": {" CUTOFFS ", \"file\": \"target/weighted_density.tsv\"}"
#define IMC "\"method\": {\"name\": \"imc\", \"precision\": 0.006}"
#define VERIFICATION                                                                               \
    "\"verification\": {\"replicas\": 2, \"equilibration\": 500, \"samples\": 200, \"every\": 10}"

/// A second state whose ρ is another one.
#define OTHER_WEIGHT                                                                               \
    "\"states\": {\"one\": {\"scene\": {\"temperature\": 1}}, \"two\": {\n"                        \
    "\"scene\": {\"many_body\": {\"crowd\": {\"weight\": {\"cutoff\": 1}}}},\n"                    \
    "\"target\": {\"weighted_density\": {\"cutoff\": 1}}}}"

/// A fit of g(r), p(ρ) and the pressure of the twin.
static void write_fit(struct temporary_folder *folder, const char *from, const char *to) {
    char text[4096];
    small_inputs_write(folder, "scene.json", twin, NULL, NULL);
    twins_simulate("scene.json", "target");
    snprintf(text, sizeof text,
             "{\"seed\": 3, \"target\": {" RDF P_OF_RHO ",\n\"pressure\": {\"value\": %.8g, "
             "\"error\": %.8g}},\n\"scene\": {" FLUID DENSITY("") "},\n" IMC ", " VERIFICATION
                                                                  "}\n",
             results_number("target/summary.json", "pressure"),
             results_number("target/summary.json", "pressure_error"));
    small_inputs_write(folder, "run.json", text, from, to);
}

/// f that was found, and the truth, over the densities of which p is above 0.02.
enum { MAX = 200 };
struct found {
    size_t count;
    double rho[MAX], f[MAX], error[MAX], p[MAX];
};

static struct found read_found(const char *path) {
    static struct found found;
    FILE *file = fopen(path, "r"), *target = fopen("target/weighted_density.tsv", "r");
    double rho[MAX], p[MAX];
    size_t bins = 0;
    assert_true(file && target);
    for (char line[256]; fgets(line, sizeof line, target);)
        bins += sscanf(line, "%lf %lf", &rho[bins], &p[bins]) == 2;
    found = (struct found){.count = 0};
    for (char line[256]; fgets(line, sizeof line, file);) {
        const size_t n = found.count;
        if (sscanf(line, "%lf %lf %lf", &found.rho[n], &found.f[n], &found.error[n]) != 3)
            continue;
        for (size_t k = 0; k < bins; k++)
            if (fabs(rho[k] - found.rho[n]) < 1e-6)
                found.p[n] = p[k];
        found.count += found.p[n] > 0.02;
    }
    fclose(file);
    fclose(target);
    return found;
}

/// Take off the best line over p, or the constant alone.
static void take_line_off(const struct found *found, bool slope, double *f) {
    double sum = 0, rho = 0, mean = 0, squares = 0, products = 0;
    for (size_t n = 0; n < found->count; n++) {
        sum += found->p[n];
        rho += found->p[n] * found->rho[n];
        mean += found->p[n] * f[n];
    }
    for (size_t n = 0; n < found->count; n++) {
        const double off = found->rho[n] - rho / sum;
        squares += found->p[n] * off * off;
        products += found->p[n] * off * f[n];
    }
    for (size_t n = 0; n < found->count; n++)
        f[n] -= mean / sum + slope * products / squares * (found->rho[n] - rho / sum);
}

/// Rms deviation of f from x/2 + x², x = ρ − 2.4, in its errors and in k_B T.
static void assert_found(const char *path, bool slope, double largest) {
    struct found found = read_found(path);
    double truth[MAX], errors = 0, squares = 0;
    for (size_t n = 0; n < found.count; n++)
        truth[n] = 0.5 * (found.rho[n] - 2.4) + pow(found.rho[n] - 2.4, 2);
    take_line_off(&found, slope, found.f);
    take_line_off(&found, slope, truth);
    assert_in_range(found.count, 10, MAX);
    for (size_t n = 0; n < found.count; n++) {
        errors += pow((found.f[n] - truth[n]) / found.error[n], 2) / (double)found.count;
        squares += pow(found.f[n] - truth[n], 2) / (double)found.count;
    }
    print_message("%s: rms %.4f k_B T off, %.2f errors\n", path, sqrt(squares), sqrt(errors));
    assert_true(sqrt(squares) < largest);
    assert_true(sqrt(errors) > 0.1 && sqrt(errors) < 2);
}

static void run_fit(const char *folder) {
    RUN_PROGRAM(&result, "fit", "run.json", "-o", folder, "--force", "--quiet");
    run_program_assert_code(&result, 0);
}

/// f has no slope over p(ρ): pairs have it. And what is found is a table that a scene reads.
static void test_an_energy_is_found_beside_the_potential(void **state) {
    static const char *const tables[] = {"many_body_crowd.tsv", "potential.tsv", "history.tsv",
                                         NULL};
    double f[MAX];
    write_fit(*state, NULL, NULL);
    run_fit("out");
    assert_found("out/many_body_crowd.tsv", true, 0.05);
    struct found found = read_found("out/many_body_crowd.tsv");
    memcpy(f, found.f, sizeof f);
    take_line_off(&found, false, found.f);
    take_line_off(&found, true, f);
    for (size_t n = 0; n < found.count; n++)
        assert_close(f[n], found.f[n], 0.02);
    RUN_PROGRAM(&result, "fit", "out/used.json", "-o", "again", "--quiet");
    run_program_assert_code(&result, 0);
    results_assert_same("out", "again", tables);
    run_program_in_pieces(0, (const char *const[]){"fit", "run.json", "-o", "pieces", NULL});
    results_assert_same("out", "pieces", tables);

    small_inputs_write(
        *state, "result.json",
        "{\"seed\": 8, " FLUID
        "\"conservative\": {\"law\": \"table\", \"file\": \"out/potential.tsv\"},\n" DENSITY(
            ", \"energy\": {\"law\": \"table\", \"file\": "
            "\"out/many_body_crowd.tsv\"}") ",\n" MEASURE OBSERVABLES "}\n",
        NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "result.json", "-o", "simulated", "--quiet");
    run_program_assert_code(&result, 0);
    assert_close(results_number("simulated/summary.json", "weighted_density_variance"),
                 results_number("target/summary.json", "weighted_density_variance"), 0.01);
    assert_close(results_number("simulated/summary.json", "pressure"),
                 results_number("target/summary.json", "pressure"), 0.1);
}

/// "thin": {…}, the twin's in a box of this edge.
static void add_state(struct temporary_folder *folder, const char *name, const char *edge,
                      char *text, size_t size) {
    char box[64], summary[64];
    snprintf(box, sizeof box, "\"box\": [%s, %s, %s]", edge, edge, edge);
    small_inputs_write(folder, "scene.json", twin, "\"box\": [4.64, 4.64, 4.64]", box);
    twins_simulate("scene.json", name);
    snprintf(summary, sizeof summary, "%s/summary.json", name);
    const size_t length = strlen(text);
    snprintf(text + length, size - length,
             "%s\"%s\": {\"scene\": {%s}, \"target\": {\"rdf\": {\"file\": \"%s/rdf.tsv\"},\n"
             "\"weighted_density\": {" CUTOFFS ", \"file\": \"%s/weighted_density.tsv\"},\n"
             "\"pressure\": {\"value\": %.8g, \"error\": %.8g}}}",
             length > 0 ? ",\n" : "", name, box, name, name, results_number(summary, "pressure"),
             results_number(summary, "pressure_error"));
}

/// One f and one Φ for two densities, with pressures of 0.4 and 18. What is asked of the pressures
/// while g is far off must not be more than the response knows.
static void test_one_energy_is_found_for_two_densities(void **state) {
    char states[2048] = "", text[4096];
    add_state(*state, "thin", "5.4", states, sizeof states);
    add_state(*state, "target", "4.127", states, sizeof states);
    snprintf(
        text, sizeof text,
        "{\"seed\": 3, \"states\": {%s},\n\"scene\": {\"particles\": {\"count\": 100}, "
        "\"time_step\": 0.01,\n\"dissipative\": {\"law\": \"power\", \"sigma\": 4.5}, " DENSITY(
            "") "},\n" IMC ", " VERIFICATION "}\n",
        states);
    small_inputs_write(*state, "run.json", text, NULL, NULL);
    run_fit("out");
    assert_found("out/many_body_crowd.tsv", true, 0.05);
}

/// The table that LAMMPS reads, behind three comments, types, rows and mass, has the curve that was
/// found, from ρ = 0 on.
static void test_the_energy_that_was_found_is_exported(void **state) {
    enum { MAX_ROWS = 200001, COMMENTS = 3 }; // of a table that export writes
    static double f[MAX_ROWS + 1];
    const double first = 0;
    double step;
    size_t rows;
    char line[256];
    write_fit(*state, "\"precision\": 0.006", "\"precision\": 0.02, \"iterations\": 2");
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "out", "--force", "--quiet");
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps", "-o", "model", "--force");
    run_program_assert_code(&result, 0);
    FILE *file = fopen("model/crowd.eam.fs", "r");
    assert_non_null(file);
    for (int k = 0; k < COMMENTS; k++)
        assert_non_null(fgets(line, sizeof line, file));
    assert_int_equal(fscanf(file, "1 T1 %zu %lf %*d %*f %*f %*d %*f %*d none", &rows, &step), 2);
    const struct found found = read_found("out/many_body_crowd.tsv");
    assert_in_range(rows, 100, MAX_ROWS);
    for (size_t k = 0; k < rows; k++)
        assert_int_equal(fscanf(file, "%lf", &f[k]), 1);
    fclose(file);
    for (size_t n = 1; n < found.count; n++) {
        const double place = (found.rho[n] - first) / step, before = (found.rho[0] - first) / step;
        const size_t k = (size_t)place, k_before = (size_t)before;
        const double value = f[k] + (place - (double)k) * (f[k + 1] - f[k]);
        const double value_before =
            f[k_before] + (before - (double)k_before) * (f[k_before + 1] - f[k_before]);
        assert_close(value - value_before, found.f[n] - found.f[0], 0.01);
    }
}

/// Beside pairs that are known f has its slope.
static void test_an_energy_is_found_alone(void **state) {
    write_fit(*state, "\"scene\": {", "\"scene\": {" PAIRS);
    small_inputs_change(*state, "run.json", RDF, "");
    small_inputs_change(*state, "run.json", "\"pressure\": {",
                        "\"pressure\": {\"fitted\": \"no\", ");
    run_fit("out");
    assert_found("out/many_body_crowd.tsv", false, 0.05);
}

/// Where the scene gives the law of a pair, the other pairs alone cannot have the slope of f.
static void test_an_energy_beside_a_known_pair_has_its_slope(void **state) {
    static const char count[] = "\"count\": 100", types[] = "\"types\": {\"A\": 55, \"B\": 45}";
    small_inputs_write(*state, "scene.json", twin, count, types);
    twins_simulate("scene.json", "target");
    small_inputs_write(
        *state, "run.json",
        "{\"seed\": 3, \"target\": {\"rdf\": {\"A-B\": {\"file\": \"target/rdf_A-B.tsv\"},\n"
        "\"B-B\": {\"file\": \"target/rdf_B-B.tsv\"}}, " P_OF_RHO "},\n\"scene\": {" FLUID
        "\"known\": {\"A-A\": {\"law\": \"soft-repulsion\", \"a\": 25}, \"A-B\": {\"law\": "
        "\"none\"}, \"B-B\": {\"law\": \"none\"}},\n" DENSITY(
            "") "},\n"
                "\"method\": {\"name\": \"imc\", \"precision\": 0.015}, " VERIFICATION "}\n",
        count, types);
    run_fit("out");
    assert_found("out/many_body_crowd.tsv", false, 0.15);
}

static void assert_refused(struct temporary_folder *folder, const char *from, const char *to,
                           const char *words) {
    write_fit(folder, from, to);
    RUN_PROGRAM(&result, "fit", "run.json", "-o", "refused");
    run_program_assert_refused(&result, "refused", words, 1, (const char *const[]){words, NULL});
}

static void test_what_cannot_be_found_is_refused(void **state) {
    assert_refused(*state, IMC, "\"method\": {\"name\": \"gauss-newton\"}",
                   "method.name: \"gauss-newton\" does not find an \"energy\"");
    assert_refused(*state, DENSITY(""),
                   "\"many_body\": {\"crowd\": {\"weight\": {\"law\": \"lucy\", \"cutoff\": 1.2}}}",
                   "many_body.crowd has no \"energy\": it is found from");
    assert_refused(*state, "\"many_body\": {",
                   "\"many_body\": {\"first\": {\"weight\": {\"law\": \"sanyal-shell\", " CUTOFFS
                   "}}, ",
                   "many_body.crowd has no \"energy\": that of another density is found");
    assert_refused(*state, P_OF_RHO ",", "",
                   "many_body.crowd has no \"energy\": there is no \"target.weighted_density\"");
    assert_refused(*state, P_OF_RHO,
                   "\"weighted_density\": {\"fitted\": \"no\", " CUTOFFS
                   ", \"file\": \"target/weighted_density.tsv\"}",
                   "which it is found from, has \"fitted\": \"no\"");
    assert_refused(*state, "\"rdf\": {", "\"rdf\": {\"cutoff\": 1, ",
                   "target.rdf: it ends at 1, before the weight of \"scene.many_body.crowd\"");
    assert_refused(*state, VERIFICATION, VERIFICATION ", " OTHER_WEIGHT,
                   "states.two: the bonds, angles, dihedrals and local densities");
    small_inputs_write(*state, "scene.json", twin, TRUTH, "");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "refused");
    run_program_assert_refused(&result, "refused", "energy", 1,
                               (const char *const[]){"many_body.crowd", NULL});
}

#define CASE(test)                                                                                 \
    cmocka_unit_test_setup_teardown(test, small_inputs_enter_without_gnuplot, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        CASE(test_an_energy_is_found_beside_the_potential),
        CASE(test_one_energy_is_found_for_two_densities),
        CASE(test_the_energy_that_was_found_is_exported),
        CASE(test_an_energy_is_found_alone),
        CASE(test_an_energy_beside_a_known_pair_has_its_slope),
        CASE(test_what_cannot_be_found_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
