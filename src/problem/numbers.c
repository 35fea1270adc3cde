// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/numbers.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

#define MEMBER(name) .offset = offsetof(struct inverse_number, name)
const struct field mf_numbers_fields[NUMBERS_FIELDS] = {
    {"minimum", FIELD_NUMBER, MEMBER(minimum), .required = true, .minimum = -DBL_MAX,
     .maximum = DBL_MAX, .unit = "", .help = "least value, in the unit of the number"},
    {"maximum", FIELD_NUMBER, MEMBER(maximum), .required = true, .minimum = -DBL_MAX,
     .maximum = DBL_MAX, .unit = "", .help = "largest value"},
    {"start", FIELD_NUMBER, MEMBER(start), .initial = NAN, .minimum = -DBL_MAX, .maximum = DBL_MAX,
     .unit = "",
     .help = "initial value; default: the scene's, or the middle if that is out of range"},
    FIELD_END,
};

void mf_numbers_fields_of(const char *unit, struct field fields[NUMBERS_FIELDS]) {
    memcpy(fields, mf_numbers_fields, sizeof mf_numbers_fields);
    for (int k = 0; fields[k].name; k++)
        fields[k].unit = unit;
}

/// A curve of a place with these values.
/// @param[out] curve  to be freed with its parameters
static enum status put(const struct inverse_problem *problem, enum inverse_place place, int part,
                       const struct curve *from, const double *value, struct curve *curve) {
    *curve = (struct curve){from->family, NULL};
    curve->parameters = mf_memory_zeroed(1, from->family->size);
    if (curve->parameters == NULL)
        return STATUS_NO_MEMORY;
    memcpy(curve->parameters, from->parameters, from->family->size);
    for (size_t n = 0; n < problem->numbers; n++) {
        const struct inverse_number *number = &problem->number[n];
        if (number->place == place && number->part == part)
            memcpy((char *)curve->parameters + number->offset, &value[n], sizeof value[n]);
    }
    return STATUS_OK;
}

/// The curves of a law with these values, one table for all of them.
static enum status tabulate(const struct inverse_problem *problem, enum inverse_place kind,
                            const double *value, struct table *table) {
    enum status status = STATUS_OK;
    const struct inverse_law *law = &problem->law[kind];
    struct table part[COMPOSITION_MAX_PAIRS] = {{0}};
    struct curve curve = {0};
    for (int pair = 0; pair < law->curves; pair++) {
        if (law->curve[pair].family == NULL)
            continue;
        mf_memory_free(curve.parameters);
        CHECK(put(problem, kind, pair, &law->curve[pair], value, &curve));
        CHECK(kind == INVERSE_OF_POTENTIAL ? mf_table_init_potential(&part[pair], &curve)
                                           : mf_table_init_omega(&part[pair], &curve));
    }
    if (law->curves > 1) {
        CHECK(mf_table_stack(table, part, law->curves));
    } else {
        *table = part[0];
        part[0] = (struct table){0};
    }
done:
    mf_memory_free(curve.parameters);
    for (int pair = 0; pair < law->curves; pair++)
        mf_table_clear(&part[pair]);
    return status;
}

static bool concerns(const struct inverse_problem *problem, enum inverse_place kind) {
    for (size_t n = 0; n < problem->numbers; n++)
        if (problem->number[n].place == kind)
            return true;
    return false;
}

/// A copy of some parameters, for numbers to be written into.
static enum status copy(const void **parameters, size_t size, void **own) {
    if (*own)
        return STATUS_OK;
    *own = mf_memory_zeroed(1, size);
    if (*own == NULL)
        return STATUS_NO_MEMORY;
    if (*parameters)
        memcpy(*own, *parameters, size);
    *parameters = *own;
    return STATUS_OK;
}

/// Write a number that is no parameter of a law to where the scene has it.
static enum status append(const struct inverse_number *number, double value,
                          struct simulation_setup *scene, struct numbers_own *own) {
    char *to = NULL;
    if (number->place == INVERSE_OF_SETUP) {
        to = (char *)scene;
    } else if (number->place == INVERSE_OF_DYNAMICS) {
        TRY(copy(&scene->integrator_parameters, scene->integrator->parameters_size,
                 &own->dynamics));
        to = own->dynamics;
    } else if (number->place == INVERSE_OF_INTERACTION) {
        struct interaction_choice *choice = &scene->interaction[number->part];
        TRY(copy(&choice->parameters, choice->kind->parameters_size,
                 &own->interaction[number->part]));
        to = own->interaction[number->part];
    }
    if (to)
        memcpy(to + number->offset, &value, sizeof value);
    return STATUS_OK;
}

