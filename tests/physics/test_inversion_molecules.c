// SPDX-License-Identifier: GPL-3.0-or-later
//
// An inversion finds the potentials of pairs, bonds and angles of a three-bead chain at once from
// what dynamics of known ones have measured: g(r) but for the ramp, U of bonds and angles within
// their bands; and relative entropy finds the best parabola where the truth is none.
#include "base/memory.h"
#include "curves/formula.h"
#include "inversion/inversion.h"
#include "inversion/inversions.h"
#include "inversion/relative_entropy.h"
#include "problem/verify.h"
#include "shared/fluids.h"
#include "shared/length.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

enum { CHAINS = 70, BEADS = 3, PAIR_BINS = 24, BOND_BINS = 30, ANGLE_BINS = 30 };

static const int type[BEADS] = {0};
static const double repulsion = 20, spring = 120, bend = 12;
static const struct molecules_number bond_numbers[] = {{"k", 120}, {"length", 0.6}, {NULL, 0}};
static const struct molecules_number angle_numbers[] = {{"k", 12}, {"angle", 110}, {NULL, 0}};
static const struct bonded_bins bond_bins = {0.35, 0.5 / BOND_BINS, BOND_BINS};
static const struct bonded_bins angle_bins = {60, 100.0 / ANGLE_BINS, ANGLE_BINS};

/// Chains of known laws, what was measured of them, and the problem of finding the laws again.
struct twin {
    struct fluid fluid;
    struct molecules molecules;
    struct bonded_settings bond, angle;
    struct inverse_problem problem;
    struct verification measured;
};

static void ignore(void *context, const struct inverse_progress *progress) {
    (void)context, (void)progress;
}
static const struct inverse_listener listener = {ignore, NULL};

