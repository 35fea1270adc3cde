// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/numbers.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

#define MEMBER(name) .offset = offsetof(struct inverse_number, name)
const struct field mf_numbers_fields[] = {
    {"minimum", FIELD_NUMBER, MEMBER(minimum), .required = true, .minimum = -DBL_MAX,
     .maximum = DBL_MAX, .unit = "", .help = "least value, in the unit of the number"},
    {"maximum", FIELD_NUMBER, MEMBER(maximum), .required = true, .minimum = -DBL_MAX,
     .maximum = DBL_MAX, .unit = "", .help = "largest value"},
    {"start", FIELD_NUMBER, MEMBER(start), .initial = NAN, .minimum = -DBL_MAX, .maximum = DBL_MAX,
     .unit = "",
     .help = "to begin with; without it what the scene says, and the middle if that is out of the "
             "range"},
    FIELD_END,
};

/// The curves of a law with these values, one table for all of them.
static enum status tabulate(const struct inverse_problem *problem, enum unknown_kind kind,
                            const double *value, struct table *table) {
    enum status status = STATUS_OK;
    const struct inverse_law *law = &problem->law[kind];
    struct table part[COMPOSITION_MOST_PAIRS] = {{0}};
    unsigned char *parameters = NULL;
    for (int pair = 0; pair < law->curves; pair++) {
        const struct curve_family *family = law->curve[pair].family;
        if (family == NULL)
            continue;
        mf_memory_free(parameters);
        NEW_ARRAY(parameters, family->size);
        memcpy(parameters, law->curve[pair].parameters, family->size);
        for (size_t n = 0; n < problem->numbers; n++) {
            const struct inverse_number *number = &problem->number[n];
            if (number->place == (enum inverse_place)kind && number->pair == pair)
                memcpy(parameters + number->offset, &value[n], sizeof value[n]);
        }
        const struct curve curve = {family, parameters};
        CHECK(kind == UNKNOWN_POTENTIAL ? mf_table_init_potential(&part[pair], &curve)
                                        : mf_table_init_omega(&part[pair], &curve));
    }
    if (law->curves > 1) {
        CHECK(mf_table_stack(table, part, law->curves));
    } else {
        *table = part[0];
        part[0] = (struct table){0};
    }
done:
    mf_memory_free(parameters);
    for (int pair = 0; pair < law->curves; pair++)
        mf_table_clear(&part[pair]);
    return status;
}

static bool concerns(const struct inverse_problem *problem, enum unknown_kind kind) {
    for (size_t n = 0; n < problem->numbers; n++)
        if (problem->number[n].place == (enum inverse_place)kind)
            return true;
    return false;
}

enum status mf_numbers_apply(const struct inverse_problem *problem, const double *value,
                             struct inverse_problem *changed, struct table own[UNKNOWNS]) {
    *changed = *problem;
    for (size_t n = 0; n < problem->numbers; n++)
        if (problem->number[n].place == INVERSE_OF_SETUP)
            memcpy((char *)&changed->scene + problem->number[n].offset, &value[n], sizeof value[n]);
    if (concerns(problem, UNKNOWN_POTENTIAL)) {
        TRY(tabulate(problem, UNKNOWN_POTENTIAL, value, &own[UNKNOWN_POTENTIAL]));
        changed->scene.potential = &own[UNKNOWN_POTENTIAL];
    }
    if (concerns(problem, UNKNOWN_OMEGA)) {
        TRY(tabulate(problem, UNKNOWN_OMEGA, value, &own[UNKNOWN_OMEGA]));
        changed->scene.omega = &own[UNKNOWN_OMEGA];
    }
    return STATUS_OK;
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
