// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/remembering.h"

#include "curves/formula.h"
#include "shared/testing.h"

#include <math.h>

static void make_table(struct table *table, struct formula_power_omega_parameters parameters) {
    const struct curve curve = {&mf_formula_power_omega, &parameters};
    mf_table_clear(table);
    assert_ok(mf_table_init_omega(table, &curve));
}

void remembering_add(struct remembering *remembering, struct simulation_setup *setup, int parts) {
    struct pair_memory_law *law = &setup->memory;
    make_table(&remembering->slow, (struct formula_power_omega_parameters){8, 1, 0, 0.9});
    make_table(&remembering->rattle, (struct formula_power_omega_parameters){2, 1e-9, 0, 1});
    make_table(&remembering->across, (struct formula_power_omega_parameters){1.5, 1, 0, 1});
    if (parts & REMEMBERING_SLOW)
        law->mode[law->modes++] = (struct pair_memory_mode){&remembering->slow, 0.5, 0};
    if (parts & REMEMBERING_RATTLE)
        law->mode[law->modes++] = (struct pair_memory_mode){&remembering->rattle, 0.1, 20};
    if (parts & REMEMBERING_ACROSS)
        law->transverse = &remembering->across;
    setup->integrator = &mf_aboba;
}

void remembering_make(struct remembering *remembering, int64_t count, double time_step, int parts) {
    *remembering = (struct remembering){0};
    fluid_groot_warren(&remembering->fluid, count, time_step);
    remembering_add(remembering, &remembering->fluid.setup, parts);
}

void remembering_clear(struct remembering *remembering) {
    fluid_clear(&remembering->fluid);
    mf_table_clear(&remembering->slow);
    mf_table_clear(&remembering->rattle);
    mf_table_clear(&remembering->across);
}

double remembering_energy(const struct pair_memory *memory, size_t *variables) {
    const struct pair_memory_pairs *pairs = &memory->pairs;
    double energy = 0;
    *variables = 0;
    for (int k = 0; k < memory->variables; k++)
        for (size_t n = 0; n < pairs->count; n++)
            if (!isnan(pairs->value[0][n])) {
                energy += 0.5 * (double)pairs->value[k][n] * pairs->value[k][n];
                ++*variables;
            }
    return memory->unit * memory->unit * energy;
}
