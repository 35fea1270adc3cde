// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/fields.h"

#include <math.h>
#include <string.h>

uint64_t mf_fields_bit(const struct field *fields, const char *name) {
    uint64_t bit = 1;
    for (const struct field *field = fields; strcmp(field->name, name) != 0; field++)
        bit <<= 1;
    return bit;
}

void mf_fields_set_defaults(const struct field *fields, void *parameters) {
    for (const struct field *field = fields; field->name; field++) {
        char *member = (char *)parameters + field->offset;
        switch (field->type) {
        case FIELD_NUMBER:
            memcpy(member, &field->initial, sizeof(double));
            break;
        case FIELD_INTEGER:
            memcpy(member, &(int64_t){(int64_t)field->initial}, sizeof(int64_t));
            break;
        case FIELD_SEED:
            memcpy(member, &(uint64_t){(uint64_t)field->initial}, sizeof(uint64_t));
            break;
        case FIELD_LENGTHS:
            memset(member, 0, 3 * sizeof(double));
            break;
        case FIELD_TEXT:
        case FIELD_FILE:
            member[0] = '\0';
            break;
        case FIELD_CHOICE:
        case FIELD_CHOICES:
            memcpy(member, &(int){(int)field->initial}, sizeof(int));
            break;
        }
    }
}

void mf_fields_range_text(const struct field *field, char *text, size_t size) {
    const bool ranged =
        field->type == FIELD_NUMBER || field->type == FIELD_INTEGER || field->type == FIELD_LENGTHS;
    const double low = ranged ? field->minimum : -DBL_MAX, high = ranged ? field->maximum : DBL_MAX;
    const bool bounded_above = high < DBL_MAX && high < FIELD_LARGEST_INTEGER;
    if (low == FIELD_ABOVE_ZERO && !bounded_above)
        snprintf(text, size, "above 0");
    else if (low == FIELD_ABOVE_ZERO)
        snprintf(text, size, "above 0, at most %g", high);
    else if (low > -DBL_MAX && bounded_above)
        snprintf(text, size, "%g to %g", low, high);
    else if (low > -DBL_MAX)
        snprintf(text, size, "at least %g", low);
    else
        snprintf(text, size, "any");
}

int mf_fields_choice_index(const struct field *field, const char *name) {
    for (int i = 0; field->choices[i]; i++)
        if (strcmp(field->choices[i], name) == 0)
            return i;
    return -1;
}

/// The choices of a set, all of them with ~0, one after the other.
static void join_choices(const struct field *field, unsigned set, const char *between, char *text,
                         size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; field->choices[i] && used < size; i++)
        if (set >> i & 1)
            used += (size_t)snprintf(text + used, size - used, "%s%s", used ? between : "",
                                     field->choices[i]);
}

void mf_fields_type_text(const struct field *field, char *text, size_t size) {
    switch (field->type) {
    case FIELD_NUMBER:
        snprintf(text, size, "number");
        break;
    case FIELD_INTEGER:
    case FIELD_SEED:
        snprintf(text, size, "integer");
        break;
    case FIELD_LENGTHS:
        snprintf(text, size, "2 or 3 numbers");
        break;
    case FIELD_TEXT:
        snprintf(text, size, "text");
        break;
    case FIELD_FILE:
        snprintf(text, size, "file");
        break;
    case FIELD_CHOICE:
        join_choices(field, ~0u, "|", text, size);
        break;
    case FIELD_CHOICES: {
        const int used = snprintf(text, size, "list of ");
        join_choices(field, ~0u, "|", text + used, size - (size_t)used);
        break;
    }
    }
}

void mf_fields_default_text(const struct field *field, char *text, size_t size) {
    if (field->required)
        snprintf(text, size, "required");
    else if (field->type == FIELD_CHOICE)
        snprintf(text, size, "%s", field->choices[(int)field->initial]);
    else if (field->type == FIELD_CHOICES)
        join_choices(field, (unsigned)field->initial, ", ", text, size);
    else if (field->type == FIELD_TEXT || field->type == FIELD_FILE || field->type == FIELD_LENGTHS)
        snprintf(text, size, "none");
    else if (isnan(field->initial))
        snprintf(text, size, "none");
    else
        snprintf(text, size, "%.12g", field->initial);
}

void mf_fields_describe(const struct field *fields, FILE *stream) {
    for (const struct field *field = fields; field->name; field++) {
        char type[256], fallback[64], range[64];
        mf_fields_type_text(field, type, sizeof type);
        mf_fields_default_text(field, fallback, sizeof fallback);
        mf_fields_range_text(field, range, sizeof range);
        fprintf(stream, "  %-24s %s%s%s\n", field->name, field->help, field->unit[0] ? ", in " : "",
                field->unit);
        fprintf(stream, "  %-24s   %s, %s%s%s\n", "", type, field->required ? "" : "default ",
                fallback, "");
        if (strcmp(range, "any") != 0)
            fprintf(stream, "  %-24s   range: %s\n", "", range);
    }
}
