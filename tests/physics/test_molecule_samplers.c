// SPDX-License-Identifier: GPL-3.0-or-later
//
// Metropolis moves, hybrid Monte Carlo and dynamics with friction sample one ensemble: a melt of
// short chains with bonds, angles, dihedrals and pairs has the same energy, virial, sizes and
// distributions by all of them. And an ideal gas of molecules has the pressure of as many
// particles, P V = N_molecules k_B T, whatever holds the molecules together.
#include "base/comoments.h"
#include "base/memory.h"
#include "base/statistics.h"
#include "forces/bonded.h"
#include "inversion/sampler.h"
#include "shared/all_pairs.h"
#include "shared/fluids.h"
#include "shared/hotelling.h"
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

enum { CHAINS = 60, BEADS = 5, COUNT = CHAINS * BEADS };
enum { SAMPLES = 20, KINDS = 5, MAX = 5 };

static int blocks(void) {
    return length_is_long() ? 40 : 16;
}

/// Bins that tell distributions apart; what they do not cover keeps their sum free.
static const struct {
    const char *name;
    double low, width;
    int bins;
} kinds[KINDS] = {
    {"energy, virial, size", 0, 0, 3},
    {"bonds", 0.5, 0.1, 5},
    {"angles", 80 * M_PI / 180, M_PI / 10, 4},
    {"dihedrals", -2.5, 1, 5},
    {"g", 0.4, 0.25, 5},
};

struct melt {
    struct fluid fluid;
    struct molecules molecules;
    struct composition composition;
};

