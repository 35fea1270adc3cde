// SPDX-License-Identifier: GPL-3.0-or-later
//
// Inner steps: that of a bond alone against its exact period, and what they are refused for.
#include "dynamics/respa.h"

#include "dynamics/dpd_verlet.h"
#include "dynamics/simulation.h"
#include "shared/fluids.h"
#include "shared/is_close.h"
#include "shared/molecules.h"
#include "shared/testing.h"

#include <math.h>

static const int type[2] = {0};
static const struct molecules_number spring[] = {{"k", 800}, {"length", 0.8}, {NULL, 0}};

/// A dimer at rest, stretched by 0.1 along an axis.
static void make_dimer(struct fluid *fluid, struct molecules *molecules,
                       struct simulation *simulation, const struct integrator *integrator,
                       const void *parameters) {
    double x[] = {4, 4.9}, other[] = {5, 5}, rest[] = {0, 0};
    const struct simulation_start start = {.position = {x, other, other},
                                           .velocity = {rest, rest, rest}};
    *molecules = (struct molecules){0};
    const struct composition composition =
        molecules_topology(&molecules->topology, molecules_chain(1, type, 2, BONDED_BOND, 1),
                           (struct topology_kind){0}, 1, NULL);
    molecules_add_group(molecules, BONDED_BOND, &mf_bond_harmonic, spring);
    fluid_groot_warren(fluid, 2, 0.03);
    fluid->setup.omega = NULL;
    fluid->setup.integrator = integrator;
    fluid->setup.integrator_parameters = parameters;
    for (int d = 0; d < 3; d++)
        fluid->setup.box.length[d] = 10;
    molecules_enter(&fluid->setup, molecules, &composition);
    fluid->setup.placement.kind = PLACEMENT_FILE;
    assert_ok(mf_simulation_init(simulation, &fluid->setup, &start));
}

/// x = A cos(Ω t), Ω² = 2 k/m: 40, so that a step is a fifth of a period. With inner steps δt the
/// phase is Ω t (1 + (Ω δt)²/24), of position Verlet as of velocity Verlet.
static void test_a_bond_swings_with_the_period_of_its_inner_steps(void **state) {
    (void)state;
    enum { STEPS = 40, INNER = 30 };
    static const struct respa_parameters inner = {INNER};
    static const struct integrator *const integrators[] = {&mf_velocity_verlet, &mf_aboba};
    for (size_t n = 0; n < 2; n++) {
        struct fluid fluid;
        struct molecules molecules;
        struct simulation simulation;
        make_dimer(&fluid, &molecules, &simulation, integrators[n], &inner);
        const double turn = 40 * 0.03 / INNER;
        const double phase = 40 * 0.03 * STEPS * (1 + turn * turn / 24);
        assert_ok(mf_simulation_run(&simulation, STEPS));
        const double length =
            fabs(simulation.particles.position[0][0] - simulation.particles.position[0][1]);
        assert_close(length, 0.8 + 0.1 * cos(phase), 1e-5);
        mf_simulation_clear(&simulation);
        mf_molecules_clear(&molecules);
        fluid_clear(&fluid);
    }
}

static void test_inner_steps_are_refused_where_they_have_no_meaning(void **state) {
    (void)state;
    static const struct respa_parameters inner = {4};
    static const struct dpd_verlet_parameters ahead = {0.65, 4};
    struct fluid fluid;
    struct simulation simulation;
    fluid_groot_warren(&fluid, 300, 0.01);
    fluid.setup.integrator = &mf_aboba;
    fluid.setup.integrator_parameters = &inner;
    assert_true(mf_respa_acts(&fluid.setup));
    assert_fails(mf_simulation_init(&simulation, &fluid.setup, NULL), STATUS_BAD_INPUT,
                 "dynamics.inner_steps: only bonds, angles, dihedrals and interactions use them");
    fluid.setup.integrator = &mf_dpd_verlet;
    fluid.setup.integrator_parameters = &ahead;
    assert_true(mf_respa_acts(&fluid.setup));
    assert_fails(mf_simulation_init(&simulation, &fluid.setup, NULL), STATUS_BAD_INPUT,
                 "dynamics.lambda: with \"inner_steps\" it is 0.5");
    fluid.setup.integrator = &mf_shardlow;
    assert_false(mf_respa_acts(&fluid.setup));
    fluid_clear(&fluid);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_bond_swings_with_the_period_of_its_inner_steps),
        cmocka_unit_test(test_inner_steps_are_refused_where_they_have_no_meaning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
