// SPDX-License-Identifier: GPL-3.0-or-later
#include "topologies/lammps_terms.h"

#include "base/memory.h"
#include "trajectory/lammps_data.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

struct reading {
    struct lammps_terms *terms;
    const struct structure *structure;
    const struct trajectory_frame *frame; ///< the file
    struct lammps_data data;
    size_t line; ///< number of the one that is being read
};

#define FAIL(reading, ...)                                                                         \
    mf_status_prefix(mf_status_fail(STATUS_BAD_INPUT, __VA_ARGS__), "%s:%zu",                      \
                     (reading)->frame->file, (reading)->line)

static void go_to(struct reading *reading, const char *line) {
    reading->line = 1;
    for (const char *c = (const char *)reading->frame->raw.data; c < line; c++)
        reading->line += *c == '\0';
}

/// What we do not know must not be there.
static enum status check_known(struct reading *reading) {
    struct word word[LAMMPS_DATA_WORDS];
    const char *const unknown = reading->data.unknown, *const foreign = reading->data.foreign;
    if (foreign) {
        go_to(reading, foreign);
        mf_lammps_data_split(foreign, word);
        return FAIL(reading, "%.*s are not known", words_shown(&word[1]), word[1].begin);
    }
    if (unknown == NULL)
        return STATUS_OK;
    const size_t count = mf_lammps_data_split(unknown, word);
    const struct word *const last = &word[count <= LAMMPS_DATA_WORDS ? count - 1 : 0];
    go_to(reading, unknown);
    return FAIL(reading, "the section \"%.*s\" is not known",
                (int)(last->begin + last->length - word[0].begin), word[0].begin);
}

/// The lines in which the terms of the structure stand.
static enum status add_terms(struct reading *reading, int order) {
    struct lammps_terms *const terms = reading->terms;
    const struct bonded_kind *const kind = mf_bonded_kinds[order];
    const struct structure_terms *const from = &reading->structure->terms[order];
    const struct lammps_data_terms *const section = &reading->data.terms[order];
    struct word word[LAMMPS_DATA_WORDS];
    size_t found = 0;
    TRY_ARRAY(terms->line[order], from->count);
    go_to(reading, section->first);
    for (const char *line = section->first; line; reading->line++) {
        const size_t words = mf_lammps_data_split(line, word);
        if (words > 0 && isalpha((unsigned char)*word[0].begin))
            break;
        line = mf_frame_next_line(reading->frame, line);
        if (words == 0 || found++ >= from->count)
            continue; // more than the header says is told below
        if (section->types == 0)
            return FAIL(reading, "the header has no \"%s types\"", kind->name);
        terms->line[order][found - 1] = reading->line;
    }
    if (found == section->count)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: expected \"%zu %s\", found %zu: is the file complete?",
                          reading->frame->file, section->count, kind->plural, found);
}

/// "1 30.0 1.5", in a section of several styles "1 harmonic 30.0 1.5".
static enum status add_coefficient(struct reading *reading, int order, const struct word *word,
                                   size_t words) {
    const struct structure_terms *const of = &reading->structure->terms[order];
    const struct lammps_data_terms *const section = &reading->data.terms[order];
    const bool hybrid = strcmp(section->style, "hybrid") == 0;
    const int first = hybrid ? 2 : 1;
    const size_t type =
        mf_lammps_data_type(&word[0], of->types, (const char(*)[STRUCTURE_NAME])of->name);
    if (section->style[0] == '\0')
        return FAIL(reading, "unknown style: name it, as in \"%c%s Coeffs # harmonic\"",
                    toupper((unsigned char)mf_bonded_kinds[order]->name[0]),
                    mf_bonded_kinds[order]->name + 1);
    if (type == 0)
        return FAIL(reading, "expected a type from 1 to %zu and its coefficients", section->types);
    struct lammps_coefficient *const own = &reading->terms->coefficient[order][type];
    if (own->line > 0)
        return FAIL(reading, "duplicate type %zu", type);
    *own = (struct lammps_coefficient){.line = reading->line, .count = (int)words - first};
    if (own->count < 0 || own->count > LAMMPS_MAX_NUMBERS)
        return FAIL(reading, "no known style has %d numbers", own->count);
    if (!hybrid)
        memcpy(own->style, section->style, sizeof own->style);
    else if (!mf_words_copy(&word[1], own->style, sizeof own->style))
        return FAIL(reading, "the style's name is too long");
    for (int n = 0; n < own->count; n++)
        if (!mf_words_number(&word[first + n], &own->number[n]))
            return FAIL(reading, "expected a number, found \"%.*s\"", words_shown(&word[first + n]),
                        word[first + n].begin);
    return STATUS_OK;
}
_Static_assert(LAMMPS_MAX_NUMBERS + 2 <= LAMMPS_DATA_WORDS, "all words of a line are kept");