static void make_melt(struct melt *melt) {
    static const int type[BEADS] = {0};
    static const struct molecules_number spring[] = {{"k", 60}, {"length", 0.7}, {NULL, 0}};
    static const struct molecules_number bend[] = {{"k", 6}, {"angle", 110}, {NULL, 0}};
    static const struct molecules_number twist[] = {
        {"k", 1}, {"multiplicity", 2}, {"phase", 70}, {NULL, 0}};
    melt->molecules = (struct molecules){0};
    melt->composition =
        molecules_topology(&melt->molecules.topology, molecules_chain(CHAINS, type, BEADS, 2, 2),
                           (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&melt->molecules, BONDED_BOND, &mf_bond_harmonic, spring);
    molecules_add_group(&melt->molecules, BONDED_ANGLE, &mf_angle_harmonic, bend);
    molecules_add_group(&melt->molecules, BONDED_DIHEDRAL, &mf_dihedral_periodic, twist);
    fluid_groot_warren(&melt->fluid, COUNT, 0.008);
    melt->fluid.setup.integrator = &mf_aboba;
    molecules_enter(&melt->fluid.setup, &melt->molecules, &melt->composition);
}

static void clear_melt(struct melt *melt) {
    mf_molecules_clear(&melt->molecules);
    fluid_clear(&melt->fluid);
}

// Measuring ---------------------------------------------------------------------------------------

struct found {
    struct comoments of[KINDS]; ///< of block means
};

static void found_init(struct found *found) {
    for (int k = 0; k < KINDS; k++)
        assert_ok(mf_comoments_init(&found->of[k], (size_t)kinds[k].bins));
}

static void found_clear(struct found *found) {
    for (int k = 0; k < KINDS; k++)
        mf_comoments_clear(&found->of[k]);
}

static void count(int kind, double q, double each, double *sum) {
    const double place = (q - kinds[kind].low) / kinds[kind].width;
    if (place >= 0 && place < kinds[kind].bins)
        sum[(int)place] += each;
}

/// R_g² of a chain, along its bonds.
static double gyration(const struct particles *particles, const size_t *place) {
    double sum = 0;
    for (int d = 0; d < 3; d++) {
        double x = 0, mean = 0, squares = 0;
        for (int bead = 0; bead < BEADS; bead++) {
            if (bead > 0)
                x += box_nearest(particles->position[d][place[bead]] -
                                     particles->position[d][place[bead - 1]],
                                 particles->box.length[d]);
            mean += x / BEADS;
            squares += x * x / BEADS;
        }
        sum += squares - mean * mean;
    }
    return sum;
}

/// Add what a configuration has, by all pairs and all terms, to the sums of a block.
static void measure(const struct melt *melt, const struct particles *particles,
                    const struct pair_sums *sums, double (*sum)[MAX]) {
    const struct topology_kind *kind = &melt->molecules.topology.kind[0];
    sum[0][0] += sums->energy / COUNT;
    sum[0][1] += sums->virial / COUNT;
    for (int64_t m = 0; m < CHAINS; m++) {
        size_t place[BEADS];
        for (int bead = 0; bead < BEADS; bead++)
            place[bead] = particles->place[topology_id(kind, m, bead)];
        sum[0][2] += gyration(particles, place) / CHAINS;
        for (int order = 0; order < BONDED_KINDS; order++)
            for (int n = 0; n < kind->terms[order]; n++) {
                int32_t of[BONDED_MAX_TERM_BEADS];
                double q;
                for (int k = 0; k < mf_bonded_kinds[order]->beads; k++)
                    of[k] = (int32_t)place[kind->term[order][n].bead[k]];
                mf_bonded_measure(order, 1, of, particles, &q);
                count(1 + order, q, 1.0 / (CHAINS * kind->terms[order]), sum[1 + order]);
            }
    }
    for (size_t i = 0; i < COUNT; i++)
        for (size_t j = 0; j < i; j++) {
            double square = 0;
            for (int d = 0; d < 3; d++)
                square += pow(box_nearest(particles->position[d][i] - particles->position[d][j],
                                          particles->box.length[d]),
                              2);
            if (!all_pairs_excludes(particles->topology, particles->id[i], particles->id[j]))
                count(4, sqrt(square), 1.0 / COUNT, sum[4]);
        }
}

static void end_block(struct found *found, double (*sum)[MAX]) {
    for (int k = 0; k < KINDS; k++) {
        for (int n = 0; n < kinds[k].bins; n++)
            sum[k][n] /= SAMPLES;
        mf_comoments_add(&found->of[k], sum[k]);
    }
}

/// By the integrator of the melt, or another without friction; `every` steps or sweeps.
static void by_simulation(const struct melt *melt, const struct integrator *integrator,
                          uint64_t equilibration, uint64_t every, struct found *found) {
    struct simulation_setup setup = melt->fluid.setup;
    struct simulation simulation;
    found_init(found);
    if (setup.integrator != integrator)
        setup.omega = NULL;
    setup.integrator = integrator;
    assert_ok(mf_simulation_init(&simulation, &setup, NULL));
    assert_ok(mf_simulation_run(&simulation, equilibration));
    if (integrator->settle)
        integrator->settle(simulation.integrator_state);
    for (int block = 0; block < blocks(); block++) {
        double sum[KINDS][MAX] = {{0}};
        for (int n = 0; n < SAMPLES; n++) {
            simulation.wants = PAIR_FORCES;
            assert_ok(mf_simulation_run(&simulation, every));
            assert_ok(mf_simulation_compute_potential(&simulation));
            measure(melt, &simulation.particles, &simulation.sums, sum);
        }
        end_block(found, sum);
    }
    mf_simulation_clear(&simulation);
}

static void by_sampler(const struct melt *melt, enum sampler_kind kind, uint64_t every,
                       struct found *found) {
    struct sampler sampler;
    found_init(found);
    assert_ok(mf_sampler_init(&sampler, kind,
                              &(struct sampler_system){.box = &melt->fluid.setup.box,
                                                       .composition = &melt->composition,
                                                       .potential = &melt->fluid.potential,
                                                       .temperature = 1,
                                                       .molecules = &melt->molecules,
                                                       .seed = 8}));
    assert_ok(mf_sampler_scatter(&sampler));
    assert_ok(mf_sampler_begin(&sampler));
    assert_ok(mf_sampler_equilibrate(&sampler, 60 * every));
    for (int block = 0; block < blocks(); block++) {
        double sum[KINDS][MAX] = {{0}}, sample[SAMPLER_SUMS];
        for (int n = 0; n < SAMPLES; n++) {
            assert_ok(mf_sampler_sample(&sampler, every, sample));
            measure(melt, mf_sampler_particles(&sampler),
                    &(struct pair_sums){.energy = sample[SAMPLER_ENERGY],
                                        .virial = sample[SAMPLER_VIRIAL]},
                    sum);
        }
        end_block(found, sum);
    }
    print_message("%s: %.2f accepted\n", mf_sampler_kinds[kind], mf_sampler_acceptance(&sampler));
    mf_sampler_clear(&sampler);
}

/// 20 probabilities, each below 1e-4 once in 10,000 seeds: a false alarm in some 500.
static void compare(const char *name, const struct found *a, const struct found *b) {
    for (int k = 0; k < KINDS; k++) {
        const double p = hotelling_two_samples(&a->of[k], &b->of[k]);
        print_message("%s, %s: %.5f and %.5f, %.5f and %.5f; p = %.3g\n", name, kinds[k].name,
                      a->of[k].mean[0], b->of[k].mean[0], a->of[k].mean[1], b->of[k].mean[1], p);
        assert_true(p > 1e-4);
    }
}

static void test_moves_trajectories_and_dynamics_sample_one_melt(void **state) {
    (void)state;
    struct melt melt;
    struct found dynamics, moves, trajectories, sweeps;
    make_melt(&melt);
    by_sampler(&melt, SAMPLER_MONTE_CARLO, 15, &moves);
    by_sampler(&melt, SAMPLER_DYNAMICS, 6, &trajectories);
    by_simulation(&melt, &mf_aboba, 3000, 60, &dynamics);
    by_simulation(&melt, &mf_monte_carlo, 900, 15, &sweeps);
    compare("moves and trajectories", &moves, &trajectories);
    compare("moves and dynamics", &moves, &dynamics);
    compare("trajectories and dynamics", &trajectories, &dynamics);
    compare("sweeps of a simulation and dynamics", &sweeps, &dynamics);
    found_clear(&moves);
    found_clear(&trajectories);
    found_clear(&dynamics);
    found_clear(&sweeps);
    clear_melt(&melt);
}

/// d N k_B T + Σ r·F = d N_molecules k_B T. Blocks of 200 free chains; of two samplers 4.6 errors
/// of 40 blocks: a false alarm in 10,000 seeds; of 16 blocks in 1,500.
static void test_an_ideal_gas_of_molecules_has_its_pressure(void **state) {
    (void)state;
    for (enum sampler_kind kind = SAMPLER_MONTE_CARLO; kind <= SAMPLER_DYNAMICS; kind++) {
        struct melt melt;
        struct sampler sampler;
        struct running_mean share = {0};
        make_melt(&melt);
        assert_ok(mf_sampler_init(&sampler, kind,
                                  &(struct sampler_system){.box = &melt.fluid.setup.box,
                                                           .composition = &melt.composition,
                                                           .temperature = 1.7,
                                                           .molecules = &melt.molecules,
                                                           .seed = 9}));
        assert_ok(mf_sampler_begin(&sampler));
        assert_ok(mf_sampler_equilibrate(&sampler, 1000));
        for (int block = 0; block < blocks(); block++) {
            double sum = 0, sample[SAMPLER_SUMS];
            for (int n = 0; n < SAMPLES; n++) {
                assert_ok(mf_sampler_sample(&sampler, 6, sample));
                sum += 1 + sample[SAMPLER_VIRIAL] / (3 * COUNT * 1.7);
            }
            mf_statistics_add(&share, sum / SAMPLES);
        }
        const double error = mf_statistics_standard_error(&share);
        print_message("%s: P V/(N k_B T) = %.5f(%.5f)\n", mf_sampler_kinds[kind], share.mean,
                      error);
        assert_close(share.mean, 1.0 / BEADS, 4.6 * error);
        assert_true(error < 0.01 * sqrt(40.0 / blocks())); // enough to tell
        mf_sampler_clear(&sampler);
        clear_melt(&melt);
    }
}

/// What a checkpoint keeps of a sampler, put into another one: moves go on as they were tuned.
static void test_moves_go_on_with_the_same_bits_when_restarted(void **state) {
    (void)state;
    enum { MAX_SPANS = 16 };
    struct melt melt;
    struct sampler sampler[2];
    struct memory_span from[MAX_SPANS], to[MAX_SPANS];
    double sample[2][SAMPLER_SUMS];
    make_melt(&melt);
    for (int n = 0; n < 2; n++)
        assert_ok(mf_sampler_init(&sampler[n], SAMPLER_MONTE_CARLO,
                                  &(struct sampler_system){.box = &melt.fluid.setup.box,
                                                           .composition = &melt.composition,
                                                           .potential = &melt.fluid.potential,
                                                           .temperature = 1,
                                                           .molecules = &melt.molecules,
                                                           .seed = 8}));
    assert_ok(mf_sampler_begin(&sampler[0]));
    assert_ok(mf_sampler_equilibrate(&sampler[0], 200));
    assert_ok(mf_sampler_sample(&sampler[0], 20, sample[0]));
    const size_t spans = mf_sampler_spans(&sampler[0], from);
    assert_int_equal(mf_sampler_spans(&sampler[1], to), spans);
    for (size_t n = 0; n < spans; n++)
        memcpy(to[n].memory, from[n].memory, from[n].bytes);
    for (int n = 0; n < 2; n++) {
        assert_ok(mf_sampler_begin(&sampler[n]));
        assert_ok(mf_sampler_equilibrate(&sampler[n], 0));
        assert_ok(mf_sampler_sample(&sampler[n], 20, sample[n]));
    }
    assert_memory_equal(sample[0], sample[1], sizeof sample[0]);
    mf_sampler_spans(&sampler[0], from);
    mf_sampler_spans(&sampler[1], to);
    for (size_t n = 0; n < spans; n++)
        assert_memory_equal(from[n].memory, to[n].memory, from[n].bytes);
    for (int n = 0; n < 2; n++)
        mf_sampler_clear(&sampler[n]);
    clear_melt(&melt);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_moves_trajectories_and_dynamics_sample_one_melt),
        cmocka_unit_test(test_moves_go_on_with_the_same_bits_when_restarted),
        cmocka_unit_test(test_an_ideal_gas_of_molecules_has_its_pressure),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
