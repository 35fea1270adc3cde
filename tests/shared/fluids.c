// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/fluids.h"

#include "curves/formula.h"
#include "shared/testing.h"

static void make_omega(struct fluid *fluid, double sigma, double cutoff) {
    struct formula_power_omega_parameters parameters = {sigma, 1, 0, cutoff};
    const struct curve curve = {&mf_formula_power_omega, &parameters};
    assert_ok(mf_table_init_omega(&fluid->omega, &curve));
    fluid->setup.omega = &fluid->omega;
}

static void make_soft_table(struct table *table, double a) {
    struct formula_soft_repulsion_parameters parameters = {a, 1};
    const struct curve curve = {&mf_formula_soft_repulsion, &parameters};
    assert_ok(mf_table_init_potential(table, &curve));
}

static void make_soft_potential(struct fluid *fluid) {
    make_soft_table(&fluid->potential, 25);
    fluid->setup.potential = &fluid->potential;
}

/// What all fluids share. The limit of the temperature is far from any fluctuation.
static void begin(struct fluid *fluid, int dimensions, int64_t count, double density,
                  double time_step) {
    const double edge = pow((double)count / density, 1.0 / dimensions);
    *fluid = (struct fluid){
        .setup = {.box = {dimensions, {edge, edge, dimensions == 3 ? edge : 1}},
                  .composition = mf_composition_of_one(count),
                  .placement = {.count = count, .kind = PLACEMENT_LATTICE, .jitter = 0.05},
                  .temperature = 1,
                  .time_step = time_step,
                  .skin = 0.3,
                  .temperature_limit = 10,
                  .integrator = &mf_dpd_verlet,
                  .seed = 1},
    };
}

void fluid_lennard_jones(struct fluid *fluid, int64_t count, double time_step) {
    begin(fluid, 3, count, 0.8442, time_step);
    fluid->setup.temperature = 0.7;
    struct formula_lennard_jones_parameters parameters = {1, 1, 2.5};
    const struct curve curve = {&mf_formula_lennard_jones, &parameters};
    assert_ok(mf_table_init_potential(&fluid->potential, &curve));
    fluid->setup.potential = &fluid->potential;
    make_omega(fluid, 1.5, 2.5);
}

void fluid_groot_warren(struct fluid *fluid, int64_t count, double time_step) {
    begin(fluid, 3, count, 3, time_step);
    make_soft_potential(fluid);
    make_omega(fluid, sqrt(4.5), 1);
}

void fluid_mixture(struct fluid *fluid, int64_t count, double time_step) {
    enum { PAIRS = 6 };
    struct table potential[PAIRS], omega[PAIRS];
    begin(fluid, 3, count, 3, time_step);
    fluid->setup.composition = (struct composition){
        .types = 3, .count = {count / 4, count / 3, 0}, .name = {"A", "B", "C"}};
    fluid->setup.composition.count[2] = count - count / 4 - count / 3;
    for (int pair = 0; pair < PAIRS; pair++) {
        struct formula_soft_repulsion_parameters soft = {25 + 3 * pair, 1 - 0.04 * pair};
        struct formula_power_omega_parameters power = {1.5 + 0.3 * pair, 1, 0, 0.8 + 0.04 * pair};
        const struct curve phi = {&mf_formula_soft_repulsion, &soft},
                           friction = {&mf_formula_power_omega, &power};
        assert_ok(mf_table_init_potential(&potential[pair], &phi));
        assert_ok(mf_table_init_omega(&omega[pair], &friction));
    }
    assert_ok(mf_table_stack(&fluid->potential, potential, PAIRS));
    assert_ok(mf_table_stack(&fluid->omega, omega, PAIRS));
    fluid->setup.potential = &fluid->potential;
    fluid->setup.omega = &fluid->omega;
    for (int pair = 0; pair < PAIRS; pair++) {
        mf_table_clear(&potential[pair]);
        mf_table_clear(&omega[pair]);
    }
}

void fluid_soft_discs(struct fluid *fluid, int64_t count, double time_step) {
    begin(fluid, 2, count, 2, time_step);
    make_soft_potential(fluid);
    make_omega(fluid, sqrt(4.5), 1);
}

void fluid_ideal_gas(struct fluid *fluid, int dimensions, int64_t count, double time_step) {
    begin(fluid, dimensions, count, (double)count / pow(5, dimensions), time_step);
    for (int d = 0; d < dimensions; d++)
        fluid->setup.box.length[d] = 5; // a root is exact only by luck
    fluid->setup.placement.kind = PLACEMENT_RANDOM;
    fluid->setup.placement.separation = 0;
    make_omega(fluid, sqrt(4.5), 1);
}

void fluid_no_potential(struct table *table) {
    make_soft_table(table, 0);
}

void fluid_clear(struct fluid *fluid) {
    mf_table_clear(&fluid->potential);
    mf_table_clear(&fluid->omega);
}

void fluid_continue(struct simulation *simulation, const struct simulation_setup *setup,
                    const struct simulation *from) {
    struct simulation_setup here = *setup;
    struct simulation_start start = {0};
    here.placement.kind = PLACEMENT_FILE;
    for (int d = 0; d < setup->box.dimensions; d++) {
        start.position[d] = from->particles.position[d];
        start.velocity[d] = from->particles.velocity[d];
    }
    assert_ok(mf_simulation_init(simulation, &here, &start));
}
