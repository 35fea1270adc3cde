// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files that cannot be right: exit code 2, one clear line for each fault, nothing left behind.
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

static const char good_table[] = "# r value\n0 10\n0.5 3\n1 0\n";

enum { MAX_WORDS = 5 };

/// A file that differs from the good one in one place, and words of the lines that tell of it.
struct fault {
    const char *what;
    const char *from, *to;        ///< in the JSON file
    const char *words[MAX_WORDS]; ///< of the message; NULL-terminated
    const char *table;            ///< instead of the good table or target
};

static void check_fault(struct temporary_folder *folder, const char *verb, const char *good,
                        const struct fault *fault) {
    static struct run_program_result result;
    const char *table = fault->table && fault->from ? fault->table : good_table;
    const char *target = fault->table && !fault->from ? fault->table : small_inputs_target;
    small_inputs_write(folder, "table.tsv", table, NULL, NULL);
    small_inputs_write(folder, "target.tsv", target, NULL, NULL);
    small_inputs_write(folder, "input.json", good, fault->from, fault->to);
    RUN_PROGRAM(&result, verb, "input.json");
    run_program_assert_refused(&result, ".", fault->what, 1, fault->words);
    RUN_PROGRAM(&result, verb, "input.json", "--explain");
    run_program_assert_refused(&result, ".", fault->what, 1, fault->words);
}

#define WITH_TABLE(name, old, new, rows, ...)                                                      \
    {                                                                                              \
        .what = (name), .from = (old), .to = (new), .table = (rows), .words = { __VA_ARGS__ }      \
    }
#define FAULT(name, old, new, ...) WITH_TABLE(name, old, new, NULL, __VA_ARGS__)
#define TARGET(name, rows, ...) WITH_TABLE(name, NULL, NULL, rows, __VA_ARGS__)

#define PARTICLES "\"particles\": {\"count\": 81}"
#define DISSIPATIVE "{\"law\": \"power\", \"sigma\": 2}"
#define FROM_FILE "\"particles\": {\"count\": 2, \"placement\": \"file\", \"file\": \"table.tsv\"}"
#define FORCES                                                                                     \
    "  \"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"                              \
    "  \"dissipative\": {\"law\": \"power\", \"sigma\": 2},\n"
#define STEP "\"time_step\": 0.02"
#define TABLE_WEIGHT "{\"law\": \"table\", \"file\": \"table.tsv\"}"