/// The scene's molecules, with the numbers of their laws.
static enum status change_molecules(const struct inverse_problem *problem, const double *value,
                                    struct simulation_setup *scene, struct numbers_own *own) {
    own->molecules = *mf_molecules_find(scene->interaction, scene->interactions);
    for (size_t n = 0; n < problem->numbers; n++) {
        const struct inverse_number *number = &problem->number[n];
        if (number->place != INVERSE_OF_BONDED)
            continue;
        struct bonded_curve *curve =
            &own->molecules.group[inverse_order(number->part)][number->part % MOLECULES_MAX_GROUPS]
                 .curve;
        const void *parameters = curve->parameters;
        TRY(copy(&parameters, curve->law->size, &own->bonded[number->part]));
        curve->parameters = own->bonded[number->part];
        memcpy((char *)curve->parameters + number->offset, &value[n], sizeof value[n]);
    }
    for (int k = 0; k < scene->interactions; k++)
        if (scene->interaction[k].kind == &mf_molecules)
            scene->interaction[k].parameters = &own->molecules;
    return STATUS_OK;
}

/// The tables of a local density with these values.
static enum status tabulate_density(const struct inverse_problem *problem, int t,
                                    const double *value, struct many_body_term *term) {
    enum status status = STATUS_OK;
    struct curve weight = {0}, energy = {0};
    CHECK(put(problem, INVERSE_OF_WEIGHT, t, &problem->weight.curve[t], value, &weight));
    CHECK(mf_weight_tabulate(&term->weight, &weight));
    CHECK(put(problem, INVERSE_OF_DENSITY_ENERGY, t, &problem->density_energy.curve[t], value,
              &energy));
    CHECK(mf_density_energy_check_weight(&energy, &weight));
    CHECK(mf_density_energy_init(&term->energy, &energy));
done:
    mf_memory_free(weight.parameters);
    mf_memory_free(energy.parameters);
    return status;
}

/// The scene's local densities, with the numbers of their laws.
static enum status change_many_body(const struct inverse_problem *problem, const double *value,
                                    struct simulation_setup *scene, struct numbers_own *own) {
    for (int k = 0; k < scene->interactions; k++) {
        struct interaction_choice *choice = &scene->interaction[k];
        if (choice->kind != &mf_many_body)
            continue;
        const struct many_body *from = choice->parameters;
        own->many_body.composition = from->composition;
        for (int t = 0; t < from->terms; t++) {
            struct many_body_term *term = &own->many_body.term[own->many_body.terms++];
            *term = from->term[t];
            term->weight = (struct weight_table){0};
            term->energy = (struct density_energy){0};
            TRY(tabulate_density(problem, t, value, term));
        }
        choice->parameters = &own->many_body;
    }
    return STATUS_OK;
}

const struct table **mf_numbers_table_of(struct simulation_setup *scene, int law) {
    switch (law) {
    case UNKNOWN_POTENTIAL:
        return &scene->potential;
    case UNKNOWN_OMEGA:
        return &scene->omega;
    case UNKNOWN_TRANSVERSE:
        return &scene->memory.transverse;
    default:
        return &scene->memory.mode[law - UNKNOWN_MEMORY].omega;
    }
}

enum status mf_numbers_apply(const struct inverse_problem *problem, const double *value,
                             struct inverse_problem *changed, struct numbers_own *own) {
    *changed = *problem;
    for (size_t n = 0; n < problem->numbers; n++)
        TRY(append(&problem->number[n], value[n], &changed->scene, own));
    for (int place = 0; place < UNKNOWN_BONDED; place++)
        if (concerns(problem, place)) {
            TRY(tabulate(problem, place, value, &own->table[place]));
            *mf_numbers_table_of(&changed->scene, place) = &own->table[place];
        }
    if (concerns(problem, INVERSE_OF_BONDED))
        TRY(change_molecules(problem, value, &changed->scene, own));
    if (concerns(problem, INVERSE_OF_WEIGHT) || concerns(problem, INVERSE_OF_DENSITY_ENERGY))
        TRY(change_many_body(problem, value, &changed->scene, own));
    return STATUS_OK;
}

void mf_numbers_own_clear(struct numbers_own *own) {
    for (int place = 0; place < UNKNOWNS; place++)
        mf_table_clear(&own->table[place]);
    for (int k = 0; k < INTERACTION_MAX; k++)
        mf_memory_free(own->interaction[k]);
    for (int group = 0; group < INVERSE_MAX_BONDED; group++)
        mf_memory_free(own->bonded[group]);
    mf_memory_free(own->dynamics);
    mf_many_body_clear(&own->many_body);
    *own = (struct numbers_own){0};
}

void mf_numbers_start(const struct inverse_problem *problem, double *value) {
    for (size_t n = 0; n < problem->numbers; n++)
        value[n] = problem->number[n].start;
}

const char *mf_numbers_bound(const struct inverse_number *number, double value) {
    static const double near = 1e-3;
    const double part = (value - number->minimum) / (number->maximum - number->minimum);
    return part < near ? "minimum" : part > 1 - near ? "maximum" : NULL;
}

bool mf_numbers_undetermined(const struct inverse_number *number,
                             const struct inverse_parameter *found) {
    return mf_numbers_bound(number, found->value) == NULL &&
           4 * found->error > 0.5 * (number->maximum - number->minimum);
}
