// SPDX-License-Identifier: GPL-3.0-or-later
#include "topologies/gromacs_terms.h"

#include "base/memory.h"
#include "curves/bonded_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool mf_gromacs_is_integer(const char *word, int64_t min, int64_t max, int64_t *value) {
    char *end;
    *value = strtoll(word, &end, 10);
    return *end == '\0' && end != word && *value >= min && *value <= max;
}

/// Room for one more item of `size` bytes after `count`.
enum status mf_gromacs_reserve(void **array, size_t count, size_t *capacity, size_t size) {
    if (count < *capacity)
        return STATUS_OK;
    const size_t larger = *capacity ? 2 * *capacity : 16;
    void *grown = mf_memory_zeroed(larger, size);
    if (grown == NULL)
        return STATUS_NO_MEMORY;
    if (count > 0)
        memcpy(grown, *array, count * size);
    mf_memory_free(*array);
    *array = grown;
    *capacity = larger;
    return STATUS_OK;
}

struct topology_kind *mf_gromacs_last_kind(const struct gromacs_reading *reading) {
    struct topology *topology = &reading->molecules->topology;
    return topology->kinds > 0 ? &topology->kind[topology->kinds - 1] : NULL;
}

// Parameters --------------------------------------------------------------------------------------

static const struct gromacs_function *find_function(int order, int64_t number) {
    for (const struct gromacs_function *f = mf_gromacs_functions; f->law; f++)
        if (f->order == order && f->number == number)
            return f;
    return number == mf_gromacs_tables[order].number ? &mf_gromacs_tables[order] : NULL;
}

/// "1 (harmonic), 7 (fene), ": those that are laws of ours.
static void list_functions(int order, char *text, size_t size) {
    size_t length = 0;
    text[0] = '\0';
    for (const struct gromacs_function *f = mf_gromacs_functions; f->law; f++)
        if (f->order == order && length < size)
            length += (size_t)snprintf(text + length, size - length, "%d (%s), ", f->number,
                                       f->law->name);
}

static int parameters_of(const struct gromacs_function *function) {
    int count = 0;
    while (count < GROMACS_MAX_PARAMETERS && function->parameter[count])
        count++;
    return count;
}

static enum status read_function(const struct gromacs_line *line, int order, const char *word,
                                 const struct gromacs_function **function) {
    char known[160];
    int64_t number;
    *function = mf_gromacs_is_integer(word, 1, 100, &number) ? find_function(order, number) : NULL;
    if (*function)
        return STATUS_OK;
    list_functions(order, known, sizeof known);
    return mf_gromacs_fail(line, "function %.40s of %s %s is not supported; use %s8 (table)", word,
                           mf_bonded_kinds[order]->article, mf_bonded_kinds[order]->name, known);
}

/// Numbers after the function: none, or those of it, perhaps twice as for free energies.
static enum status read_values(const struct gromacs_line *line, const struct gromacs_words *words,
                               int first, int wanted, double *values, int *count) {
    *count = words->count - first;
    if (*count != 0 && *count != wanted && *count != 2 * wanted)
        return mf_gromacs_fail(line, "%d numbers after the function, expected %d", *count, wanted);
    for (int n = 0; n < *count; n++) {
        char *end;
        values[n] = strtod(words->word[first + n], &end);
        if (*end != '\0' || !isfinite(values[n]))
            return mf_gromacs_fail(line, "expected a number, found \"%.40s\"",
                                   words->word[first + n]);
    }
    return STATUS_OK;
}

enum status mf_gromacs_add_type(struct gromacs_reading *reading, const struct gromacs_line *line,
                                const struct gromacs_words *words) {
    const int order = reading->order, beads = mf_bonded_kinds[order]->beads;
    struct gromacs_term_type *type = &reading->type[reading->types];
    const struct gromacs_function *function;
    if (reading->types == GROMACS_MAX_TYPES)
        return mf_gromacs_fail(line, "more than %d types of terms", GROMACS_MAX_TYPES);
    if (words->count <= beads)
        return mf_gromacs_fail(line, "expected %d types and a function", beads);
    *type = (struct gromacs_term_type){.order = order};
    for (int k = 0; k < beads; k++)
        snprintf(type->bead[k], GROMACS_WORD_SIZE, "%s", words->word[k]);
    // Of functions that nobody uses nothing need be known.
    int64_t number;
    if (!mf_gromacs_is_integer(words->word[beads], 1, 100, &number) ||
        (function = find_function(order, number)) == NULL)
        return STATUS_OK;
    type->number = (int)number;
    const enum status status =
        read_values(line, words, beads + 1, parameters_of(function), type->value, &type->words);
    if (status != STATUS_OK)
        return reading->lawless ? STATUS_OK : status;
    reading->types++;
    return STATUS_OK;
}