/// Faults of what both kinds of file have. The key in the message is looked for without "scene.".
static const struct fault common_faults[] = {
    FAULT("malformed", STEP, "\"time_step\" 0.02", "input.json:", "expected"),
    FAULT("ends early", "}\n", "", "input.json:"),
    FAULT("two documents", "{\n", "{}\n{", "input.json:2:1"),
    FAULT("unknown key", STEP, "\"time_stp\": 0.02", "input.json", "time_stp",
          "did you mean \"time_step\"?"),
    FAULT("wrong case", STEP, "\"Time_step\": 0.02", "Time_step", "did you mean \"time_step\"?"),
    FAULT("a key in another case, of what is required", PARTICLES, "\"Particles\": {\"count\": 81}",
          "Particles: unknown key; did you mean \"particles\"?"),
    FAULT("a misspelt key of what is required", "\"count\"", "\"cuont\"",
          "particles.cuont: unknown key; did you mean \"count\"?"),
    FAULT("a law alone", DISSIPATIVE, "\"power\"",
          "dissipative: expected an object, found the text \"power\": write {\"law\": \"power\"}"),
    FAULT("gamma of a power law", "\"sigma\": 2", "\"gamma\": 4", "dissipative.gamma: ",
          "omega is the square root of a friction: \"sigma\" is sqrt(gamma)"),
    FAULT("no law", DISSIPATIVE, "{\"sigma\": 2}", "dissipative.law: missing: expected a text; ",
          "known: none, power, expression, table"),
    FAULT("an integrator alone", STEP, STEP ", \"dynamics\": \"aboba\"",
          "write {\"integrator\": \"aboba\"}"),
    FAULT("a comma too many", STEP, STEP ",,", "input.json:", "expected a key"),
    FAULT("a comma behind the last", "{\"count\": 81}", "{\"count\": 81,}",
          "expected something after the last comma, found '}'"),
    FAULT("a comment", STEP, STEP "// of the scene\n", "input.json:", "JSON has no comments"),
    FAULT("text for a number", STEP, "\"time_step\": \"0.02\"", "input.json",
          "time_step: expected a number, found the text"),
    FAULT("number for an object", PARTICLES, "\"particles\": 81",
          "particles: expected an object, found the number 81"),
    FAULT("null", STEP, "\"time_step\": null", "time_step: expected a number, found null"),
    FAULT("missing", PARTICLES, "\"particles\": {}", "particles.count: missing"),
    FAULT("negative", STEP, "\"time_step\": -0.02", "time_step: -0.02 is out of range", "above 0"),
    FAULT("too few", "81", "1", "particles.count: 1 is out of range"),
    FAULT("fraction", "81", "81.5", "particles.count", "whole number"),
    FAULT("NaN", "0.02", "NaN", "input.json:"),
    FAULT("-Infinity", "0.02", "-Infinity", "input.json:"),
    FAULT("1e999", "0.02", "1e999", "time_step: the number is too large"),
    FAULT("duplicate", STEP, STEP ", \"time_step\": 0.03", "time_step: duplicate key"),
    FAULT("seed of 2^53", "\"seed\": 1", "\"seed\": 9007199254740992", "seed", "2^53"),
    FAULT("seed below 0", "\"seed\": 1", "\"seed\": -1", "seed: -1 is out of range"),
    FAULT("small box", "[3, 3, 3]", "[3, 1.9, 3]", "input.json", "box", "1.9"),
    FAULT("flat box", "[3, 3, 3]", "[3, 3]", "box: has 2 edges", "3 dimensions"),
    FAULT("box of 0", "[3, 3, 3]", "[3, 0, 3]", "box[1]: 0 is out of range"),
    FAULT("enormous box", "[3, 3, 3]", "[3, 3, 1e300]", "box[2]: 1e+300 is out of range"),
    FAULT("no room", PARTICLES,
          "\"particles\": {\"count\": 81, \"placement\": \"random\", \"separation\": 1}",
          "input.json", "no room for particle", "separation"),
    FAULT("unknown law", "\"power\"", "\"powr\"", "dissipative.law", "did you mean \"power\"?"),
    FAULT("friction without an integrator for it", STEP,
          STEP ", \"dynamics\": {\"integrator\": \"velocity-verlet\"}",
          "dynamics: velocity-verlet has no friction", "\"aboba\""),
    WITH_TABLE("negative omega", DISSIPATIVE, TABLE_WEIGHT, "0 1\n0.5 -0.5\n1 0\n1.1 0\n",
               "dissipative", "omega is negative at r = "),
    FAULT("short table", DISSIPATIVE,
          "{\"law\": \"table\", \"file\": \"table.tsv\", \"cutoff\": 1.5}", "dissipative.file",
          "table.tsv", "ends at r = 1, before the cutoff 1.5"),
    WITH_TABLE("unsorted table", DISSIPATIVE, TABLE_WEIGHT, "0 1\n0.7 0.5\n0.5 0.4\n1 0\n",
               "dissipative.file", "table.tsv:3"),
    FAULT("missing table", DISSIPATIVE, "{\"law\": \"table\", \"file\": \"no.tsv\"}",
          "dissipative.file", "no.tsv: No such file"),

};

