// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/bonded_law.h"

#include "base/memory.h"
#include "base/names.h"

#include <math.h>
#include <string.h>

NAMED_RECORD(struct bonded_law);

enum status mf_bonded_create(struct bonded_curve *curve, const struct bonded_law *law) {
    *curve = (struct bonded_curve){law, mf_memory_zeroed(1, law->size)};
    if (curve->parameters == NULL)
        return STATUS_NO_MEMORY;
    mf_fields_set_defaults(law->fields, curve->parameters);
    return STATUS_OK;
}

void mf_bonded_clear(struct bonded_curve *curve) {
    if (curve->parameters && curve->law->clear)
        curve->law->clear(curve->parameters);
    mf_memory_free(curve->parameters);
    *curve = (struct bonded_curve){0};
}

static const struct field *find_field(const struct bonded_curve *curve, const char *name) {
    const struct field *field = curve->law->fields;
    while (strcmp(field->name, name) != 0)
        field++;
    return field;
}

double mf_bonded_number(const struct bonded_curve *curve, const char *name) {
    const struct field *field = find_field(curve, name);
    const void *member = (const char *)curve->parameters + field->offset;
    return field->type == FIELD_INTEGER ? (double)*(const int64_t *)member
                                        : *(const double *)member;
}

bool mf_bonded_set_number(struct bonded_curve *curve, const char *name, double value) {
    const struct field *field = find_field(curve, name);
    void *member = (char *)curve->parameters + field->offset;
    if (!(value >= field->minimum && value <= field->maximum) ||
        (field->type == FIELD_INTEGER && value != rint(value)))
        return false;
    if (field->type == FIELD_INTEGER)
        *(int64_t *)member = (int64_t)value;
    else
        *(double *)member = value;
    return true;
}

void mf_bonded_value(const struct bonded_curve *curve, double q, double *energy, double *slope) {
    double value, derivative;
    curve->law->evaluate(curve->parameters, 1, &q, &value, &derivative);
    if (energy)
        *energy = value;
    if (slope)
        *slope = derivative;
}

double mf_bonded_rest(const struct bonded_curve *curve) {
    return curve->law->rest(curve->parameters);
}

double mf_bonded_longest(const struct bonded_curve *curve) {
    return curve->law->longest ? curve->law->longest(curve->parameters) : INFINITY;
}

double mf_bonded_reach(const struct bonded_curve *curve, double height) {
    enum { DOUBLINGS = 40 };
    const double rest = mf_bonded_rest(curve), max = mf_bonded_longest(curve);
    double min, energy, way = fmax(1e-3, 1e-3 * rest);
    mf_bonded_value(curve, rest, &min, NULL);
    for (int n = 0; n < DOUBLINGS && rest + way < max; n++, way *= 2) {
        mf_bonded_value(curve, rest + way, &energy, NULL);
        if (energy > min + height)
            break;
    }
    return fmin(rest + way, max);
}

/// ∫ r^(d−1) e^(−(U − U_rest)/k_B T) dr, by midpoints.
static double integrate_lengths(const struct bonded_curve *curve, double from, double to,
                                double temperature, int dimensions) {
    enum { POINTS = 4000 };
    double min, sum = 0;
    mf_bonded_value(curve, mf_bonded_rest(curve), &min, NULL);
    for (int k = 0; k < POINTS; k++) {
        const double r = from + (k + 0.5) * (to - from) / POINTS;
        double energy;
        mf_bonded_value(curve, r, &energy, NULL);
        sum += pow(r, dimensions - 1) * exp((min - energy) / temperature);
    }
    return sum * (to - from) / POINTS;
}

double mf_bonded_share_beyond(const struct bonded_curve *curve, double length, double temperature,
                              int dimensions) {
    static const double highest = 40;
    const double reach = mf_bonded_reach(curve, highest * temperature);
    if (reach <= length)
        return 0;
    const double below = integrate_lengths(curve, 0, length, temperature, dimensions);
    const double beyond = integrate_lengths(curve, length, reach, temperature, dimensions);
    return beyond / (below + beyond);
}
