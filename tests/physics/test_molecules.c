// SPDX-License-Identifier: GPL-3.0-or-later
//
// Molecules against exact statistics: without pair potentials the bonds, angles and dihedrals of a
// chain are independent of each other, with p(r) ~ r^2 exp(-U/T), p(theta) ~ sin(theta) exp(-U/T)
// and p(phi) ~ exp(-U/T) (P. J. Flory, Statistical Mechanics of Chain Molecules, 1969). Molecules
// are independent, so that their scatter gives the errors whatever the correlation in time.
#include "base/memory.h"
#include "base/statistics.h"
#include "curves/formula.h"
#include "dynamics/respa.h"
#include "forces/bonded.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

static const int type[64] = {0};
static const struct molecules_number spring[] = {{"k", 60}, {"length", 0.7}, {NULL, 0}};
static const struct molecules_number bend[] = {{"k", 6}, {"angle", 110}, {NULL, 0}};
static const struct molecules_number twist[] = {
    {"k", 1}, {"multiplicity", 2}, {"phase", 70}, {NULL, 0}};

struct gas {
    struct fluid fluid;
    struct molecules molecules;
    struct simulation simulation;
};

/// Chains without pair potentials, with friction between all beads in range, bonded or not.
static void make_gas(struct gas *gas, int64_t count, int beads, int highest,
                     const struct integrator *integrator, const void *parameters,
                     double time_step) {
    gas->molecules = (struct molecules){0};
    const struct composition composition = molecules_topology(
        &gas->molecules.topology, molecules_chain(count, type, beads, highest, 0),
        (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&gas->molecules, BONDED_BOND, &mf_bond_harmonic, spring);
    if (highest >= BONDED_ANGLE)
        molecules_add_group(&gas->molecules, BONDED_ANGLE, &mf_angle_harmonic, bend);
    if (highest >= BONDED_DIHEDRAL)
        molecules_add_group(&gas->molecules, BONDED_DIHEDRAL, &mf_dihedral_periodic, twist);
    fluid_ideal_gas(&gas->fluid, 3, count * beads, time_step);
    gas->fluid.setup.integrator = integrator;
    gas->fluid.setup.integrator_parameters = parameters;
    if (!integrator->dissipative)
        gas->fluid.setup.omega = NULL;
    gas->fluid.setup.placement.kind = PLACEMENT_LATTICE;
    for (int d = 0; d < 3; d++)
        gas->fluid.setup.box.length[d] = cbrt((double)(count * beads) / 5);
    molecules_enter(&gas->fluid.setup, &gas->molecules, &composition);
    assert_ok(mf_simulation_init(&gas->simulation, &gas->fluid.setup, NULL));
}

static void clear_gas(struct gas *gas) {
    mf_simulation_clear(&gas->simulation);
    mf_molecules_clear(&gas->molecules);
    fluid_clear(&gas->fluid);
}

// Distributions -----------------------------------------------------------------------------------

enum { BINS = 24, BEADS = 4 };

static double weight(const struct bonded_curve *curve, int order, double q) {
    double energy;
    mf_bonded_value(curve, q, &energy, NULL);
    return exp(-energy) * (order == BONDED_BOND ? q * q : order == BONDED_ANGLE ? sin(q) : 1);
}

/// ∫ of the weight by Simpson's rule.
static double integrate(const struct bonded_curve *curve, int order, double from, double to) {
    enum { HALVES = 200 };
    const double h = (to - from) / (2 * HALVES);
    double sum = 0;
    for (int k = 0; k < HALVES; k++)
        sum += weight(curve, order, from + 2 * k * h) +
               4 * weight(curve, order, from + (2 * k + 1) * h) +
               weight(curve, order, from + (2 * k + 2) * h);
    return sum * h / 3;
}

/// Where bins are: a bond is beyond them once in 10^8 samples.
static void find_range(int order, double *low, double *high) {
    *low = order == BONDED_BOND ? 0.05 : order == BONDED_ANGLE ? 0 : -M_PI;
    *high = order == BONDED_BOND ? 1.4 : M_PI;
}

static void count_terms(const struct gas *gas, int order, double (*histogram)[BINS]) {
    const struct topology_kind *kind = &gas->molecules.topology.kind[0];
    double low, high;
    find_range(order, &low, &high);
    for (int64_t m = 0; m < kind->count; m++)
        for (int n = 0; n < kind->terms[order]; n++) {
            int32_t place[BONDED_MAX_TERM_BEADS];
            double q;
            for (int k = 0; k < mf_bonded_kinds[order]->beads; k++)
                place[k] = (int32_t)gas->simulation.particles
                               .place[topology_id(kind, m, kind->term[order][n].bead[k])];
            mf_bonded_measure(order, 1, place, &gas->simulation.particles, &q);
            const int bin = (int)floor((q - low) / (high - low) * BINS);
            histogram[m][bin < 0 ? 0 : bin < BINS ? bin : BINS - 1]++;
        }
}

/// Largest deviation of any bin from the exact distribution, in standard errors of the scatter of
/// the molecules, for bins with 50 counts or more.
static double largest_deviation(const struct gas *gas, int order, double (*histogram)[BINS],
                                int samples) {
    const struct topology_kind *kind = &gas->molecules.topology.kind[0];
    const struct bonded_curve *curve = &gas->molecules.group[order][0].curve;
    const double all = samples * kind->terms[order];
    double low, high, largest = 0;
    find_range(order, &low, &high);
    const double whole =
        integrate(curve, order, order == BONDED_BOND ? 0 : low, order == BONDED_BOND ? 2 : high);
    for (int bin = 0; bin < BINS; bin++) {
        const double from = low + (high - low) * bin / BINS;
        const double exact =
            integrate(curve, order, from, from + (high - low) / BINS) / whole * all;
        struct running_mean mean = {0};
        for (int64_t m = 0; m < kind->count; m++)
            mf_statistics_add(&mean, histogram[m][bin]);
        if (exact * (double)kind->count > 50)
            largest = fmax(largest, fabs(mean.mean - exact) / mf_statistics_standard_error(&mean));
    }
    return largest;
}

/// 3 distributions of at most 24 bins and 3 integrators: 216 deviations, of which one beyond 4.5
/// comes about once in a thousand seeds.
static void check_distributions(const struct integrator *integrator, const void *parameters,
                                double time_step, int every) {
    enum { MOLECULES = 1000 };
    const int64_t molecules = length_is_long() ? MOLECULES : 500;
    const int samples = length_is_long() ? 200 : 60;
    static double histogram[BONDED_KINDS][MOLECULES][BINS];
    struct gas gas;
    memset(histogram, 0, sizeof histogram);
    make_gas(&gas, molecules, BEADS, BONDED_DIHEDRAL, integrator, parameters, time_step);
    assert_ok(mf_simulation_run(&gas.simulation, (uint64_t)(20 * every)));
    for (int n = 0; n < samples; n++) {
        assert_ok(mf_simulation_run(&gas.simulation, (uint64_t)every));
        for (int order = 0; order < BONDED_KINDS; order++)
            count_terms(&gas, order, histogram[order]);
    }
    for (int order = 0; order < BONDED_KINDS; order++) {
        const double deviation = largest_deviation(&gas, order, histogram[order], samples);
        print_message("%s, %ss: largest deviation %.2f standard errors\n", integrator->name,
                      mf_bonded_kinds[order]->name, deviation);
        assert_true(deviation < 4.5);
    }
    clear_gas(&gas);
}

static void test_ideal_chains_have_exact_distributions_with_friction(void **state) {
    (void)state;
    check_distributions(&mf_aboba, NULL, 0.01, 40);
}

/// Friction and noise act once in a step that is as long as a tenth of the period of a bond.
static void test_ideal_chains_have_exact_distributions_with_inner_steps(void **state) {
    (void)state;
    static const struct respa_parameters inner = {6};
    check_distributions(&mf_aboba, &inner, 0.04, 10);
}

static void test_ideal_chains_have_exact_distributions_without_velocities(void **state) {
    (void)state;
    check_distributions(&mf_brownian, NULL, 0.0005, 100);
}

// Sizes -------------------------------------------------------------------------------------------

/// Σ over beads of a molecule, unwrapped along its bonds: R_e² and R_g².
static void find_sizes(const struct gas *gas, int64_t m, double *end, double *gyration) {
    const struct topology_kind *kind = &gas->molecules.topology.kind[0];
    const struct particles *particles = &gas->simulation.particles;
    *end = *gyration = 0;
    for (int d = 0; d < 3; d++) {
        double x = 0, sum = 0, squares = 0;
        for (int bead = 1; bead < kind->beads; bead++) {
            const double *position = particles->position[d];
            x += box_nearest(position[particles->place[topology_id(kind, m, bead)]] -
                                 position[particles->place[topology_id(kind, m, bead - 1)]],
                             particles->box.length[d]);
            sum += x;
            squares += x * x;
        }
        *end += x * x;
        *gyration += squares / kind->beads - pow(sum / kind->beads, 2);
    }
}

/// Freely jointed: <R_e²> = n <b²> and <R_g²> = <b²> (N² − 1)/(6 N) with the exact <b²> of the
/// spring. Errors by the scatter of 500 chains, in short of 250; 4 of them: one seed in 8000 fails.
static void test_freely_jointed_chains_have_exact_sizes(void **state) {
    (void)state;
    enum { CHAINS = 500, LENGTH = 10, EVERY = 60 };
    const int64_t chains = length_is_long() ? CHAINS : 250;
    const int samples = length_is_long() ? 200 : 30;
    static struct running_mean end[CHAINS], gyration[CHAINS];
    struct running_mean ends = {0}, gyrations = {0};
    struct gas gas;
    double upper = 0, lower = 0;
    make_gas(&gas, chains, LENGTH, BONDED_BOND, &mf_aboba, NULL, 0.01);
    for (double r = 0.0005; r < 2; r += 0.001) {
        const double w = weight(&gas.molecules.group[BONDED_BOND][0].curve, BONDED_BOND, r);
        upper += r * r * w;
        lower += w;
    }
    const double square = upper / lower, n = LENGTH;
    assert_ok(mf_simulation_run(&gas.simulation, 4000));
    for (int k = 0; k < samples; k++) {
        assert_ok(mf_simulation_run(&gas.simulation, EVERY));
        for (int64_t m = 0; m < chains; m++) {
            double e, g;
            find_sizes(&gas, m, &e, &g);
            mf_statistics_add(&end[m], e);
            mf_statistics_add(&gyration[m], g);
        }
    }
    for (int64_t m = 0; m < chains; m++) {
        mf_statistics_add(&ends, end[m].mean);
        mf_statistics_add(&gyrations, gyration[m].mean);
    }
    print_message("R_e^2 %.4f +- %.4f (exact %.4f), R_g^2 %.4f +- %.4f (exact %.4f)\n", ends.mean,
                  mf_statistics_standard_error(&ends), (n - 1) * square, gyrations.mean,
                  mf_statistics_standard_error(&gyrations), square * (n * n - 1) / (6 * n));
    assert_close(ends.mean, (n - 1) * square, 4 * mf_statistics_standard_error(&ends));
    assert_close(gyrations.mean, square * (n * n - 1) / (6 * n),
                 4 * mf_statistics_standard_error(&gyrations));
    clear_gas(&gas);
}

// Mechanics ---------------------------------------------------------------------------------------

/// Without friction energy and momentum are kept: velocity-verlet's energy has an error of Δt², so
/// that at half the time step it scatters a quarter as much. And it does not drift. The chains are
/// cold: at T = 1 some come to be straight, where a dihedral has no direction and no time step is
/// short enough.
static void test_energy_of_molecules_is_kept_without_friction(void **state) {
    (void)state;
    double scatter[2];
    for (int n = 0; n < 2; n++) {
        struct gas gas;
        const double time_step = n == 0 ? 0.004 : 0.002;
        struct running_mean first = {0}, last = {0};
        make_gas(&gas, 200, BEADS, BONDED_DIHEDRAL, &mf_velocity_verlet, NULL, time_step);
        mf_simulation_clear(&gas.simulation);
        gas.fluid.setup.temperature = 0.2;
        assert_ok(mf_simulation_init(&gas.simulation, &gas.fluid.setup, NULL));
        gas.simulation.wants = PAIR_FORCES_AND_SUMS;
        const int blocks = 400, each = n == 0 ? 10 : 20;
        assert_ok(mf_simulation_run(&gas.simulation, 200));
        for (int k = 0; k < blocks; k++) {
            assert_ok(mf_simulation_run(&gas.simulation, (uint64_t)each));
            const double energy =
                gas.simulation.sums.energy + mf_particles_kinetic_energy(&gas.simulation.particles);
            mf_statistics_add(k < blocks / 2 ? &first : &last, energy / 800);
        }
        scatter[n] = mf_statistics_standard_error(&first);
        print_message("time step %g: energy %.7f, then %.7f, scatter %.2g\n", time_step, first.mean,
                      last.mean, scatter[n]);
        assert_close(first.mean, last.mean, 20 * scatter[n]);
        for (int d = 0; d < 3; d++)
            assert_close(mf_particles_mean_velocity(&gas.simulation.particles, d), 0, 1e-12);
        clear_gas(&gas);
    }
    assert_close(scatter[0] / scatter[1], 4, 1.5);
}

/// Beads of masses 1 and 8 in a dimer share the kinetic energy alike, and the bond length does not
/// know of them.
static void check_masses(double time_step, int64_t inner_steps) {
    const struct respa_parameters parameters = {inner_steps};
    static const int ab[] = {0, 1};
    enum { DIMERS = 1500 };
    struct molecules molecules = {0};
    struct fluid fluid;
    struct simulation simulation;
    struct running_mean kinetic[2] = {{.count = 0}};
    const struct composition composition =
        molecules_topology(&molecules.topology, molecules_chain(DIMERS, ab, 2, BONDED_BOND, 0),
                           (struct topology_kind){0}, 2, NULL);
    molecules_add_group(&molecules, BONDED_BOND, &mf_bond_harmonic, spring);
    fluid_groot_warren(&fluid, 2 * DIMERS, time_step);
    fluid.setup.omega = NULL;
    fluid.setup.integrator = &mf_velocity_verlet;
    fluid.setup.integrator_parameters = &parameters;
    fluid.setup.attribute[ATTRIBUTES_MASS] =
        (struct attributes_source){.ranges = 2, .range = {{1, 1}, {8, 8}}};
    molecules_enter(&fluid.setup, &molecules, &composition);
    assert_ok(mf_simulation_init(&simulation, &fluid.setup, NULL));
    const uint64_t every = (uint64_t)llround(0.25 / time_step);
    assert_ok(mf_simulation_run(&simulation, 80 * every));
    for (int n = 0; n < 200; n++) {
        double sum[2] = {0};
        assert_ok(mf_simulation_run(&simulation, every));
        for (size_t k = 0; k < simulation.particles.count; k++) {
            const int heavy = simulation.particles.id[k] >= DIMERS;
            for (int d = 0; d < 3; d++)
                sum[heavy] += (heavy ? 8 : 1) * pow(simulation.particles.velocity[d][k], 2);
        }
        mf_statistics_add(&kinetic[0], sum[0] / (3 * DIMERS));
        mf_statistics_add(&kinetic[1], sum[1] / (3 * DIMERS));
    }
    print_message("temperatures of masses 1 and 8: %.4f and %.4f\n", kinetic[0].mean,
                  kinetic[1].mean);
    assert_close_relative(kinetic[0].mean, kinetic[1].mean, 0.01);
    mf_simulation_clear(&simulation);
    mf_molecules_clear(&molecules);
    fluid_clear(&fluid);
}

static void test_unlike_masses_have_the_same_temperature(void **state) {
    (void)state;
    if (length_is_long())
        check_masses(0.005, 1);
    check_masses(0.02, 4);
}

// A melt ------------------------------------------------------------------------------------------

static void make_melt(struct gas *gas, int64_t chains, int length) {
    static const struct molecules_number fene[] = {{"k", 30}, {"longest", 1.5}, {NULL, 0}};
    struct curve curve;
    gas->molecules = (struct molecules){0};
    const struct composition composition = molecules_topology(
        &gas->molecules.topology, molecules_chain(chains, type, length, BONDED_BOND, 0),
        (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&gas->molecules, BONDED_BOND, &mf_bond_fene, fene);
    fluid_groot_warren(&gas->fluid, chains * length, 0.005);
    mf_table_clear(&gas->fluid.potential);
    assert_ok(mf_curve_create(&curve, &mf_formula_lennard_jones));
    ((struct formula_lennard_jones_parameters *)curve.parameters)->cutoff = pow(2, 1.0 / 6);
    assert_ok(mf_table_init_potential(&gas->fluid.potential, &curve));
    mf_curve_clear(&curve);
    mf_table_clear(&gas->fluid.omega);
    assert_ok(mf_curve_create(&curve, &mf_formula_power_omega));
    ((struct formula_power_omega_parameters *)curve.parameters)->cutoff = 1.5;
    assert_ok(mf_table_init_omega(&gas->fluid.omega, &curve));
    mf_curve_clear(&curve);
    gas->fluid.setup.integrator = &mf_aboba;
    gas->fluid.setup.placement.kind = PLACEMENT_LATTICE;
    for (int d = 0; d < 3; d++)
        gas->fluid.setup.box.length[d] = cbrt((double)(chains * length) / 0.85);
    molecules_enter(&gas->fluid.setup, &gas->molecules, &composition);
    assert_ok(mf_simulation_init(&gas->simulation, &gas->fluid.setup, NULL));
}

/// The melt of K. Kremer and G. S. Grest, J. Chem. Phys. 92, 5057 (1990): density 0.85, T = 1,
/// whose bonds are 0.964 long (H.-P. Hsu and K. Kremer, J. Chem. Phys. 144, 154907 (2016)). The
/// chains are far from having forgotten where they began (a relaxation takes a thousand τ and
/// more), the bonds are not: none is caught by another one, which holds both at 1.33, 20 k_B T
/// above a free bond. The time step of 0.005 leaves the temperature within 2 %.
static void test_melt_of_kremer_and_grest_has_its_bonds(void **state) {
    (void)state;
    enum { CHAINS = 40, LENGTH = 50 };
    struct gas gas;
    struct running_mean bond = {0}, temperature = {0};
    double longest = 0;
    make_melt(&gas, CHAINS, LENGTH);
    const struct particles *particles = &gas.simulation.particles;
    const struct topology_kind *kind = &gas.molecules.topology.kind[0];
    const int samples = length_is_long() ? 100 : 50;
    assert_ok(mf_simulation_run(&gas.simulation, (uint64_t)(100 * samples)));
    for (int n = 0; n < samples; n++) {
        assert_ok(mf_simulation_run(&gas.simulation, 100));
        mf_statistics_add(&temperature, mf_simulation_temperature(&gas.simulation));
        for (int64_t m = 0; m < CHAINS; m++)
            for (int k = 0; k + 1 < LENGTH; k++) {
                const int32_t place[] = {(int32_t)particles->place[topology_id(kind, m, k)],
                                         (int32_t)particles->place[topology_id(kind, m, k + 1)]};
                double length;
                mf_bonded_measure(BONDED_BOND, 1, place, particles, &length);
                mf_statistics_add(&bond, length);
                longest = fmax(longest, length);
            }
    }
    print_message("bond %.4f (published 0.964), longest %.3f, temperature %.4f\n", bond.mean,
                  longest, temperature.mean);
    assert_close(bond.mean, 0.964, 0.002);
    assert_true(longest < 1.25);
    assert_close(temperature.mean, 1, 0.02);
    clear_gas(&gas);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ideal_chains_have_exact_distributions_with_friction),
        cmocka_unit_test(test_ideal_chains_have_exact_distributions_with_inner_steps),
        cmocka_unit_test(test_ideal_chains_have_exact_distributions_without_velocities),
        cmocka_unit_test(test_freely_jointed_chains_have_exact_sizes),
        cmocka_unit_test(test_energy_of_molecules_is_kept_without_friction),
        cmocka_unit_test(test_unlike_masses_have_the_same_temperature),
        cmocka_unit_test(test_melt_of_kremer_and_grest_has_its_bonds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