static const struct fault scene_faults[] = {
    FAULT("small box for the RDF", "\"measure\"", "\"rdf\": {\"range\": 1.6}, \"measure\"",
          "input.json", "box", "RDF", "1.6"),
    FAULT("a soft potential for the RDF from forces", "{\"law\": \"soft-repulsion\", \"a\": 25}",
          "{\"law\": \"soft-repulsion\", \"a\": 19}, \"rdf\": {\"estimator\": \"force\"}",
          "input.json", "rdf", "force", "10 k_B T"),
    WITH_TABLE("coordinates in other units", PARTICLES, FROM_FILE, "299 -299 1\n2 301 2\n",
               "particles.file", "table.tsv:2", "301", "100 boxes of 3"),
    WITH_TABLE("coordinates beyond whole numbers", PARTICLES, FROM_FILE, "-1.7e308 1 1\n2 2 2\n",
               "particles.file", "table.tsv:1", "-1.7e+308"),
    FAULT("a mass of a type where there are none", PARTICLES,
          "\"particles\": {\"count\": 81, \"mass\": {\"A\": 2}}",
          "input.json: particles.mass: the particles have no types: write a number"),
    FAULT("a radius below zero", PARTICLES, "\"particles\": {\"count\": 81, \"radius\": -2}",
          "input.json: particles.radius: -2 is out of range; allowed: above 0"),
    FAULT("a range the wrong way round", PARTICLES,
          "\"particles\": {\"count\": 81, \"radius\": {\"minimum\": 2, \"maximum\": 1}}",
          "input.json: particles.radius.maximum: 1 is below the minimum of 2"),
    FAULT("a range without an end", PARTICLES,
          "\"particles\": {\"count\": 81, \"radius\": {\"minimum\": 2}}",
          "input.json: particles.radius.maximum: missing"),
    FAULT("orientations in three dimensions", PARTICLES,
          PARTICLES ", \"interactions\": {\"self-propulsion\": {\"force\": 1}}",
          "input.json: interactions.self-propulsion: orientations are of two dimensions, not 3"),
    FAULT("no noise where there are velocities", "\"temperature\": 1", "\"temperature\": 0",
          "input.json: temperature: 0 is for dynamics without velocities, as \"brownian\""),
    FAULT("a format that is none", PARTICLES,
          PARTICLES ", \"snapshots\": {\"every\": 10, \"formats\": [\"vtk\"]}",
          "input.json: snapshots.formats: ", "\"vtk\" is unknown; did you mean \"vtp\"?"),
    FAULT("polarity of what has no direction", PARTICLES,
          PARTICLES ", \"polarity\": {\"every\": 1, \"lags\": 2}",
          "input.json: polarity: particles have no orientations"),
    FAULT("clusters beyond the list", PARTICLES, PARTICLES ", \"clusters\": {\"distance\": 40}",
          "input.json: clusters.distance: 40 is beyond"),
    FAULT("masses for an integrator that knows none", PARTICLES,
          "\"particles\": {\"count\": 81, \"mass\": 2}, \"dynamics\": {\"integrator\": "
          "\"shardlow\"}",
          "input.json: particles.mass: shardlow moves particles of mass 1 only"),
    FAULT("masses of pairs that remember", PARTICLES,
          "\"particles\": {\"count\": 81, \"mass\": 2}, \"dissipative_transverse\": {\"law\": "
          "\"power\"}",
          "input.json: particles.mass: friction with memory or perpendicular to pairs"),
    WITH_TABLE("radii twice", PARTICLES,
               "\"particles\": {\"count\": 2, \"radius\": 2, \"placement\": \"file\", "
               "\"file\": \"table.tsv\"}",
               "# x y z radius\n1 1 1 1\n2 2 2 1\n", "particles.radius: is given in", "table.tsv"),
    WITH_TABLE("a radius of nothing in a file", PARTICLES, FROM_FILE,
               "# x y z radius[lambda]\n1 1 1 1\n2 2 2 0\n", "particles.file",
               "table.tsv:3: the radius 0 is out of range; allowed: above 0"),
    WITH_TABLE("a column of another name", PARTICLES, FROM_FILE, "x y z charge\n1 1 1 1\n2 2 2 0\n",
               "particles.file", "\"charge\" is unknown, not 2 of 3 or 6; further columns"),
    WITH_TABLE("a diameter", PARTICLES, FROM_FILE, "# x y z diameter\n1 1 1 1\n2 2 2 1\n",
               "particles.file", "2 rows of 4 numbers, of which \"diameter\" is unknown, not 2"),
    WITH_TABLE("a comment is no list of names", PARTICLES, FROM_FILE,
               "# some beads\n1 1 1 1\n2 2 2 1\n", "2 rows of 4 numbers, not 2 of 3 or 6"),
    FAULT("an orientation in space", PARTICLES,
          "\"particles\": {\"count\": 81, \"orientation\": 0}",
          "particles.orientation: orientations are of two dimensions, not 3"),
    FAULT("no forces and no range", FORCES, "\"rdf\": {}, ", "input.json: rdf", "no forces",
          "range"),
    FAULT("no samples", "\"samples\": 4", "\"samples\": 0", "measure.samples: 0 is out of range"),
    FAULT("short table of a potential", "{\"law\": \"soft-repulsion\", \"a\": 25}",
          "{\"law\": \"table\", \"file\": \"table.tsv\", \"cutoff\": 2}", "conservative.file",
          "table.tsv", "before the cutoff 2"),
    FAULT("unknown key of motion", "\"measure\"", "\"motion\": {\"lag\": 3}, \"measure\"",
          "motion.lag", "did you mean \"lags\"?"),
    FAULT("a lattice of an earlier version", PARTICLES,
          "\"particles\": {\"count\": 81, \"jitter\": 0.1}",
          "input.json: particles.jitter: no longer a key: it is 0.05 always; leave it out"),
    FAULT("motion of an earlier version", "\"measure\"",
          "\"motion\": {\"lags\": 2, \"fit_from\": 0.4}, \"measure\"",
          "input.json: motion.fit_from: no longer a key: the line always starts at half of the "
          "window; leave it out"),
    FAULT("no lags", "\"measure\"", "\"motion\": {\"lags\": 1}, \"measure\"",
          "motion.lags: 1 is out of range"),
    FAULT("a number for motion", "\"measure\"", "\"motion\": 3, \"measure\"",
          "motion: expected an object"),
    FAULT("a longer box or a shorter range", "\"measure\"",
          "\"rdf\": {\"range\": 1.6}, \"measure\"", "a larger box", "\"range\" of \"rdf\""),
    FAULT("a box too small for the forces", "\"a\": 25", "\"a\": 25, \"cutoff\": 1.6",
          "the box is too small", "twice the cutoff 1.6", "a larger box", "a shorter cutoff"),
    FAULT("a window longer than the run", "\"measure\"",
          "\"motion\": {\"every\": 1, \"lags\": 5}, \"measure\"", "input.json: motion",
          "5 lags of 1 steps", "4 steps"),
    FAULT("a force covariance without friction in the forces", "\"measure\"",
          "\"force_covariance\": {}, \"measure\"", "input.json: force_covariance", "aboba",
          "dpd-verlet"),
    FAULT("a method in a scene", "\"measure\"", "\"method\": {}, \"measure\"", "method: unknown"),

};

