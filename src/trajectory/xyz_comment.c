// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/xyz_comment.h"

#include <math.h>
#include <string.h>

enum { VALUE_SIZE = 1024, MAX_COLUMNS = 1000 };

/// Names of columns as ASE, OVITO, QUIP and LAMMPS write them; they may differ in case.
static const struct {
    const char *name;
    enum xyz_column column;
    int64_t width;
} known_columns[] = {
    {"species", XYZ_NAME, 1},      {"element", XYZ_NAME, 1},
    {"type", XYZ_NAME, 1},         {"pos", XYZ_POSITION, 3},
    {"position", XYZ_POSITION, 3}, {"positions", XYZ_POSITION, 3},
    {"velo", XYZ_VELOCITY, 3},     {"vel", XYZ_VELOCITY, 3},
    {"velocity", XYZ_VELOCITY, 3}, {"velocities", XYZ_VELOCITY, 3},
    {"momenta", XYZ_MOMENTUM, 3},  {"mass", XYZ_MASS, 1},
    {"masses", XYZ_MASS, 1},       {"id", XYZ_ID, 1},
    {"mol", XYZ_MOLECULE, 1},      {"molecule", XYZ_MOLECULE, 1},
    {"molid", XYZ_MOLECULE, 1},
};

/// Take the next key=value; a word without a value is one with an empty value.
static bool next_pair(const char **line, struct word *key, struct word *value) {
    const char *at = *line + strspn(*line, " \t");
    key->begin = at;
    at += strcspn(at, "= \t");
    key->length = (size_t)(at - key->begin);
    *value = (struct word){at, 0};
    if (*at == '=') {
        const char quote = at[1];
        const bool quoted = quote == '"' || quote == '\'';
        value->begin = at + 1 + quoted;
        value->length = strcspn(value->begin, quoted ? (char[]){quote, '\0'} : " \t");
        at = value->begin + value->length + (quoted && value->begin[value->length]);
    }
    *line = at;
    return key->length > 0 || value->length > 0 || *at != '\0';
}

static bool read_numbers(const struct word *value, double *numbers, size_t count) {
    char text[VALUE_SIZE];
    const char *rest = text;
    return mf_words_copy(value, text, sizeof text) && mf_words_numbers(&rest, numbers, count);
}

/// "T T F", with or without blanks between.
static bool read_periodic(const struct word *value, bool periodic[3]) {
    int d = 0;
    for (size_t k = 0; k < value->length; k++) {
        const char c = value->begin[k];
        if (c == 'T' || c == 't' || c == '1' || c == 'F' || c == 'f' || c == '0') {
            if (d < 3)
                periodic[d] = c == 'T' || c == 't' || c == '1';
            d++;
            while (k + 1 < value->length && value->begin[k + 1] >= 'a' &&
                   value->begin[k + 1] <= 'z')
                k++; // "True"
        }
    }
    return d == 3;
}

/// Up to the next colon.
static struct word take_part(const char **at, const char *end) {
    const char *begin = *at, *colon = memchr(begin, ':', (size_t)(end - begin));
    *at = colon ? colon + 1 : end;
    return (struct word){begin, (size_t)((colon ? colon : end) - begin)};
}

/// "species:S:1:pos:R:3": names, kinds and numbers of columns.
static bool read_properties(const struct word *value, struct xyz_comment *comment) {
    const char *at = value->begin, *const end = at + value->length;
    comment->columns = 0;
    for (int k = 0; k < XYZ_COLUMNS; k++)
        comment->column[k] = -1;
    while (at < end) {
        const struct word name = take_part(&at, end);
        take_part(&at, end); // the kind
        const struct word number = take_part(&at, end);
        int64_t width;
        if (!mf_words_integer(&number, &width) || width < 1 || width > MAX_COLUMNS)
            return false;
        for (size_t k = 0; k < sizeof known_columns / sizeof *known_columns; k++) {
            int *const column = &comment->column[known_columns[k].column];
            if (mf_words_alike(&name, known_columns[k].name) && width == known_columns[k].width &&
                *column < 0)
                *column = (int)comment->columns;
        }
        comment->columns += (size_t)width;
        if (comment->columns > MAX_COLUMNS)
            return false;
    }
    return comment->column[XYZ_POSITION] >= 0;
}

static const char *read_pair(struct xyz_comment *comment, const struct word *key,
                             const struct word *value) {
    double number;
    if (mf_words_alike(key, "Lattice"))
        return read_numbers(value, &comment->box[0][0], 9) ? NULL
                                                           : "expected nine numbers in Lattice";
    if (mf_words_alike(key, "Properties"))
        return read_properties(value, comment)
                   ? NULL
                   : "expected name:kind:number in Properties, including pos:R:3";
    if (mf_words_alike(key, "pbc"))
        return read_periodic(value, comment->periodic) ? NULL : "expected three of T and F in pbc";
    if (mf_words_alike(key, "Units"))
        return mf_words_copy(value, comment->units, sizeof comment->units) ? NULL
                                                                           : "Units is too long";
    if (mf_words_alike(key, "Time") && read_numbers(value, &number, 1))
        comment->time = number;
    if ((mf_words_alike(key, "Step") || mf_words_alike(key, "Timestep")) &&
        read_numbers(value, &number, 1) && fabs(number) < 9e15)
        comment->step = (int64_t)number;
    return NULL;
}

const char *mf_xyz_comment_read(struct xyz_comment *comment, const char *line) {
    struct word key, value;
    *comment = (struct xyz_comment){.periodic = {true, true, true},
                                    .time = NAN,
                                    .step = -1,
                                    .column = {0, 1, -1, -1, -1, -1, -1},
                                    .columns = 4};
    while (next_pair(&line, &key, &value)) {
        const char *const fault = read_pair(comment, &key, &value);
        if (fault)
            return fault;
    }
    return NULL;
}
