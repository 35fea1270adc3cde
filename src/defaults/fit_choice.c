// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_choice.h"

#include "curves/formula.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void mf_fit_choice_note(const struct fit_choice *c, const char *format, ...) {
    struct fit_choices *const choices = &c->fit->choices;
    va_list arguments;
    if (choices->count == FIT_MAX_CHOICES)
        return;
    va_start(arguments, format);
    vsnprintf(choices->line[choices->count++], FIT_CHOICE_SIZE, format, arguments);
    va_end(arguments);
}

const char *mf_fit_choice_text(const struct fit_choice *choice, const char *unit, double value,
                               char text[FIT_CHOICE_TEXT_SIZE]) {
    const struct units *units = &choice->fit->scene.units;
    char name[UNITS_NAME_SIZE];
    const struct units *physical = units->system == UNITS_REDUCED ? NULL : units;
    mf_units_name(physical, unit, name);
    snprintf(text, FIT_CHOICE_TEXT_SIZE, "%.4g%s%s", value * mf_units_factor(physical, unit),
             name[0] ? " " : "", name);
    return text;
}

/// The nearest number that a file may have there: a choice that the reader would refuse is none.
static double nearest_allowed(const struct fit_choice *choice, const char *path,
                              const struct field *field, double value) {
    const double allowed = fmin(fmax(value, field->minimum), field->maximum);
    char wanted[FIT_CHOICE_TEXT_SIZE], text[FIT_CHOICE_TEXT_SIZE];
    if (allowed != value)
        mf_fit_choice_note(choice, "%s.%s: %s, as near as it may be to %s", path, field->name,
                           mf_fit_choice_text(choice, field->unit, allowed, text),
                           mf_fit_choice_text(choice, field->unit, value, wanted));
    return allowed;
}

double mf_fit_choice_number(const struct fit_choice *choice, const char *path,
                            const struct field *fields, const char *key, double value) {
    const struct units *units = &choice->fit->scene.units;
    while (strcmp(fields->name, key) != 0)
        fields++;
    const double factor = units->system == UNITS_REDUCED ? 1 : mf_units_factor(units, fields->unit);
    value = nearest_allowed(choice, path, fields, value);
    return mf_units_file_value(value, factor) / factor;
}

bool mf_fit_choice_give(const struct fit_choice *choice, const struct fit_place *place,
                        const char *key, double value) {
    const uint64_t bit = mf_fields_bit(place->fields, key);
    const struct field *field = place->fields;
    if (*place->given & bit)
        return false;
    while (strcmp(field->name, key) != 0)
        field++;
    char *const member = (char *)place->parameters + field->offset;
    if (field->type == FIELD_CHOICE)
        memcpy(member, &(int){(int)value}, sizeof(int));
    else
        value = mf_fit_choice_number(choice, place->path, place->fields, key, value);
    if (field->type == FIELD_NUMBER)
        memcpy(member, &value, sizeof value);
    if (field->type == FIELD_INTEGER)
        memcpy(member, &(int64_t){(int64_t)value}, sizeof(int64_t));
    *place->given |= bit;
    return true;
}

enum status mf_fit_choice_give_omega(const struct fit_choice *choice, const char *path,
                                     double sigma, double cutoff, struct scene_law *law) {
    uint64_t given = 0;
    TRY(mf_curve_create(&law->curve[0], &mf_formula_power_omega));
    law->curves = 1;
    const struct fit_place place = {path, mf_formula_power_omega.fields, law->curve[0].parameters,
                                    &given};
    mf_fit_choice_give(choice, &place, "sigma", sigma);
    mf_fit_choice_give(choice, &place, "cutoff", cutoff);
    return STATUS_OK;
}
