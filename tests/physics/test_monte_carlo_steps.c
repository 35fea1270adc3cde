// SPDX-License-Identifier: GPL-3.0-or-later
//
// Monte Carlo as an integrator, equilibrated and sampled as `mesofit simulate` does, against
// integrals that need no Markov chain: free chains have the Boltzmann factors of their laws with
// the measures r², sin θ and 1 (P. J. Flory, Statistical Mechanics of Chain Molecules, 1969), and
// two particles in a box meet with exp(−Φ/T). The melt is in test_molecule_samplers.
#include "base/comoments.h"
#include "forces/bonded.h"
#include "observe/measure.h"
#include "shared/fluids.h"
#include "shared/hotelling.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

enum { BLOCKS = 60, MAX = 8 };

/// Each of the four comparisons fails by chance in one of 10,000 seeds: the file in one of 2,500.
static const double false_alarm_rate = 1e-4;

// An observable of the test's own ---------------------------------------------------------------

/// Means over a configuration, averaged in blocks.
struct probe {
    void (*look)(const struct simulation *simulation, double *values);
    size_t size;
    int each; ///< samples of a block
    int samples;
    double sum[MAX];
    struct comoments blocks;
};

static enum status take(void *state, const struct configuration *configuration) {
    struct probe *probe = state;
    double values[MAX] = {0};
    probe->look(configuration->simulation, values);
    for (size_t k = 0; k < probe->size; k++)
        probe->sum[k] += values[k] / probe->each;
    if (++probe->samples % probe->each == 0) {
        mf_comoments_add(&probe->blocks, probe->sum);
        memset(probe->sum, 0, sizeof probe->sum);
    }
    return STATUS_OK;
}

static const struct observable probing = {.name = "probe", .sums = true, .sample = take};

/// Equilibrate and sample the setup by Monte Carlo, for probes of as many samples a block.
static void measure(const struct simulation_setup *setup, int64_t equilibration, int64_t every,
                    struct probe *probes, size_t count) {
    const struct measure_plan plan = {
        .equilibration = equilibration, .samples = BLOCKS * probes[0].each, .every = every};
    struct observable_use uses[BONDED_KINDS + 1] = {{NULL, NULL, NULL}};
    struct simulation_setup by_moves = *setup;
    struct simulation simulation;
    double temperature;
    by_moves.integrator = &mf_monte_carlo;
    by_moves.omega = NULL;
    for (size_t k = 0; k < count; k++) {
        uses[k] = (struct observable_use){&probing, &probes[k], NULL};
        assert_ok(mf_comoments_init(&probes[k].blocks, probes[k].size));
    }
    assert_ok(mf_simulation_init(&simulation, &by_moves, NULL));
    assert_ok(mf_measure_equilibrate(&simulation, &plan, &temperature, NULL));
    assert_ok(mf_measure_sample(&simulation, &plan, uses, NULL));
    mf_simulation_clear(&simulation);
}

static void compare(const char *what, struct probe *probe, const double *exact) {
    const double p = hotelling_one_sample(&probe->blocks, exact);
    for (size_t k = 0; k < probe->size; k++)
        print_message("%s: %.5f(%.5f), exactly %.5f\n", what, probe->blocks.mean[k],
                      sqrt(mf_comoments_covariance(&probe->blocks, k, k) / (BLOCKS - 1)), exact[k]);
    print_message("%s: p = %.3g\n", what, p);
    assert_true(p > false_alarm_rate);
    mf_comoments_clear(&probe->blocks);
}

// Free chains -------------------------------------------------------------------------------------

enum { CHAINS = 30, BEADS = 4, COUNT = CHAINS * BEADS };

static const double spring = 60, rest = 0.7, stiffness = 6, bent = 110, torsion = 1, phase = 70;

/// Bins that do not cover all, so that their sum is free; rare ones would not be normal in a block.
static const struct {
    double low, width;
    int bins;
} ranges[BONDED_KINDS] = {{0.4, 0.1, 6}, {60 * M_PI / 180, M_PI / 12, 6}, {-2.5, 0.7, 7}};

/// exp(−U) with its measure, as the laws are written in books.
static double density(int order, double q) {
    if (order == BONDED_BOND)
        return q * q * exp(-spring * pow(q - rest, 2) / 2);
    if (order == BONDED_ANGLE)
        return sin(q) * exp(-stiffness * pow(q - bent * M_PI / 180, 2) / 2);
    return exp(-torsion * (1 + cos(2 * q - phase * M_PI / 180)));
}

static double integrate(int order, double low, double high) {
    enum { POINTS = 2000 };
    double sum = 0;
    for (int k = 0; k < POINTS; k++)
        sum += density(order, low + (k + 0.5) * (high - low) / POINTS);
    return sum * (high - low) / POINTS;
}

static void find_probabilities(int order, double *exact) {
    const double all = order == BONDED_BOND    ? integrate(order, 0, 3)
                       : order == BONDED_ANGLE ? integrate(order, 0, M_PI)
                                               : integrate(order, -M_PI, M_PI);
    for (int k = 0; k < ranges[order].bins; k++) {
        const double low = ranges[order].low + k * ranges[order].width;
        exact[k] = integrate(order, low, low + ranges[order].width) / all;
    }
}

