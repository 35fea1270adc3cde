// SPDX-License-Identifier: GPL-3.0-or-later
//
// Where molecules of a melt begin, against what a long run makes of them.
#include "curves/curve.h"
#include "curves/formula.h"
#include "shared/fluids.h"
#include "shared/molecules.h"
#include "shared/testing.h"
#include "system/whole_molecules.h"

#include <math.h>

enum { CHAINS = 80, LENGTH = 10 };
static const int type[LENGTH];

struct melt {
    struct fluid fluid;
    struct molecules molecules;
    struct simulation simulation;
};

static void give_law(struct melt *melt) {
    struct curve curve;
    fluid_groot_warren(&melt->fluid, CHAINS * LENGTH, 0.005);
    mf_table_clear(&melt->fluid.potential);
    assert_ok(mf_curve_create(&curve, &mf_formula_lennard_jones));
    ((struct formula_lennard_jones_parameters *)curve.parameters)->cutoff = pow(2, 1.0 / 6);
    assert_ok(mf_table_init_potential(&melt->fluid.potential, &curve));
    mf_curve_clear(&curve);
    for (int d = 0; d < 3; d++)
        melt->fluid.setup.box.length[d] = cbrt(CHAINS * LENGTH / 0.85);
}

/// Kremer and Grest's chains with 1.5 (1 + cos θ), whose angles rest at 180 degrees.
static void begin_melt(struct melt *melt) {
    static const struct molecules_number fene[] = {{"k", 30}, {"longest", 1.5}, {NULL, 0}};
    static const struct molecules_number bend[] = {{"k", 1.5}, {NULL, 0}};
    melt->molecules = (struct molecules){0};
    const struct composition composition = molecules_topology(
        &melt->molecules.topology, molecules_chain(CHAINS, type, LENGTH, BONDED_ANGLE, 0),
        (struct topology_kind){0}, 1, NULL);
    molecules_add_group(&melt->molecules, BONDED_BOND, &mf_bond_fene, fene);
    molecules_add_group(&melt->molecules, BONDED_ANGLE, &mf_angle_cosine, bend);
    give_law(melt);
    molecules_enter(&melt->fluid.setup, &melt->molecules, &composition);
    assert_ok(mf_simulation_init(&melt->simulation, &melt->fluid.setup, NULL));
}

static double ends_squared(const struct melt *melt) {
    struct whole_molecules whole;
    double sum = 0;
    assert_ok(mf_whole_molecules_init(&whole, &melt->molecules.topology));
    for (int64_t m = 0; m < CHAINS; m++) {
        mf_whole_molecules_make(&whole, &melt->simulation.particles, 0, m);
        const double(*place)[3] = (const double(*)[3])whole.place;
        for (int d = 0; d < 3; d++)
            sum += pow(place[LENGTH - 1][d] - place[0][d], 2) / CHAINS;
    }
    mf_whole_molecules_clear(&whole);
    return sum;
}

/// R_e² is 20.4(4) in a run of 16000 steps; of 80 chains it scatters by a tenth. Straight ones have
/// 76.
static void test_chains_begin_as_long_as_they_are_in_the_melt(void **state) {
    (void)state;
    struct melt melt;
    begin_melt(&melt);
    print_message("R_e^2 %.1f\n", ends_squared(&melt));
    assert_true(fabs(ends_squared(&melt) / 20.4 - 1) < 0.3);
    mf_simulation_clear(&melt.simulation);
    mf_molecules_clear(&melt.molecules);
    fluid_clear(&melt.fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_chains_begin_as_long_as_they_are_in_the_melt)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