#define ROWS(middle) "0.1 0.3 0.1\n0.3 0.6 0.1\n0.5 0.8 0.1\n" middle "1.1 1 0.1\n1.3 1 0.1\n"

static const struct fault run_faults[] = {
    FAULT("a file alone", "{\"file\": \"target.tsv\"}", "\"target.tsv\"",
          "target.rdf: expected an object, found the text \"target.tsv\": write {\"file\": "),
    FAULT("a method alone",
          "{\"name\": \"imc\", \"replicas\": 2, \"equilibration\": 1, \"samples\": 8,\n"
          "             \"every\": 1, \"iterations\": 1}",
          "\"imc\"", "write {\"name\": \"imc\"}"),
    FAULT("a method without a name", "\"name\": \"imc\", ", "\"generations\": 3, ",
          "method.generations: unknown key"),
    FAULT("the potential that is to be found", STEP, STEP ", \"conservative\": {\"law\": \"none\"}",
          "scene.conservative: unknown key: it is to be found; give an initial law as \"start\""),
    FAULT("hard particles in a fit", STEP,
          STEP ", \"dynamics\": {\"integrator\": \"event-driven\"}",
          "scene.dynamics: event-driven moves hard particles"),
    FAULT("samples in the scene of a fit", STEP, STEP ", \"measure\": {\"samples\": 2}",
          "scene.measure: unknown key: \"method\" and \"verification\""),
    FAULT("an observable in the scene of a fit", STEP, STEP ", \"motion\": {}",
          "scene.motion: unknown key: a fit measures what its \"target\" names"),
    FAULT("a seed in the scene of a fit", STEP, STEP ", \"seed\": 2", "it belongs at the top"),
    FAULT("a text for the unknowns", "\"verification\"",
          "\"unknowns\": \"potential\", \"verification\"",
          "unknowns: expected an object, found the text \"potential\""),
    FAULT("an unknown of another name", "\"verification\"",
          "\"unknowns\": {\"phi\": {}}, \"verification\"",
          "unknowns.phi: unknown key; known: potential"),
    FAULT("an unknown of an earlier version", "\"verification\"",
          "\"unknowns\": {\"potential\": {\"spacing\": \"steep\"}}, \"verification\"",
          "unknowns.potential.spacing: no longer a key: coefficients are spread evenly; leave it "
          "out"),
    FAULT("no target", "target.tsv", "no.tsv", "target.rdf.file", "no.tsv: No such file"),
    TARGET("decimal commas beside commas", "0,1,0,3\n0,3,0,6\n0,5,0,8\n0,7,1,1\n0,9,1,0\n",
           "target.rdf.file: target.tsv:1: commas part columns, and begin decimals, too: "),
    TARGET("whole numbers among decimal commas", "0,1,0,3\n0,3,0,6\n0,5,1\n0,7,1,1\n",
           "target.tsv:3: 3 columns, the first row has 4: do commas part columns and begin"),
    TARGET("rows for columns",
           "0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 1\n0 0.1 0.3 0.6 0.8 1.1 1.2 1 1 1\n",
           "target.rdf.file: target.tsv: 2 rows of 10 columns", "rows and columns are exchanged"),
    TARGET("a potential for g", "# r[nm]\tphi[kJ/mol]\n0.1\t3\n0.3\t2\n0.5\t1\n0.7\t0.1\n0.9\t0\n",
           "target.rdf.file: target.tsv: column 2 is in kJ/mol by its heading", "a potential"),
    TARGET("a wide gap", ROWS("0.7 1 0.1\n0.9 1 0.1\n") "4.1 1 0.1\n", "target.rdf.file",
           "target.tsv:8", "a gap in r of"),
    TARGET("unsorted", ROWS("0.9 1 0.1\n0.7 1 0.1\n"), "target.tsv:5", "column 1"),
    TARGET("negative r", "-0.1 0 0\n0.1 0.3 0\n0.3 0.6 0\n0.5 1 0\n", "target.tsv:1",
           "-0.1 is below 0"),
    TARGET("negative g", ROWS("0.7 -1 0.1\n0.9 1 0.1\n"), "target.tsv:4", "negative"),
    TARGET("a word", ROWS("0.7 one 0.1\n0.9 1 0.1\n"), "target.tsv:4", "column 2",
           "\"one\" is not a finite number"),
    TARGET("nan", ROWS("0.7 nan 0.1\n0.9 1 0.1\n"), "target.tsv:4", "\"nan\""),
    TARGET("too few columns", "0.1\n0.3\n0.5\n0.7\n", "target.tsv:1", "1 columns, at least 2"),
    TARGET("decimal commas", "0,1 1 0,1\n0,3 1 0,1\n", "target.tsv:1", "a decimal comma?"),
    TARGET("a short row", ROWS("0.7 1\n0.9 1 0.1\n"), "target.tsv:4", "2 columns"),
    TARGET("nothing above 0", "0.1 0 0\n0.3 0 0\n0.5 0 0\n0.7 0 0\n",
           "input.json: target.rdf.file: ", "target.tsv: g is 0 in all rows: is it in column 2?"),
    TARGET("no rows", "# r g error\n", "target.tsv", "without a row"),
    FAULT("small box for the target", "[3, 3, 3]", "[3, 3, 1.99]", "input.json", "scene.box",
          "1.99", "range of the target"),
    FAULT("small box for the friction weight", DISSIPATIVE, "{\"law\": \"power\", \"cutoff\": 1.6}",
          "input.json", "box", "1.6"),
    FAULT("unknown method", "\"imc\"", "\"imcc\"", "method.name", "did you mean \"imc\"?"),
    FAULT("a method in capitals", "\"imc\"", "\"IMC\"", "method.name", "did you mean \"imc\"?"),
    FAULT("a key of another method", "\"samples\": 8", "\"generations\": 8",
          "method.generations: unknown"),
    FAULT("a potential in a fit", STEP, STEP ", \"conservative\": {}", "input.json",
          "scene.conservative"),
    FAULT("an optimiser of an earlier version", "\"samples\": 8",
          "\"samples\": 8, \"asynchronous\": \"yes\"",
          "input.json: method.asynchronous: no longer a key: candidates are always measured in "
          "rounds; leave it out"),
    FAULT("a solver of an earlier version", "\"samples\": 8",
          "\"samples\": 8, \"regularisation\": \"truncated\"",
          "input.json: method.regularisation: no longer a key: the smoothness of the step follows "
          "from the noise; leave it out"),
    FAULT(
        "a solver's strength of an earlier version", "\"samples\": 8",
        "\"samples\": 8, \"strength\": 1000",
        "input.json: method.strength: no longer a key: it is chosen from the noise; leave it out"),
    FAULT("a constant of an earlier version", "\"samples\": 8", "\"samples\": 8, \"depth\": 8",
          "input.json: method.depth: no longer a key: its default is always used; leave "
          "it out"),
    FAULT("islands of an earlier version",
          "{\"name\": \"imc\", \"replicas\": 2, \"equilibration\": 1, \"samples\": 8,\n"
          "             \"every\": 1, \"iterations\": 1}",
          "{\"name\": \"genetic\", \"islands\": 2}",
          "input.json: method.islands: no longer a key: the population is not divided any more; "
          "leave "
          "it out"),
};