static void count_terms(const struct simulation *simulation, int order, double *values) {
    const struct molecules *molecules =
        mf_molecules_find(simulation->setup.interaction, simulation->setup.interactions);
    const struct topology_kind *kind = &molecules->topology.kind[0];
    for (int64_t m = 0; m < CHAINS; m++)
        for (int n = 0; n < kind->terms[order]; n++) {
            int32_t place[BONDED_MAX_TERM_BEADS];
            double q;
            for (int k = 0; k < mf_bonded_kinds[order]->beads; k++)
                place[k] = (int32_t)simulation->particles
                               .place[topology_id(kind, m, kind->term[order][n].bead[k])];
            mf_bonded_measure(order, 1, place, &simulation->particles, &q);
            const double bin = (q - ranges[order].low) / ranges[order].width;
            if (bin >= 0 && bin < ranges[order].bins)
                values[(int)bin] += 1.0 / (CHAINS * kind->terms[order]);
        }
}

static void count_bonds(const struct simulation *simulation, double *values) {
    count_terms(simulation, BONDED_BOND, values);
}

static void count_angles(const struct simulation *simulation, double *values) {
    count_terms(simulation, BONDED_ANGLE, values);
}

static void count_dihedrals(const struct simulation *simulation, double *values) {
    count_terms(simulation, BONDED_DIHEDRAL, values);
}

static void test_free_chains_have_the_distributions_of_their_integrals(void **state) {
    static const int type[BEADS] = {0};
    static const struct molecules_number bond[] = {{"k", 60}, {"length", 0.7}, {NULL, 0}};
    static const struct molecules_number bend[] = {{"k", 6}, {"angle", 110}, {NULL, 0}};
    static const struct molecules_number twist[] = {
        {"k", 1}, {"multiplicity", 2}, {"phase", 70}, {NULL, 0}};
    void (*const look[])(const struct simulation *, double *) = {count_bonds, count_angles,
                                                                 count_dihedrals};
    static const char *const names[] = {"bonds", "angles", "dihedrals"};
    struct molecules molecules = {0};
    struct fluid fluid;
    (void)state;
    const struct composition composition =
        molecules_topology(&molecules.topology, molecules_chain(CHAINS, type, BEADS, 2, 2),
                           (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&molecules, BONDED_BOND, &mf_bond_harmonic, bond);
    molecules_add_group(&molecules, BONDED_ANGLE, &mf_angle_harmonic, bend);
    molecules_add_group(&molecules, BONDED_DIHEDRAL, &mf_dihedral_periodic, twist);
    fluid_ideal_gas(&fluid, 3, COUNT, 0.01);
    molecules_enter(&fluid.setup, &molecules, &composition);
    struct probe probes[BONDED_KINDS];
    for (int order = 0; order < BONDED_KINDS; order++)
        probes[order] =
            (struct probe){.look = look[order], .size = (size_t)ranges[order].bins, .each = 40};
    measure(&fluid.setup, 600, 24, probes, BONDED_KINDS);
    for (int order = 0; order < BONDED_KINDS; order++) {
        double exact[MAX];
        find_probabilities(order, exact);
        compare(names[order], &probes[order], exact);
    }
    mf_molecules_clear(&molecules);
    fluid_clear(&fluid);
}

// Two particles -----------------------------------------------------------------------------------

/// Soft repulsion Φ = a (1 − r)²/2, hot enough for a pair to meet at all distances.
static const double repulsion = 25, edge = 3, temperature = 5;

static double energy_at(double r) {
    return r < 1 ? repulsion * (1 - r) * (1 - r) / 2 : 0;
}

enum { PAIR_BINS = 4, FIFTHS = PAIR_BINS + 1 };

/// ⟨Φ⟩, ⟨r·F⟩, and the probabilities of distances in fifths of the cutoff but the first: the pair's
/// distance is uniform in the box but for exp(−Φ), and Φ ends before the box does.
static void find_pair(double *exact) {
    enum { POINTS = 20000 };
    double all = pow(edge, 3) - 4 * M_PI / 3;
    memset(exact, 0, (2 + PAIR_BINS) * sizeof *exact);
    for (int k = 0; k < POINTS; k++) {
        const double r = (k + 0.5) / POINTS;
        const double weight = 4 * M_PI * r * r / POINTS * exp(-energy_at(r) / temperature);
        all += weight;
        exact[0] += weight * energy_at(r);
        exact[1] += weight * r * repulsion * (1 - r);
        if (r * FIFTHS >= 1)
            exact[1 + (int)(FIFTHS * r)] += weight;
    }
    for (int k = 0; k < 2 + PAIR_BINS; k++)
        exact[k] /= all;
}

static void look_at_pair(const struct simulation *simulation, double *values) {
    const struct particles *particles = &simulation->particles;
    double square = 0;
    for (int d = 0; d < 3; d++)
        square += pow(box_nearest(particles->position[d][0] - particles->position[d][1], edge), 2);
    values[0] = simulation->sums.energy;
    values[1] = simulation->sums.virial;
    const double fifths = FIFTHS * sqrt(square);
    if (fifths >= 1 && fifths < FIFTHS)
        values[1 + (int)fifths] = 1;
}

static void test_two_particles_meet_as_their_potential_lets_them(void **state) {
    struct fluid fluid;
    double exact[MAX];
    struct probe probe = {.look = look_at_pair, .size = 2 + PAIR_BINS, .each = 2000};
    (void)state;
    fluid_groot_warren(&fluid, 2, 0.01);
    fluid.setup.temperature = temperature;
    for (int d = 0; d < 3; d++)
        fluid.setup.box.length[d] = edge;
    find_pair(exact);
    measure(&fluid.setup, 600, 10, &probe, 1);
    compare("two particles", &probe, exact);
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_free_chains_have_the_distributions_of_their_integrals),
        cmocka_unit_test(test_two_particles_meet_as_their_potential_lets_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
