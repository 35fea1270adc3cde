// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/many_bodies.h"

#include "base/memory.h"
#include "curves/expression_law.h"
#include "curves/formula.h"
#include "shared/testing.h"

#include <string.h>

void many_bodies_add(struct many_body *law, const char *name, uint32_t central, uint32_t neighbours,
                     const struct curve *weight, const struct curve *energy) {
    struct many_body_term *term = &law->term[law->terms++];
    strcpy(term->name, name);
    term->central = central;
    term->neighbours = neighbours;
    assert_ok(mf_weight_tabulate(&term->weight, weight));
    assert_ok(mf_density_energy_init(&term->energy, energy));
}

/// Set a number of a law by the name of its field.
static void set(const struct curve *curve, const char *name, double value) {
    for (const struct field *field = curve->family->fields; field->name; field++)
        if (strcmp(field->name, name) == 0) {
            memcpy((char *)curve->parameters + field->offset, &value, sizeof value);
            return;
        }
    fail_msg("%s has no %s", curve->family->name, name);
}

static struct curve make(const struct curve_family *family, const char *formula) {
    struct curve curve;
    assert_ok(mf_curve_create(&curve, family));
    for (const struct field *field = family->fields; field->name && formula; field++)
        if (strcmp(field->name, "formula") == 0)
            strcpy((char *)curve.parameters + field->offset, formula);
    return curve;
}

/// Adds and clears both.
static void add(struct many_body *law, const char *name, uint32_t central, uint32_t neighbours,
                struct curve *weight, struct curve *energy) {
    many_bodies_add(law, name, central, neighbours, weight, energy);
    mf_curve_clear(weight);
    mf_curve_clear(energy);
}

static void act(struct many_bodies *many) {
    struct simulation_setup *setup = &many->fluid.setup;
    many->law.composition = setup->composition;
    setup->interaction[setup->interactions++] =
        (struct interaction_choice){&mf_many_body, &many->law};
}

/// A box of a density, with the fluid's Φ as it was.
static void resize(struct simulation_setup *setup, int dimensions, double density) {
    const double edge = pow((double)setup->placement.count / density, 1.0 / dimensions);
    setup->box = (struct box){dimensions, {edge * 1.1, edge / 1.1, dimensions == 3 ? edge : 1}};
}

void many_bodies_dpd(struct many_bodies *many, int dimensions, int64_t count) {
    *many = (struct many_bodies){0};
    fluid_groot_warren(&many->fluid, count, 0.01);
    mf_table_clear(&many->fluid.potential);
    struct formula_soft_repulsion_parameters soft = {-40, 1};
    assert_ok(mf_table_init_potential(&many->fluid.potential,
                                      &(struct curve){&mf_formula_soft_repulsion, &soft}));
    resize(&many->fluid.setup, dimensions, dimensions == 3 ? 6 : 4);
    struct curve weight = make(&mf_weight_many_body_dpd, NULL);
    struct curve energy = make(&mf_density_energy_many_body_dpd, NULL);
    set(&weight, "cutoff", 0.75);
    set(&energy, "cutoff", 0.75);
    set(&energy, "b", 25);
    mf_weight_set_dimensions(&weight, dimensions);
    mf_density_energy_set_dimensions(&energy, dimensions);
    add(&many->law, "repulsion", 1, 1, &weight, &energy);
    act(many);
}

void many_bodies_mixture(struct many_bodies *many, int dimensions, int64_t count) {
    *many = (struct many_bodies){0};
    fluid_mixture(&many->fluid, count, 0.01);
    resize(&many->fluid.setup, dimensions, dimensions == 3 ? 3 : 2);
    struct curve weight = make(&mf_weight_sanyal_shell, NULL);
    struct curve energy = make(&mf_density_energy_expression, "3*exp(-rho/4) + 0.1*rho^2");
    set(&weight, "inner_cutoff", 0.5);
    set(&weight, "cutoff", 1.2);
    set(&energy, "maximum", 3);
    add(&many->law, "a-among-b", 1, 2, &weight, &energy);
    weight = make(&mf_weight_lucy, NULL);
    energy = make(&mf_density_energy_polynomial, NULL);
    set(&weight, "cutoff", 0.9);
    mf_weight_set_dimensions(&weight, dimensions);
    set(&energy, "c1", -1.5);
    set(&energy, "c2", 0.2);
    set(&energy, "c3", 0.01);
    set(&energy, "c4", -0.001);
    add(&many->law, "all", 7, 7, &weight, &energy);
    weight = make(&mf_expression_potential, "2*(1 - (r/1.1)^2)^3");
    energy = make(&mf_density_energy_polynomial, NULL);
    set(&weight, "cutoff", 1.1);
    set(&energy, "c2", 0.3);
    add(&many->law, "others-among-a", 6, 1, &weight, &energy);
    act(many);
}

void many_bodies_crowd(struct many_body *law, double inner_cutoff, double cutoff, double c,
                       double origin, const struct composition *composition) {
    struct curve weight = make(&mf_weight_sanyal_shell, NULL);
    struct curve energy = make(&mf_density_energy_polynomial, NULL);
    *law = (struct many_body){.composition = *composition};
    set(&weight, "inner_cutoff", inner_cutoff);
    set(&weight, "cutoff", cutoff);
    set(&energy, "c2", c);
    set(&energy, "origin", origin);
    add(law, "crowd", ~0U, ~0U, &weight, &energy);
}

void many_bodies_clear(struct many_bodies *many) {
    fluid_clear(&many->fluid);
    mf_many_body_clear(&many->law);
}
