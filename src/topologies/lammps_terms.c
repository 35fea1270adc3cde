// SPDX-License-Identifier: GPL-3.0-or-later
#include "topologies/lammps_terms.h"

#include "base/memory.h"
#include "trajectory/lammps_data.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_WORDS = 16 };

enum section { HEADER, TERMS, COEFFICIENTS, OTHER };

/// LAMMPS begins the names of its sections with a capital letter.
#define SECTIONS(NAME, kind, ...)                                                                  \
    {#kind "s", TERMS, BONDED_##NAME}, {#kind " Coeffs", COEFFICIENTS, BONDED_##NAME},             \
        {#kind " Type Labels", OTHER, BONDED_##NAME},

/// Sections of data files; of what is OTHER nothing is taken here.
static const struct known {
    const char *name;
    enum section section;
    int order;
} sections[] = {
    BONDED_LIST(SECTIONS){"masses", OTHER, 0},
    {"atoms", OTHER, 0},
    {"atom Type Labels", OTHER, 0},
    {"velocities", OTHER, 0},
    {"pair Coeffs", OTHER, 0},
    {"pairIJ Coeffs", OTHER, 0},
};

struct reading {
    struct lammps_terms *terms;
    const struct structure *structure;
    const char *file;
    size_t line;
    const struct known *section;    ///< NULL: the header
    char style[TOPOLOGY_NAME_SIZE]; ///< of the section of coefficients, "" if it is not given
    int64_t promised[BONDED_KINDS];
};

struct words {
    struct word word[MAX_WORDS];
    int count; ///< all of them, of which MAX_WORDS are kept
};

static void split(const char *line, struct words *words) {
    struct word next;
    words->count = 0;
    while (mf_words_next(&line, &next) && next.begin[0] != '#') {
        if (words->count < MAX_WORDS)
            words->word[words->count] = next;
        words->count++;
    }
}

#define FAIL(reading, ...)                                                                         \
    mf_status_prefix(mf_status_fail(STATUS_BAD_INPUT, __VA_ARGS__), "%s:%zu", (reading)->file,     \
                     (reading)->line)

// Header ------------------------------------------------------------------------------------------

static bool is(const struct words *words, int k, const char *text) {
    return k < words->count && mf_words_same(&words->word[k], text);
}

void mf_lammps_terms_units(const char *text, char units[TOPOLOGY_NAME_SIZE]) {
    static const char key[] = "units = ";
    char title[512];
    units[0] = '\0';
    snprintf(title, sizeof title, "%.*s", (int)strcspn(text, "\n"), text);
    const char *at = strstr(title, key);
    if (at)
        snprintf(units, TOPOLOGY_NAME_SIZE, "%.*s", (int)strcspn(at + strlen(key), " ,\t\r"),
                 at + strlen(key));
}

/// "12 bonds", "2 bond types"; what we do not know must not be there.
static enum status read_header(struct reading *reading, const struct words *words) {
    static const char *const not_ours[] = {"impropers", "ellipsoids", "lines", "triangles",
                                           "bodies"};
    int64_t number;
    if (words->count < 2 || !mf_words_integer(&words->word[0], &number))
        return STATUS_OK; // bounds, which the trajectory's reader checks
    for (size_t k = 0; k < sizeof not_ours / sizeof *not_ours; k++)
        if (is(words, 1, not_ours[k]) && number != 0)
            return FAIL(reading, "%s are not known", not_ours[k]);
    for (int order = 0; order < BONDED_KINDS; order++) {
        const bool types = is(words, 1, mf_bonded_kinds[order]->name) && is(words, 2, "types");
        if (!types && !is(words, 1, mf_bonded_kinds[order]->plural))
            continue;
        if (number < 0 || number > (types ? LAMMPS_MAX_COEFFICIENTS : INT32_MAX))
            return FAIL(reading, "%lld %s%s cannot be", (long long)number, types ? "types of " : "",
                        mf_bonded_kinds[order]->plural);
        *(types ? &reading->terms->types[order] : &reading->promised[order]) = number;
    }
    return STATUS_OK;
}

/// A line that begins with a letter, with the style in its comment.
static enum status begin_section(struct reading *reading, const char *line,
                                 const struct words *words) {
    char name[TOPOLOGY_NAME_SIZE];
    const struct word *last = &words->word[words->count <= MAX_WORDS ? words->count - 1 : 0];
    snprintf(name, sizeof name, "%.*s", (int)(last->begin + last->length - words->word[0].begin),
             words->word[0].begin);
    const char *comment = strchr(line, '#');
    struct word style;
    reading->style[0] = '\0';
    if (comment++ && mf_words_next(&comment, &style))
        mf_words_copy(&style, reading->style, sizeof reading->style);
    for (size_t k = 0; k < sizeof sections / sizeof *sections; k++)
        if (name[0] == toupper((unsigned char)sections[k].name[0]) &&
            strcmp(sections[k].name + 1, name + 1) == 0) {
            reading->section = &sections[k];
            return STATUS_OK;
        }
    return FAIL(reading, "the section \"%s\" is not known", name);
}

// Sections ----------------------------------------------------------------------------------------

/// The next term of the structure, which stands in this line.
static enum status add_term(struct reading *reading) {
    struct lammps_terms *terms = reading->terms;
    const int order = reading->section->order, beads = mf_bonded_kinds[order]->beads;
    const struct structure_terms *const from = &reading->structure->terms[order];
    const size_t n = terms->terms[order]++;
    if (n >= from->count)
        return STATUS_OK; // more than the header says, which is told at the end
    if (terms->types[order] == 0)
        return FAIL(reading, "the header has no \"%s types\"", mf_bonded_kinds[order]->name);
    struct lammps_term *const term = &terms->term[order][n];
    *term = (struct lammps_term){.line = reading->line, .type = (int)from->type[n]};
    for (int k = 0; k < beads; k++)
        term->atom[k] = (int)from->atom[n * (size_t)beads + (size_t)k];
    return STATUS_OK;
}

/// The type of a line of coefficients, by its number or label; 0: there is none.
static size_t find_type(const struct reading *reading, const struct word *word) {
    const struct structure_terms *const of = &reading->structure->terms[reading->section->order];
    return mf_lammps_data_type(word, of->types, (const char(*)[STRUCTURE_NAME])of->name);
}

/// "1 30.0 1.5", in a section of several styles "1 harmonic 30.0 1.5".
static enum status add_coefficient(struct reading *reading, const struct words *words) {
    const int order = reading->section->order;
    struct lammps_terms *terms = reading->terms;
    const bool hybrid = strcmp(reading->style, "hybrid") == 0;
    const int first = hybrid ? 2 : 1;
    const size_t type = find_type(reading, &words->word[0]);
    if (reading->style[0] == '\0')
        return FAIL(reading, "unknown style: name it, as in \"%c%s # harmonic\"",
                    toupper((unsigned char)reading->section->name[0]), reading->section->name + 1);
    if (type == 0)
        return FAIL(reading, "expected a type from 1 to %lld and its coefficients",
                    (long long)terms->types[order]);
    struct lammps_coefficient *own = &terms->coefficient[order][type];
    if (own->line > 0)
        return FAIL(reading, "duplicate type %zu", type);
    *own = (struct lammps_coefficient){.line = reading->line, .count = words->count - first};
    if (own->count < 0 || own->count > LAMMPS_MAX_NUMBERS)
        return FAIL(reading, "no known style has %d numbers", own->count);
    if (!hybrid)
        memcpy(own->style, reading->style, sizeof own->style);
    else if (!mf_words_copy(&words->word[1], own->style, sizeof own->style))
        return FAIL(reading, "the style's name is too long");
    for (int n = 0; n < own->count; n++)
        if (!mf_words_number(&words->word[first + n], &own->number[n]))
            return FAIL(reading, "expected a number, found \"%.*s\"",
                        words_shown(&words->word[first + n]), words->word[first + n].begin);
    return STATUS_OK;
}

static enum status make_coefficients(struct reading *reading) {
    struct lammps_terms *terms = reading->terms;
    for (int order = 0; order < BONDED_KINDS; order++) {
        if (terms->coefficient[order] == NULL)
            TRY_ARRAY(terms->coefficient[order], terms->types[order] + 1);
        if (terms->term[order] == NULL)
            TRY_ARRAY(terms->term[order], reading->structure->terms[order].count);
    }
    return STATUS_OK;
}

/// Labels begin with letters as names of sections do, but in these there are no numbers.
static bool has_number(const struct words *words) {
    double number;
    for (int k = 0; k < words->count && k < MAX_WORDS; k++)
        if (mf_words_number(&words->word[k], &number))
            return true;
    return false;
}

static enum status read_line(struct reading *reading, const char *line) {
    struct words words;
    split(line, &words);
    if (words.count == 0)
        return STATUS_OK;
    if (isalpha((unsigned char)words.word[0].begin[0]) &&
        !(reading->section && has_number(&words))) {
        TRY(make_coefficients(reading)); // the header is over
        return begin_section(reading, line, &words);
    }
    if (reading->section == NULL)
        return read_header(reading, &words);
    if (reading->section->section == TERMS)
        return add_term(reading);
    return reading->section->section == COEFFICIENTS ? add_coefficient(reading, &words) : STATUS_OK;
}

// The whole ---------------------------------------------------------------------------------------

/// Terms of the same atoms follow each other, in either direction, and among angles and dihedrals
/// those of the same type.
static int compare_terms(const void *a, const void *b) {
    const struct lammps_term *x = a, *y = b;
    for (int k = 0; k < BONDED_MAX_TERM_BEADS; k++)
        if (x->atom[k] != y->atom[k])
            return x->atom[k] < y->atom[k] ? -1 : 1;
    if (x->type != y->type)
        return x->type < y->type ? -1 : 1;
    return x->line < y->line ? -1 : x->line > y->line;
}

static enum status check_doubled(struct reading *reading, int order) {
    const struct lammps_terms *terms = reading->terms;
    const size_t count = terms->terms[order];
    const int beads = mf_bonded_kinds[order]->beads;
    OWNED struct lammps_term *sorted = NULL;
    TRY_ARRAY(sorted, count);
    for (size_t n = 0; n < count; n++) {
        const struct lammps_term *from = &terms->term[order][n];
        const bool turned = from->atom[0] > from->atom[beads - 1];
        sorted[n] = *from;
        for (int k = 0; k < beads && turned; k++)
            sorted[n].atom[k] = from->atom[beads - 1 - k];
    }
    qsort(sorted, count, sizeof *sorted, compare_terms);
    for (size_t n = 1; n < count; n++) {
        const bool same = memcmp(sorted[n].atom, sorted[n - 1].atom, sizeof sorted[n].atom) == 0 &&
                          (order == BONDED_BOND || sorted[n].type == sorted[n - 1].type);
        reading->line = sorted[n].line;
        if (same)
            TRY(FAIL(reading, "the same %s as in line %zu", mf_bonded_kinds[order]->name,
                     sorted[n - 1].line));
    }
    return STATUS_OK;
}

static enum status check_whole(struct reading *reading) {
    const struct lammps_terms *terms = reading->terms;
    for (int order = 0; order < BONDED_KINDS; order++) {
        if ((int64_t)terms->terms[order] != reading->promised[order])
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: expected \"%lld %s\", found %zu: is the file complete?",
                                  reading->file, (long long)reading->promised[order],
                                  mf_bonded_kinds[order]->plural, terms->terms[order]);
        TRY(check_doubled(reading, order));
    }
    return STATUS_OK;
}

enum status mf_lammps_terms_read(struct lammps_terms *terms, const char *file, char *text,
                                 size_t length, const struct structure *structure) {
    struct reading reading = {.terms = terms, .structure = structure, .file = file};
    *terms = (struct lammps_terms){.terms = {0}};
    for (char *line = text; line < text + length;) {
        const size_t size = strcspn(line, "\n");
        line[size] = '\0';
        if (size > 0 && line[size - 1] == '\r')
            line[size - 1] = '\0';
        if (reading.line++ > 0) // the title says nothing
            TRY(read_line(&reading, line));
        line += size + 1;
    }
    TRY(make_coefficients(&reading));
    return check_whole(&reading);
}

void mf_lammps_terms_clear(struct lammps_terms *terms) {
    for (int order = 0; order < BONDED_KINDS; order++) {
        mf_memory_free(terms->term[order]);
        mf_memory_free(terms->coefficient[order]);
    }
    *terms = (struct lammps_terms){.terms = {0}};
}