#define TYPES "\"types\": {\"A\": 40, \"B\": 41}"
#define LAW "{\"law\": \"soft-repulsion\"}"

static const char good_mixture[] =
    "{\"seed\": 1, \"box\": [3, 3, 3], \"particles\": {" TYPES "}, \"time_step\": 0.02,\n"
    "\"conservative\": {\"A-A\": " LAW
    ", \"A-B\": {\"law\": \"gaussian\", \"cutoff\": 1.2}, \"B-B\": "
    "{\"law\": \"none\"}},\n"
    "\"dissipative\": {\"law\": \"power\"}, \"measure\": {\"equilibration\": 2, \"samples\": 4}}\n";

static const struct fault mixture_faults[] = {
    FAULT("a missing pair", "\"A-A\": " LAW ", ", "", "input.json: conservative.A-A: missing"),
    FAULT("an unknown pair", "\"A-A\"", "\"A-A\": " LAW ", \"A-C\"",
          "input.json: conservative.A-C: unknown pair; expected A-A, A-B, B-B"),
    FAULT("an unknown pair in the place of another", "\"A-B\"", "\"A-Q\"",
          "input.json: conservative.A-Q: unknown pair; expected A-A, A-B, B-B"),
    FAULT("a pair in both orders", "\"A-A\"", "\"B-A\": " LAW ", \"A-A\"",
          "input.json: conservative.A-B", "duplicate pair"),
    FAULT("an unknown law of a pair", "\"gaussian\"", "\"gausian\"", "conservative.A-B.law",
          "did you mean \"gaussian\"?"),
    FAULT("an unknown key of a pair", "\"cutoff\": 1.2", "\"cutof\": 1.2",
          "conservative.A-B.cutof: unknown key"),
    FAULT("a pair of friction alone", "{\"law\": \"power\"}",
          "{\"A-A\": {\"law\": \"power\"}, \"B-A\": {\"law\": \"power\"}}",
          "dissipative.B-B: missing"),
    FAULT("a name of a type", "\"A\": 40", "\"A/\": 40, \"A\": 40", "particles.types.A/",
          "letters"),
    FAULT("no bead of a type", "\"A\": 40", "\"A\": 0",
          "input.json: particles.types.A: 0 is out of range"),
    FAULT("a name that tables end with", "\"A\": 40", "\"A_history\": 40",
          "particles.types.A_history", "nor end with _history"),
    FAULT("types and a count", TYPES, TYPES ", \"count\": 81",
          "input.json: particles.count: is given with \"types\""),
    FAULT("one type and a count", TYPES, "\"types\": {\"A\": 81}, \"count\": 81",
          "input.json: particles.count: is given with \"types\""),
    FAULT("a mixture of one type", TYPES, "\"types\": {\"A\": 81}",
          "particles.types: a mixture has 2 to 8 types, not 1"),
    FAULT("a number for the types", TYPES, "\"types\": 81", "particles.types: expected an object"),
    FAULT("a radius for an unknown type", TYPES,
          TYPES ", \"radius\": {\"A\": 1, \"B\": 2, \"C\": 3}", "particles.radius.C: unknown key"),
    FAULT("a type without a radius", TYPES, TYPES ", \"radius\": {\"A\": 1}",
          "particles.radius.B: missing"),
    FAULT("the RDF from forces", "\"measure\"", "\"rdf\": {\"estimator\": \"force\"}, \"measure\"",
          "input.json: rdf", "not for mixtures"),
};