/// Whether the beads of a term are of the types of a line, in either direction.
static bool is_of(const struct gromacs_reading *reading, const struct topology_term *term,
                  const struct gromacs_term_type *type) {
    const struct topology_kind *kind = mf_gromacs_last_kind(reading);
    const int beads = mf_bonded_kinds[type->order]->beads;
    bool forward = true, backward = true;
    for (int k = 0; k < beads; k++) {
        const char *name = reading->composition->name[kind->type[term->bead[k]]];
        forward &= strcmp(type->bead[k], name) == 0;
        backward &= strcmp(type->bead[beads - 1 - k], name) == 0;
    }
    return forward || backward;
}

static enum status find_values(const struct gromacs_reading *reading,
                               const struct gromacs_line *line,
                               const struct gromacs_function *function,
                               const struct topology_term *term, double *values) {
    int found = 0;
    for (size_t k = 0; k < reading->types; k++) {
        const struct gromacs_term_type *type = &reading->type[k];
        if (type->order != function->order || type->number != function->number ||
            type->words == 0 || !is_of(reading, term, type))
            continue;
        found++;
        memcpy(values, type->value, sizeof type->value);
    }
    if (found > 1)
        return mf_gromacs_fail(line,
                               "%d lines have parameters of the types of this %s, which GROMACS "
                               "would add up or choose from: write them with the term",
                               found, mf_bonded_kinds[function->order]->name);
    if (found == 1)
        return STATUS_OK;
    return mf_gromacs_fail(line, "the %s has no parameters, and no type has them for this function",
                           mf_bonded_kinds[function->order]->name);
}

// Groups ------------------------------------------------------------------------------------------

/// Set a parameter of a law, which must be in its range.
static enum status set_number(const struct gromacs_line *line, struct bonded_curve *curve,
                              const char *name, double value) {
    return mf_bonded_set_number(curve, name, value)
               ? STATUS_OK
               : mf_gromacs_fail(line, "%s of the law \"%s\" cannot be %g", name, curve->law->name,
                                 value);
}

/// "A-B", of the types of a term.
static void name_types(const struct gromacs_reading *reading, int order,
                       const struct topology_term *term, char *name, size_t size) {
    const struct topology_kind *kind = mf_gromacs_last_kind(reading);
    size_t length = 0;
    for (int k = 0; k < mf_bonded_kinds[order]->beads && length < size; k++)
        length += (size_t)snprintf(name + length, size - length, "%s%s", k ? "-" : "",
                                   reading->composition->name[kind->type[term->bead[k]]]);
}

/// "A-B", of the types of a term; "A-B_2" if another group is called so.
static void name_group(const struct gromacs_reading *reading, int order,
                       const struct topology_term *term, char name[TOPOLOGY_NAME_SIZE]) {
    char plain[TOPOLOGY_NAME_SIZE - 4], numbered[2 * TOPOLOGY_NAME_SIZE];
    name_types(reading, order, term, plain, sizeof plain);
    snprintf(name, TOPOLOGY_NAME_SIZE, "%s", plain);
    for (int number = 2; mf_molecules_group(reading->molecules, order, name); number++) {
        snprintf(numbered, sizeof numbered, "%s_%d", plain, number);
        snprintf(name, TOPOLOGY_NAME_SIZE, "%.*s", TOPOLOGY_NAME_SIZE - 1, numbered);
    }
}

/// The law of a function with these numbers. Tables are distinguished by their numbers alone.
static enum status make_law(const struct gromacs_reading *reading, const struct gromacs_line *line,
                            const struct gromacs_function *function, const double *values,
                            struct bonded_curve *curve) {
    enum status status = STATUS_OK;
    TRY(mf_bonded_create(curve, function->law));
    if (bonded_is_table(function->law)) {
        struct bonded_table *table = curve->parameters;
        snprintf(table->file, sizeof table->file, "table %g times %g", values[0], values[1]);
        return STATUS_OK;
    }
    for (int n = 0; n < parameters_of(function) && status == STATUS_OK; n++)
        status = set_number(line, curve, function->parameter[n],
                            values[n] /
                                gromacs_unit(function->unit[n], reading->length, reading->energy));
    if (status != STATUS_OK)
        mf_bonded_clear(curve);
    return status;
}

/// The group of these parameters, which is new or was there.
static enum status find_group(struct gromacs_reading *reading, const struct gromacs_line *line,
                              const struct gromacs_function *function, const double *values,
                              struct topology_term *term) {
    const int order = function->order;
    struct molecules *molecules = reading->molecules;
    struct bonded_curve curve;
    enum status status = STATUS_OK;
    TRY(make_law(reading, line, function, values, &curve));
    for (term->group = 0; status == STATUS_OK && term->group < molecules->groups[order];
         term->group++) {
        const struct bonded_curve *known = &molecules->group[order][term->group].curve;
        if (known->law == curve.law &&
            memcmp(known->parameters, curve.parameters, curve.law->size) == 0)
            break;
    }
    if (status == STATUS_OK && term->group == MOLECULES_MAX_GROUPS)
        status = mf_gromacs_fail(line, "there are more than %d groups of %ss of other parameters",
                                 MOLECULES_MAX_GROUPS, mf_bonded_kinds[order]->name);
    if (status != STATUS_OK || term->group < molecules->groups[order]) {
        mf_bonded_clear(&curve);
        return status;
    }
    struct molecules_group *group = &molecules->group[order][term->group];
    name_group(reading, order, term, group->name);
    group->curve = curve;
    molecules->groups[order]++;
    return STATUS_OK;
}

