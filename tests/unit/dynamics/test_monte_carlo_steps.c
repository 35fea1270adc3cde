// SPDX-License-Identifier: GPL-3.0-or-later
//
// Monte Carlo as an integrator: how its moves are tuned, and a restart in the middle.
#include "dynamics/monte_carlo.h"
#include "observe/measure.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/restart.h"
#include "shared/testing.h"

enum { DIMERS = 40, COUNT = 2 * DIMERS };

/// Stiff dimers among soft beads: bonds keep the moves of beads far below what the list allows.
struct dimers {
    struct fluid fluid;
    struct molecules molecules;
};

static void make_dimers(struct dimers *dimers) {
    static const int type[] = {0, 0};
    static const struct molecules_number bond[] = {{"k", 10000}, {"length", 0.8}, {NULL, 0}};
    dimers->molecules = (struct molecules){0};
    const struct composition composition =
        molecules_topology(&dimers->molecules.topology, molecules_chain(DIMERS, type, 2, 0, 1),
                           (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&dimers->molecules, BONDED_BOND, &mf_bond_harmonic, bond);
    fluid_groot_warren(&dimers->fluid, COUNT, 0.01);
    molecules_enter(&dimers->fluid.setup, &dimers->molecules, &composition);
    dimers->fluid.setup.integrator = &mf_monte_carlo;
    dimers->fluid.setup.omega = NULL;
}

static void clear_dimers(struct dimers *dimers) {
    mf_molecules_clear(&dimers->molecules);
    fluid_clear(&dimers->fluid);
}

static const struct metropolis *chain_of(const struct simulation *simulation) {
    return &((const struct monte_carlo *)simulation->integrator_state)->chain;
}

/// Energies of all samples, summed in their order, and the sizes of moves that they were made with.
struct seen {
    double energy, step[1 + MOLECULE_MOVES];
    bool changed;
};

static enum status take(void *state, const struct configuration *configuration) {
    const struct simulation *const simulation = configuration->simulation;
    struct seen *seen = state;
    const struct metropolis *chain = chain_of(simulation);
    const bool first = seen->energy == 0;
    seen->energy += simulation->sums.energy;
    for (int k = 0; k <= MOLECULE_MOVES; k++) {
        const double step = k == 0 ? chain->step : chain->molecules.tally[k - 1].step;
        seen->changed = seen->changed || (!first && step != seen->step[k]);
        seen->step[k] = step;
    }
    return STATUS_OK;
}

static const struct observable watching = {.name = "watching", .sums = true, .sample = take};

/// What `mesofit simulate` does with a simulation, new or loaded, until so many samples are taken.
static void carry_on(struct simulation *simulation, int64_t samples, struct seen *seen) {
    const struct measure_plan plan = {.equilibration = 150, .samples = samples, .every = 3};
    const struct observable_use uses[] = {{&watching, seen, NULL}, {NULL, NULL, NULL}};
    double temperature;
    assert_ok(mf_measure_equilibrate(simulation, &plan, &temperature, NULL));
    assert_ok(mf_measure_sample(simulation, &plan, uses, NULL));
}

static void test_moves_are_tuned_before_the_first_sample_and_never_after(void **state) {
    struct dimers dimers;
    struct simulation simulation;
    struct seen seen = {0};
    (void)state;
    make_dimers(&dimers);
    assert_ok(mf_simulation_init(&simulation, &dimers.fluid.setup, NULL));
    const double first = chain_of(&simulation)->step;
    carry_on(&simulation, 40, &seen);
    assert_true(seen.step[0] < 0.8 * first);
    assert_true(seen.step[0] < 0.8 * metropolis_longest_step(chain_of(&simulation)));
    assert_false(seen.changed);
    mf_simulation_clear(&simulation);
    clear_dimers(&dimers);
}

/// Where a bead is in the box, and how many boxes it has crossed, with the sorts of both.
static void assert_follows(const struct simulation *simulation) {
    const struct particles *p = &simulation->particles, *q = &chain_of(simulation)->particles;
    for (size_t k = 0; k < COUNT; k++)
        for (size_t l = 0; l < COUNT; l++)
            for (int d = 0; d < 3 && p->id[k] == q->id[l]; d++)
                assert_close(p->position[d][k] + p->image[d][k] * p->box.length[d],
                             q->position[d][l] + q->image[d][l] * q->box.length[d], 1e-9);
}

/// Between all samples, a sweep after one and a sweep before the next, and in the equilibration.
static void test_a_restarted_simulation_goes_on_with_the_same_bits(void **state) {
    struct dimers dimers;
    struct simulation whole, pieces;
    struct seen expected = {0}, found = {0};
    (void)state;
    make_dimers(&dimers);
    assert_ok(mf_simulation_init(&whole, &dimers.fluid.setup, NULL));
    carry_on(&whole, 12, &expected);
    assert_ok(mf_simulation_init(&pieces, &dimers.fluid.setup, NULL));
    assert_ok(mf_simulation_run(&pieces, 77));
    restart_simulation(&pieces);
    for (int64_t samples = 1; samples < 12; samples++) {
        carry_on(&pieces, samples, &found);
        assert_ok(mf_simulation_run(&pieces, 1));
        restart_simulation(&pieces);
        assert_ok(mf_simulation_run(&pieces, 1));
    }
    carry_on(&pieces, 12, &found);
    assert_true(found.energy == expected.energy);
    restart_assert_same(&whole, &pieces);
    const struct metropolis *a = chain_of(&whole), *b = chain_of(&pieces);
    assert_memory_equal(a->particles.id, b->particles.id, COUNT * sizeof *a->particles.id);
    assert_memory_equal(a->neighbours.list, b->neighbours.list,
                        mf_neighbours_entries(&a->neighbours) * sizeof *a->neighbours.list);
    assert_follows(&pieces);
    assert_int_equal(a->accepted, b->accepted);
    assert_int_equal(a->tried, b->tried);
    mf_simulation_clear(&whole);
    mf_simulation_clear(&pieces);
    clear_dimers(&dimers);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_moves_are_tuned_before_the_first_sample_and_never_after),
        cmocka_unit_test(test_a_restarted_simulation_goes_on_with_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