static void make_chains(struct twin *twin) {
    struct formula_soft_repulsion_parameters soft = {repulsion, 1};
    const struct curve curve = {&mf_formula_soft_repulsion, &soft};
    const struct composition composition =
        molecules_topology(&twin->molecules.topology, molecules_chain(CHAINS, type, BEADS, 1, 2),
                           (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&twin->molecules, BONDED_BOND, &mf_bond_harmonic, bond_numbers);
    molecules_add_group(&twin->molecules, BONDED_ANGLE, &mf_angle_harmonic, angle_numbers);
    fluid_groot_warren(&twin->fluid, CHAINS * BEADS, 0.004);
    mf_table_clear(&twin->fluid.potential);
    assert_ok(mf_table_init_potential(&twin->fluid.potential, &curve));
    molecules_enter(&twin->fluid.setup, &twin->molecules, &composition);
}

static void state_problem(struct twin *twin, uint64_t seed) {
    struct inverse_problem *problem = &twin->problem;
    const int bond = mf_bonded_distribution_kind(BONDED_BOND);
    const int angle = mf_bonded_distribution_kind(BONDED_ANGLE);
    static const double none[PAIR_BINS + BOND_BINS + ANGLE_BINS];
    *problem = (struct inverse_problem){.scene = twin->fluid.setup,
                                        .core_threshold = 1e-3,
                                        .core_stiffness = 2000,
                                        .seed = seed,
                                        .threads = 2};
    struct targets *targets = &problem->compared;
    twin->bond.target[0] = bond_bins;
    twin->angle.target[0] = angle_bins;
    targets->bins = (struct rdf_bins){0, 0.05, PAIR_BINS};
    targets->target[TARGET_RDF] = (struct target){.count = PAIR_BINS, .value = none, .error = none};
    targets->target[bond] = (struct target){.count = BOND_BINS, .value = none, .error = none};
    targets->target[angle] = (struct target){.count = ANGLE_BINS, .value = none, .error = none};
    targets->settings[mf_observable_kind(bond).place] = &twin->bond;
    targets->settings[mf_observable_kind(angle).place] = &twin->angle;
}

/// Measure with the true laws, and look for them.
static void measure(struct twin *twin) {
    const struct verify_parameters plan = {
        .replicas = 4, .plan = {.equilibration = 3000, .samples = 400, .every = 25}};
    struct inverse_problem *problem = &twin->problem;
    assert_ok(mf_verify(problem, &twin->fluid.potential, twin->fluid.setup.omega, &plan, &listener,
                        &twin->measured));
    for (int kind = 0; kind < TARGETS; kind++) {
        problem->compared.target[kind].value = twin->measured.observed.value[kind];
        problem->compared.target[kind].error = twin->measured.observed.error[kind];
    }
    problem->targets = problem->compared;
    problem->unknown[UNKNOWN_POTENTIAL].wanted = problem->unknown[UNKNOWN_BONDED].wanted = true;
    problem->bonded = 2;
    problem->group[0] = (struct bonded_unknown){BONDED_BOND, 0, bond_bins, 0, {0}};
    problem->group[1] = (struct bonded_unknown){BONDED_ANGLE, 0, angle_bins, 0, {0}};
}

static void make_twin(struct twin *twin, uint64_t seed) {
    *twin = (struct twin){0};
    make_chains(twin);
    state_problem(twin, seed);
    measure(twin);
}

static void clear_twin(struct twin *twin) {
    mf_verify_clear(&twin->measured);
    mf_molecules_clear(&twin->molecules);
    fluid_clear(&twin->fluid);
}

/// k of the parabola through U where it is well known, weighted by its errors, and the rms of what
/// is left in errors.
static void fit_parabola(const struct inversion *inversion, size_t g, double unit, double *k,
                         double *deviation) {
    const struct potential_grid *grid = inversion_grid(inversion);
    double normal[3][4] = {{0}}, sum = 0, count = 0, c[3];
    for (int pass = 0; pass < 2; pass++) {
        for (size_t a = 0; a < grid->known; a++) {
            const size_t point = grid->known_point[a];
            if (!grid->well_known[a] || point < grid->group[g].point ||
                point >= grid->group[g].point + grid->group[g].own.points)
                continue;
            const double q = unit * grid->r[point] - (g == 0 ? 0.6 : 110 * M_PI / 180);
            const double error = inversion->course.band.error[point],
                         u = inversion->course.best.phi[point];
            const double row[4] = {1, q, q * q, u};
            for (int i = 0; i < 3 && pass == 0; i++)
                for (int j = 0; j < 4; j++)
                    normal[i][j] += row[i] * row[j] / (error * error);
            if (pass == 1) {
                sum += pow((u - c[0] - c[1] * q - c[2] * q * q) / error, 2);
                count++;
            }
        }
        for (int i = 0; i < 3 && pass == 0; i++)
            for (int j = 0; j < 3; j++)
                for (int n = 3; n >= i && j != i; n--)
                    normal[j][n] -= normal[j][i] / normal[i][i] * normal[i][n];
        for (int i = 0; i < 3 && pass == 0; i++)
            c[i] = normal[i][3] / normal[i][i];
    }
    *k = 2 * c[2];
    *deviation = sqrt(sum / count);
}

static void check_pairs(const struct inversion *inversion) {
    const struct potential_grid *grid = inversion_grid(inversion);
    double above = 0, below = 0, squares = 0, count = 0;
    for (size_t a = 0; a < grid->pairs_known; a++) {
        const size_t point = grid->known_point[a];
        const double r = grid->r[point], shape = mf_potential_grid_ramp(grid, point);
        const double truth = r < 1 ? repulsion * (1 - r) * (1 - r) / 2 : 0;
        const double off = inversion->course.best.phi[point] - truth;
        if (!grid->well_known[a])
            continue;
        above += shape * off;
        below += shape * shape;
        squares += off * off;
        count++;
    }
    const double rms = sqrt((squares - above * above / below) / count);
    print_message("pairs: rms without the ramp %.4f, ramp %.3f (%.3f)\n", rms, above / below,
                  inversion->course.band.ramp.error);
    assert_true(rms < 0.1);
}

/// k of the parabolas within 5 %, which is 0.6 % of the distribution's width times some; returns
/// the mean square over both groups of what is left in errors, which is up to `max` in each.
static double check_parabolas(const struct inversion *inversion, double max) {
    static const double truth[] = {spring, bend}, unit[] = {1, M_PI / 180};
    double squares = 0;
    for (size_t g = 0; g < 2; g++) {
        double k, deviation;
        fit_parabola(inversion, g, unit[g], &k, &deviation);
        print_message("group %zu: k = %.3f of %g, deviations %.2f bands\n", g, k, truth[g],
                      deviation);
        assert_true(fabs(k / truth[g] - 1) < 0.05);
        assert_true(deviation < max);
        squares += deviation * deviation / 2;
    }
    return squares;
}

static double true_energy(size_t g, double q) {
    return g == 0 ? spring / 2 * pow(q - 0.6, 2) : bend / 2 * pow((q - 110) * M_PI / 180, 2);
}

/// Mean square of U − U_true over its stated error where U is well known, of one group; a constant
/// of U is none, so that both have the mean 0 over the target.
static double find_deviation(const struct inversion *inversion, size_t g) {
    const struct potential_grid *grid = inversion_grid(inversion);
    size_t first = grid->pairs_known;
    for (size_t before = 0; before < g; before++)
        first += grid->group[before].own.known;
    const size_t end = first + grid->group[g].own.known;
    double mean = 0, sum = 0, squares = 0, count = 0;
    for (int pass = 0; pass < 2; pass++)
        for (size_t a = first; a < end; a++) {
            const size_t point = grid->known_point[a];
            const double weight = inversion->state->target.counts[grid->known_bin[a]];
            const double off = inversion->course.best.phi[point] - true_energy(g, grid->r[point]);
            if (pass == 0) {
                mean += weight * off;
                sum += weight;
            } else if (grid->well_known[a]) {
                squares += pow((off - mean / sum) / inversion->course.band.error[point], 2);
                count++;
            }
        }
    print_message("group %zu: off by %.2f stated errors\n", g, sqrt(squares / count));
    return squares / count;
}

/// What a fit is assessed by; returns a mean square over both groups.
typedef double judgement(const struct inversion *inversion);

/// The deviations from a parabola, as large as the bands say within what smoothing takes off and
/// misfit adds.
static double assess_parabolas(const struct inversion *inversion) {
    return check_parabolas(inversion, 1.6);
}

/// Bins deviate together that few coefficients make: eight of these are above 2 on average in one
/// case of 1000, if the errors are honest. What is no parabola is a small part of the error of so
/// few, so that U itself is compared.
static double assess_deviations(const struct inversion *inversion) {
    check_parabolas(inversion, 2.5);
    return (find_deviation(inversion, 0) + find_deviation(inversion, 1)) / 2;
}

/// Its seed is the twin's.
/// @param[in] particles  of the system that is sampled; 0: all
static double find(const struct inverse_method *method, const struct twin *twin, int64_t particles,
                   judgement *assess) {
    void *state = mf_memory_zeroed(1, method->state_size);
    struct inversion_parameters *settings = mf_memory_zeroed(1, method->parameters_size);
    struct inverse_step step;
    for (const struct inverse_table *table = method->tables; table->fields; table++)
        mf_fields_set_defaults(table->fields, (char *)settings + table->offset);
    settings->particles = particles;
    settings->replicas = 4;
    settings->equilibration = 60;
    settings->precision = 0.008;
    assert_ok(method->create(state, method, &twin->problem, settings));
    do {
        assert_ok(method->iterate(state, &step, &listener));
        print_message("%s, iteration %u: error %.4f, noise %.4f\n", method->name, step.iteration,
                      step.error, step.noise);
    } while (!step.finished);
    assert_true(step.converged);
    const struct inversion *inversion = state;
    check_pairs(inversion);
    const double squares = assess(inversion);
    method->destroy(state);
    mf_memory_free(state);
    mf_memory_free(settings);
    return squares;
}

enum { TWIN_SEED = 21 };

/// The first twin, which all methods look into.
static struct twin first_twin;

static int make_first_twin(void **state) {
    (void)state;
    make_twin(&first_twin, TWIN_SEED);
    return 0;
}

static int clear_first_twin(void **state) {
    (void)state;
    clear_twin(&first_twin);
    return 0;
}

static void test_imc_finds_pairs_bonds_and_angles_at_once(void **state) {
    (void)state;
    assert_true(find(&mf_imc, &first_twin, 0, assess_parabolas) > pow(0.2, 2));
}

static void test_imc_finds_them_in_half_of_the_system(void **state) {
    (void)state;
    enum { HALF = CHAINS / 2 * BEADS };
    assert_true(find(&mf_imc, &first_twin, HALF, assess_parabolas) > pow(0.2, 2));
}

static void test_ibi_finds_pairs_bonds_and_angles_at_once(void **state) {
    (void)state;
    assert_true(find(&mf_ibi, &first_twin, 0, assess_parabolas) > pow(0.2, 2));
}

/// The bands of four fits are as wide as they should be. Of 152 twins off over stated is 1.00(3),
/// both groups together, and its square scatters as that of 5.1 independent numbers: of four twins
/// below 0.5 in 2 of 10,000 cases, above 1.6 in 1.4. In short two of them: below 0.4 in 13 of
/// 10,000, above 1.8 in 3.
static void test_relative_entropy_finds_pairs_bonds_and_angles_at_once(void **state) {
    (void)state;
    const uint64_t fits = length_is_long() ? 4 : 2;
    double squares = find(&mf_relative_entropy, &first_twin, 0, assess_deviations);
    for (uint64_t fit = 1; fit < fits; fit++) {
        static struct twin twin;
        make_twin(&twin, TWIN_SEED + fit);
        squares += find(&mf_relative_entropy, &twin, 0, assess_deviations);
        clear_twin(&twin);
    }
    squares /= (double)fits;
    print_message("all: off by %.2f stated errors\n", sqrt(squares));
    assert_true(sqrt(squares) > (length_is_long() ? 0.5 : 0.4));
    assert_true(sqrt(squares) < (length_is_long() ? 1.6 : 1.8));
}

/// Dimers of which the bond alone is looked for; nothing else acts.
struct dimers {
    struct fluid fluid;
    struct molecules molecules;
    struct bonded_settings bond;
    double target[BOND_BINS], error[BOND_BINS];
    struct inverse_problem problem;
};

static const struct bonded_bins wide_bins = {0.2, 1.2 / BOND_BINS, BOND_BINS};

/// Two wells, which no parabola makes: their p, with the errors of 20,000 counts.
static void make_dimers(struct dimers *dimers) {
    struct formula_soft_repulsion_parameters none = {1e-9, 1};
    const struct curve curve = {&mf_formula_soft_repulsion, &none};
    const struct composition composition =
        molecules_topology(&dimers->molecules.topology, molecules_chain(CHAINS, type, 2, 0, 1),
                           (struct topology_kind){0}, 1, NULL);
    double sum = 0;
    molecules_add_group(&dimers->molecules, BONDED_BOND, &mf_bond_table, NULL);
    fluid_groot_warren(&dimers->fluid, CHAINS * 2, 0.004);
    mf_table_clear(&dimers->fluid.potential);
    assert_ok(mf_table_init_potential(&dimers->fluid.potential, &curve));
    molecules_enter(&dimers->fluid.setup, &dimers->molecules, &composition);
    for (size_t k = 0; k < BOND_BINS; k++) {
        const double r = bonded_bins_centre(&wide_bins, k), x = (r - 0.8) / 0.2;
        dimers->target[k] = r * r * exp(-0.3 * (x * x - 1) * (x * x - 1));
        sum += dimers->target[k] * wide_bins.width;
    }
    for (size_t k = 0; k < BOND_BINS; k++) {
        dimers->target[k] /= sum;
        dimers->error[k] = sqrt(dimers->target[k] / wide_bins.width / 20000);
    }
    const int bond = mf_bonded_distribution_kind(BONDED_BOND);
    dimers->problem = (struct inverse_problem){.scene = dimers->fluid.setup,
                                               .core_threshold = 1e-3,
                                               .core_stiffness = 2000,
                                               .seed = 6,
                                               .threads = 2,
                                               .bonded = 1};
    dimers->problem.unknown[UNKNOWN_BONDED].wanted = true;
    dimers->problem.group[0] = (struct bonded_unknown){BONDED_BOND, 0, wide_bins, 0, {0}};
    dimers->bond.target[0] = wide_bins;
    dimers->problem.targets.target[bond] =
        (struct target){.count = BOND_BINS, .value = dimers->target, .error = dimers->error};
    dimers->problem.targets.settings[mf_observable_kind(bond).place] = &dimers->bond;
}

/// Means of r and r² with p, or with exp(−U/k_B T) r² by quadrature where p is known.
static void find_moments(const struct inversion *inversion, const double *p, double moment[2]) {
    enum { PLACES = 4000 };
    const struct bonded_grid *grid = &inversion_grid(inversion)->group[0].own;
    double sum = 0, above[2] = {0};
    if (p) {
        for (size_t k = grid->first; k < grid->first + grid->known; k++) {
            const double r = bonded_bins_centre(&wide_bins, k);
            sum += p[k];
            above[0] += r * p[k];
            above[1] += r * r * p[k];
        }
    } else {
        struct bonded_curve curve = {0};
        const double low = wide_bins.low + wide_bins.width * (double)grid->first,
                     high = low + wide_bins.width * (double)grid->known;
        assert_ok(mf_bonded_grid_curve(grid, inversion->course.best.phi, &curve));
        for (int k = 0; k < PLACES; k++) {
            const double r = low + (high - low) * (k + 0.5) / PLACES;
            double energy;
            mf_bonded_value(&curve, r, &energy, NULL);
            const double weight = r * r * exp(-energy);
            sum += weight;
            above[0] += r * weight;
            above[1] += r * r * weight;
        }
        mf_bonded_clear(&curve);
    }
    moment[0] = above[0] / sum;
    moment[1] = above[1] / sum;
}

/// Of all parabolas that have the target's ⟨r⟩ and ⟨r²⟩ there is one, and it has the least relative
/// entropy (an exponential family, whose sufficient statistics these are). It converges to that,
/// although the two wells are out of its reach. 20,000 counts know ⟨r⟩ within 0.0015, ⟨r²⟩ within
/// 0.0025; the samples' own noise is below 0.01 of p, which a 5 of that covers; the bins add less.
static void test_relative_entropy_of_a_parabola_keeps_the_moments(void **state) {
    (void)state;
    static struct dimers dimers;
    const struct inverse_method *method = &mf_relative_entropy;
    struct inversion *inversion = mf_memory_zeroed(1, method->state_size);
    struct relative_entropy_parameters settings = {.common = {0}};
    struct inverse_step step;
    double wanted[2], found[2];
    make_dimers(&dimers);
    for (const struct inverse_table *table = method->tables; table->fields; table++)
        mf_fields_set_defaults(table->fields, (char *)&settings + table->offset);
    settings.common.replicas = 4;
    settings.common.equilibration = 60;
    settings.size.group_coefficients = 2;
    assert_ok(method->create(inversion, method, &dimers.problem, &settings));
    do {
        assert_ok(method->iterate(inversion, &step, &listener));
        print_message("iteration %u: error %.4f, noise %.4f, gradient %.2f\n", step.iteration,
                      step.error, step.noise, inversion->state->basis.miss);
    } while (!step.finished);
    assert_true(step.converged);
    assert_true(step.error > 5 * step.noise);
    find_moments(inversion, dimers.target, wanted);
    find_moments(inversion, NULL, found);
    print_message("<r> %.4f of %.4f, <r^2> %.4f of %.4f\n", found[0], wanted[0], found[1],
                  wanted[1]);
    assert_true(fabs(found[0] - wanted[0]) < 0.006);
    assert_true(fabs(found[1] - wanted[1]) < 0.01);
    method->destroy(inversion);
    mf_memory_free(inversion);
    mf_molecules_clear(&dimers.molecules);
    fluid_clear(&dimers.fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_imc_finds_pairs_bonds_and_angles_at_once),
        cmocka_unit_test(test_imc_finds_them_in_half_of_the_system),
        LENGTH_ONLY_LONG(cmocka_unit_test(test_ibi_finds_pairs_bonds_and_angles_at_once)),
        cmocka_unit_test(test_relative_entropy_finds_pairs_bonds_and_angles_at_once),
        cmocka_unit_test(test_relative_entropy_of_a_parabola_keeps_the_moments),
    };
    return cmocka_run_group_tests(tests, make_first_twin, clear_first_twin);
}
