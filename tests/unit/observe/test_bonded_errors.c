// SPDX-License-Identifier: GPL-3.0-or-later
//
// Errors of distributions of molecules are honest: dihedrals that jump between two angles at known
// rates, each molecule for itself or all together, without any dynamics.
#include "base/rng.h"
#include "observe/bonded_distribution.h"
#include "observe/measure.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/testing.h"
#include "shared/told.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOLECULES = 40, SAMPLES = 100, RUNS = 60 };

static const int type[4] = {0};

struct chains {
    struct fluid fluid;
    struct molecules molecules;
    struct simulation simulation;
};

static void chains_make(struct chains *chains) {
    static const struct molecules_number spring[] = {{"k", 60}, {"length", 0.7}, {NULL, 0}};
    static const struct molecules_number twist[] = {
        {"k", 1}, {"multiplicity", 2}, {"phase", 0}, {NULL, 0}};
    chains->molecules = (struct molecules){0};
    struct topology_kind kind = molecules_chain(MOLECULES, type, 4, BONDED_DIHEDRAL, 0);
    kind.terms[BONDED_ANGLE] = 0;
    const struct composition composition =
        molecules_topology(&chains->molecules.topology, kind, (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&chains->molecules, BONDED_BOND, &mf_bond_harmonic, spring);
    molecules_add_group(&chains->molecules, BONDED_DIHEDRAL, &mf_dihedral_periodic, twist);
    fluid_ideal_gas(&chains->fluid, 3, 4 * MOLECULES, 0.01);
    chains->fluid.setup.placement.kind = PLACEMENT_LATTICE;
    molecules_enter(&chains->fluid.setup, &chains->molecules, &composition);
    assert_ok(mf_simulation_init(&chains->simulation, &chains->fluid.setup, NULL));
}

static void chains_clear(struct chains *chains) {
    mf_simulation_clear(&chains->simulation);
    mf_molecules_clear(&chains->molecules);
    fluid_clear(&chains->fluid);
}

/// Turn the dihedral of a molecule to 90 or −90 degrees, with an R_e² of 0.75 or 0.59.
static void turn(struct chains *chains, int64_t molecule, bool up) {
    const double place[4][3] = {{0, 0.5, 0}, {0, 0, 0}, {0.5, 0, 0}, {0.5, 0, up ? 0.5 : -0.3}};
    struct particles *particles = &chains->simulation.particles;
    for (int bead = 0; bead < 4; bead++) {
        const uint32_t id = topology_id(&chains->molecules.topology.kind[0], molecule, bead);
        for (int d = 0; d < 3; d++)
            particles->position[d][particles->place[id]] = 1 + place[bead][d];
    }
}

static double chance(uint64_t run, int sample, int64_t molecule) {
    const struct rng_block block =
        mf_rng_philox(run, RNG_INITIAL, (uint32_t)sample, (uint32_t)molecule, 0);
    return (block.word[0] + 0.5) * 0x1p-32;
}

extern const struct observable mf_molecule_sizes;

/// Sample molecules that jump with a probability from sample to sample.
static void sample_jumps(struct chains *chains, const struct observable *observable, void *state,
                         uint64_t run, double jump, bool together) {
    bool up[MOLECULES] = {false};
    for (int sample = 0; sample < SAMPLES; sample++) {
        for (int64_t m = 0; m < MOLECULES; m++) {
            const double number = chance(run, sample, together ? 0 : m);
            up[m] = sample == 0 ? number < 0.5 : up[m] ^ (number < jump);
            turn(chains, m, up[m]);
        }
        assert_ok(told_sample(observable, state, &chains->simulation));
    }
}

/// (p − ½)/error of one side of the dihedral.
static double deviation_of_side(const void *state) {
    double value[2], error[2];
    const struct observable_values values = {.count = 2, .value = value, .error = error};
    assert_ok(
        mf_bonded_distribution_dihedral.result_of_all((const void *const[]){state}, 1, &values));
    assert_close(value[0] + value[1], 1.0 / 180, 1e-12);
    return (value[0] - 0.5 / 180) / error[0];
}

/// (⟨R_e²⟩ − 0.67)/error, of a line as "chain: R_e^2 0.671(12), …".
static double deviation_of_size(const void *state) {
    static const struct units units;
    const struct observable_results results = {.units = &units};
    char line[256];
    double value, digits;
    int point, bracket;
    mf_molecule_sizes.print(state, &results, line, sizeof line);
    const char *number = strstr(line, "R_e^2 ") + 6;
    assert_int_equal(sscanf(number, "%lf(%lf)", &value, &digits), 2);
    point = (int)strcspn(number, ".");
    bracket = (int)strcspn(number, "(");
    return (value - 0.67) / (digits * pow(10, point + 1 - bracket));
}

static const struct {
    const struct observable *observable;
    const void *settings;
    double (*deviation)(const void *state);
} measured[] = {
    {&mf_bonded_distribution_dihedral, &(const struct bonded_settings){.bins = 2},
     deviation_of_side},
    {&mf_molecule_sizes, &(const int64_t){10}, deviation_of_size},
};

static void check(struct chains *chains, double jump, bool together) {
    static const struct measure_plan plan = {.samples = SAMPLES, .every = 1};
    for (int k = 0; k < 2; k++) {
        const struct observable *observable = measured[k].observable;
        double squares = 0;
        for (uint64_t run = 1; run <= RUNS; run++) {
            void *state = calloc(1, observable->state_size);
            assert_ok(
                told_begin(observable, state, measured[k].settings, &chains->simulation, &plan));
            sample_jumps(chains, observable, state, run, jump, together);
            squares += pow(measured[k].deviation(state), 2) / RUNS;
            observable->clear(state);
            free(state);
        }
        print_message("%s, %s, jumps with %.3f: rms deviation %.2f errors\n", observable->name,
                      together ? "all together" : "each for itself", jump, sqrt(squares));
        assert_in_range((int)(100 * sqrt(squares)), 70, 140);
    }
}

static void test_bonded_errors_are_honest_however_slow_the_molecules_are(void **state) {
    (void)state;
    struct chains chains;
    chains_make(&chains);
    check(&chains, 0.5, false);
    check(&chains, 0.05, false);
    check(&chains, 0.002, false);
    check(&chains, 0.25, true);
    chains_clear(&chains);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bonded_errors_are_honest_however_slow_the_molecules_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