// Terms -------------------------------------------------------------------------------------------

/// The group of a term whose law does not matter: one for all of the same function and numbers, as
/// they stand there, or of the same types where there are none. It is a table without points.
static enum status find_lawless_group(struct gromacs_reading *reading,
                                      const struct gromacs_line *line,
                                      const struct gromacs_words *words,
                                      struct topology_term *term) {
    const int order = reading->order, beads = mf_bonded_kinds[order]->beads;
    const struct bonded_law *const law = mf_gromacs_tables[order].law;
    struct molecules *const molecules = reading->molecules;
    char text[sizeof((struct bonded_table *)NULL)->file] = "held";
    size_t length = reading->constraints ? strlen(text) : 0;
    text[length] = '\0';
    if (words->count == beads + 1)
        name_types(reading, order, term, text + length, sizeof text - length);
    for (int k = beads; k < words->count && (length = strlen(text)) < sizeof text - 1; k++)
        snprintf(text + length, sizeof text - length, " %s", words->word[k]);
    for (term->group = 0; term->group < molecules->groups[order]; term->group++) {
        const struct bonded_curve *const known = &molecules->group[order][term->group].curve;
        if (known->law == law &&
            strcmp(((const struct bonded_table *)known->parameters)->file, text) == 0)
            return STATUS_OK;
    }
    if (term->group == MOLECULES_MAX_GROUPS)
        return mf_gromacs_fail(line, "there are more than %d groups of %ss of other parameters",
                               MOLECULES_MAX_GROUPS, mf_bonded_kinds[order]->name);
    struct molecules_group *const group = &molecules->group[order][term->group];
    TRY(mf_bonded_create(&group->curve, law));
    struct bonded_table *const table = group->curve.parameters;
    snprintf(table->file, sizeof table->file, "%s", text);
    name_group(reading, order, term, group->name);
    molecules->groups[order]++;
    return STATUS_OK;
}

/// The group of a term by its function and numbers, or those of its types.
static enum status find_law(struct gromacs_reading *reading, const struct gromacs_line *line,
                            const struct gromacs_words *words, struct topology_term *term) {
    const int order = reading->order, beads = mf_bonded_kinds[order]->beads;
    const struct gromacs_function *function;
    double values[2 * GROMACS_MAX_PARAMETERS];
    int count;
    TRY(read_function(line, order, words->word[beads], &function));
    TRY(read_values(line, words, beads + 1, parameters_of(function), values, &count));
    if (count == 0)
        TRY(find_values(reading, line, function, term, values));
    return find_group(reading, line, function, values, term);
}

/// What is no law of ours is a group all the same where laws do not matter.
static enum status find_term_group(struct gromacs_reading *reading, const struct gromacs_line *line,
                                   const struct gromacs_words *words, struct topology_term *term) {
    const enum status status =
        reading->constraints ? STATUS_BAD_INPUT : find_law(reading, line, words, term);
    return status == STATUS_BAD_INPUT && reading->lawless
               ? find_lawless_group(reading, line, words, term)
               : status;
}

enum status mf_gromacs_add_term(struct gromacs_reading *reading, const struct gromacs_line *line,
                                const struct gromacs_words *words) {
    const int order = reading->order, beads = mf_bonded_kinds[order]->beads;
    struct topology_kind *kind = mf_gromacs_last_kind(reading);
    struct topology_term term = {.group = 0};
    if (kind && kind->terms[order] == GROMACS_MAX_TERMS)
        return mf_gromacs_fail(line, "%s has more than %d %ss", kind->name, GROMACS_MAX_TERMS,
                               mf_bonded_kinds[order]->name);
    if (kind == NULL || words->count <= beads)
        return mf_gromacs_fail(line, "expected %d atoms of a moleculetype and a function", beads);
    for (int k = 0; k < beads; k++) {
        int64_t number;
        if (!mf_gromacs_is_integer(words->word[k], 1, kind->beads, &number))
            return mf_gromacs_fail(line, "there is no atom %.40s: %s has 1 to %d", words->word[k],
                                   kind->name, kind->beads);
        term.bead[k] = (int)number - 1;
    }
    TRY(find_term_group(reading, line, words, &term));
    TRY(mf_gromacs_reserve((void **)&kind->term[order], (size_t)kind->terms[order],
                           &reading->term_capacity[order], sizeof term));
    kind->term[order][kind->terms[order]++] = term;
    const enum status status = mf_topology_check_term(kind, order, kind->terms[order] - 1);
    return status == STATUS_BAD_INPUT ? mf_status_prefix(status, "%s:%zu", line->file, line->number)
                                      : status;
}