static void check_faults(struct temporary_folder *folder, const char *verb, const char *good,
                         const struct fault *faults, size_t count) {
    for (size_t k = 0; k < count; k++)
        check_fault(folder, verb, good, &faults[k]);
}

#define CHECK_FAULTS(folder, verb, good, faults)                                                   \
    check_faults((folder), (verb), (good), (faults), sizeof(faults) / sizeof *(faults))

static void test_simulate_refuses_with_a_line_for_each_fault(void **state) {
    CHECK_FAULTS(*state, "simulate", small_inputs_scene, common_faults);
    CHECK_FAULTS(*state, "simulate", small_inputs_scene, scene_faults);
    CHECK_FAULTS(*state, "simulate", good_mixture, mixture_faults);
}

static void test_fit_refuses_with_a_line_for_each_fault(void **state) {
    CHECK_FAULTS(*state, "fit", small_inputs_run, common_faults);
    CHECK_FAULTS(*state, "fit", small_inputs_run, run_faults);
}

static void test_fit_tells_of_all_faults_at_once(void **state) {
    static const char bad[] =
        "{\"seed\": -1, \"target\": {\"rdf\": {\"file\": \"target.tsv\"}},\n"
        "\"scene\": {\"box\": [3, 3, 3], \"particles\": {\"count\": 81},\n"
        "\"time_step\": 0}, \"method\": {\"name\": \"imc\", \"replicas\": 1}}";
    const char *const words[] = {"input.json: seed: ", "input.json: scene.time_step: ",
                                 "input.json: method.replicas: ", NULL};
    static struct run_program_result result;
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    small_inputs_write(*state, "input.json", bad, NULL, NULL);
    RUN_PROGRAM(&result, "fit", "input.json");
    run_program_assert_refused(&result, ".", "three faults", 3, words);
}