static enum status add_coefficients(struct reading *reading, int order) {
    struct lammps_terms *const terms = reading->terms;
    const struct lammps_data_terms *const section = &reading->data.terms[order];
    struct word word[LAMMPS_DATA_WORDS];
    terms->types[order] = (int64_t)section->types;
    TRY_ARRAY(terms->coefficient[order], section->types + 1);
    go_to(reading, section->coefficients);
    for (const char *line = section->coefficients; line; reading->line++) {
        const size_t words = mf_lammps_data_split(line, word);
        if (words > 0 && isalpha((unsigned char)*word[0].begin) &&
            !mf_lammps_data_is_labelled(word, words))
            break;
        if (words > 0)
            TRY(add_coefficient(reading, order, word, words));
        line = mf_frame_next_line(reading->frame, line);
    }
    return STATUS_OK;
}

/// From the end whose atom is the smaller.
struct sorted_term {
    uint32_t atom[BONDED_MAX_TERM_BEADS], type;
    size_t line;
};

/// Terms of the same atoms follow each other, and among angles and dihedrals those of the same
/// type.
static int compare_terms(const void *a, const void *b) {
    const struct sorted_term *x = a, *y = b;
    for (int k = 0; k < BONDED_MAX_TERM_BEADS; k++)
        if (x->atom[k] != y->atom[k])
            return x->atom[k] < y->atom[k] ? -1 : 1;
    if (x->type != y->type)
        return x->type < y->type ? -1 : 1;
    return x->line < y->line ? -1 : x->line > y->line;
}

static enum status check_doubled(struct reading *reading, int order) {
    const struct structure_terms *const terms = &reading->structure->terms[order];
    const size_t count = terms->count, beads = (size_t)mf_bonded_kinds[order]->beads;
    OWNED struct sorted_term *sorted = NULL;
    TRY_ARRAY(sorted, count);
    for (size_t n = 0; n < count; n++) {
        const uint32_t *const atom = terms->atom + n * beads;
        const bool turned = atom[0] > atom[beads - 1];
        sorted[n].type = terms->type[n];
        sorted[n].line = reading->terms->line[order][n];
        for (size_t k = 0; k < beads; k++)
            sorted[n].atom[k] = atom[turned ? beads - 1 - k : k];
    }
    qsort(sorted, count, sizeof *sorted, compare_terms);
    for (size_t n = 1; n < count; n++) {
        const bool same = memcmp(sorted[n].atom, sorted[n - 1].atom, sizeof sorted[n].atom) == 0 &&
                          (order == BONDED_BOND || sorted[n].type == sorted[n - 1].type);
        reading->line = sorted[n].line;
        if (same)
            return FAIL(reading, "the same %s as in line %zu", mf_bonded_kinds[order]->name,
                        sorted[n - 1].line);
    }
    return STATUS_OK;
}

enum status mf_lammps_terms_read(struct lammps_terms *terms, const struct structure *structure,
                                 const struct trajectory_frame *frame) {
    struct reading reading = {.terms = terms, .structure = structure, .frame = frame};
    *terms = (struct lammps_terms){0};
    TRY(mf_lammps_data_read(&reading.data, frame));
    TRY(check_known(&reading));
    for (int order = 0; order < BONDED_KINDS; order++)
        TRY(add_coefficients(&reading, order));
    for (int order = 0; order < BONDED_KINDS; order++) {
        TRY(add_terms(&reading, order));
        TRY(check_doubled(&reading, order));
    }
    return STATUS_OK;
}

void mf_lammps_terms_clear(struct lammps_terms *terms) {
    for (int order = 0; order < BONDED_KINDS; order++) {
        mf_memory_free(terms->line[order]);
        mf_memory_free(terms->coefficient[order]);
    }
    *terms = (struct lammps_terms){0};
}
