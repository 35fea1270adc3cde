// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/fields_text.h"

#include <math.h>
#include <stdio.h>

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