/// Results of earlier versions have all settings of their time.
static void test_keys_of_earlier_versions_may_say_what_is_so_now(void **state) {
    static const char wrong[] = "\"samples\": 8, \"ridge\": 0.5, \"strength\": 1, \"depth\": 7";
    static struct run_program_result result;
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    small_inputs_write(
        *state, "input.json", small_inputs_run, "\"samples\": 8",
        "\"samples\": 8, \"ridge\": 0.35, \"strength\": 0, \"asynchronous\": \"no\"");
    RUN_PROGRAM(&result, "fit", "input.json", "--explain");
    run_program_assert_code(&result, 0);
    small_inputs_write(*state, "input.json", small_inputs_run, "\"samples\": 8", wrong);
    RUN_PROGRAM(&result, "fit", "input.json");
    run_program_assert_refused(
        &result, ".", "two keys of earlier versions", 1,
        (const char *const[]){"input.json: no longer keys: method.strength, method.ridge; leave "
                              "them out",
                              NULL});
}

/// The good files are good: the faults above are what is refused.
static void test_file_for_another_command_is_refused_in_one_line(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    small_inputs_write(*state, "run.json", small_inputs_run, NULL, NULL);
    small_inputs_write(*state, "scene.json", small_inputs_scene, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "run.json", "-o", "out");
    run_program_assert_refused(&result, ".", "run file", 1,
                               (const char *const[]){"use: mesofit fit run.json", NULL});
    RUN_PROGRAM(&result, "fit", "scene.json", "-o", "out");
    run_program_assert_refused(&result, ".", "scene file", 1,
                               (const char *const[]){"use: mesofit simulate scene.json", NULL});
}

static void test_good_files_are_accepted(void **state) {
    static struct run_program_result result;
    small_inputs_write(*state, "target.tsv", small_inputs_target, NULL, NULL);
    small_inputs_write(*state, "scene.json", small_inputs_scene, NULL, NULL);
    small_inputs_write(*state, "run.json", small_inputs_run, NULL, NULL);
    small_inputs_write(*state, "mixture.json", good_mixture, NULL, NULL);
    RUN_PROGRAM(&result, "simulate", "mixture.json", "-o", "mixture");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "simulate", "scene.json");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "fit", "run.json", "--force");
    assert_in_range(result.code, 0, 1);
    assert_true(temporary_folder_exists("out/summary.json"));
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_simulate_refuses_with_a_line_for_each_fault),
        TEST(test_fit_refuses_with_a_line_for_each_fault),
        TEST(test_fit_tells_of_all_faults_at_once),
        TEST(test_keys_of_earlier_versions_may_say_what_is_so_now),
        TEST(test_file_for_another_command_is_refused_in_one_line),
        TEST(test_good_files_are_accepted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
