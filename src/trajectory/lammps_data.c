// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/lammps_data.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { ATOMIC, CHARGE, MOLECULAR, FULL, STYLES };

static const struct lammps_style styles[STYLES] = {
    [ATOMIC] = {"atomic", -1, 1, -1, 2},
    [CHARGE] = {"charge", -1, 1, 2, 3},
    [MOLECULAR] = {"molecular", 1, 2, -1, 3},
    [FULL] = {"full", 1, 2, 3, 4},
};

static const char *const kinds[STRUCTURE_TERM_KINDS] = {"bond", "angle", "dihedral"};

size_t mf_lammps_data_split(const char *line, struct word word[LAMMPS_DATA_WORDS]) {
    struct word next;
    size_t count = 0;
    while (mf_words_next(&line, &next) && next.begin[0] != '#') {
        if (count < LAMMPS_DATA_WORDS)
            word[count] = next;
        count++;
    }
    return count;
}

static bool is_word(const struct word *word, size_t count, size_t k, const char *text) {
    return k < count && mf_words_same(&word[k], text);
}

/// The word after `key` in a title, without a comma, such as "units = real" or "timestep = 0".
static void read_title_word(const char *line, const char *key, char *text, size_t size) {
    const char *at = strstr(line, key);
    struct word word;
    text[0] = '\0';
    if (at == NULL)
        return;
    at += strlen(key);
    if (!mf_words_next(&at, &word))
        return;
    if (word.begin[word.length - 1] == ',')
        word.length--;
    mf_words_copy(&word, text, size);
}

static void read_title(struct lammps_data *data, const char *line) {
    char step[32];
    read_title_word(line, "units = ", data->units, sizeof data->units);
    read_title_word(line, "timestep = ", step, sizeof step);
    const struct word word = {step, strlen(step)};
    if (!mf_words_integer(&word, &data->step))
        data->step = -1;
}

/// "0 10 xlo xhi" and its like, or, of a general triclinic box, "10 0 1 avec".
static bool read_bounds(struct lammps_data *data, const struct word *word, size_t count, int d) {
    static const char *const low[] = {"xlo", "ylo", "zlo"};
    static const char *const vector[] = {"avec", "bvec", "cvec"};
    double begin, end;
    if (is_word(word, count, 3, vector[d])) {
        data->is_text |= d == 0;
        for (int k = 0; k < 3; k++)
            if (!mf_words_number(&word[k], &data->box[d][k]))
                return false;
        return true;
    }
    if (!is_word(word, count, 2, low[d]))
        return true;
    data->is_text |= d == 0;
    if (!mf_words_number(&word[0], &begin) || !mf_words_number(&word[1], &end))
        return false;
    data->origin[d] = begin;
    data->box[d][d] = end - begin;
    return true;
}

/// "12 bonds" and "2 bond types" of one of the kinds of terms.
static bool read_counts(const struct word *word, size_t count, const char *kind,
                        struct lammps_data_terms *terms) {
    char plural[16];
    int64_t number = 0;
    snprintf(plural, sizeof plural, "%ss", kind);
    const bool types = is_word(word, count, 1, kind) && is_word(word, count, 2, "types");
    if (!types && !is_word(word, count, 1, plural))
        return true;
    if (!mf_words_integer(&word[0], &number) || number < 0 ||
        (types && number > LAMMPS_DATA_MAX_TYPES))
        return false;
    *(types ? &terms->types : &terms->count) = (size_t)number;
    return true;
}

/// "12 impropers": what is more than none of what nobody here reads.
static bool is_foreign(const struct word *word, size_t count) {
    static const char *const names[] = {"impropers", "ellipsoids", "lines", "triangles", "bodies"};
    int64_t number;
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (is_word(word, count, 1, names[k]))
            return mf_words_integer(&word[0], &number) && number != 0;
    return false;
}

static enum status read_header_line(struct lammps_data *data, const struct trajectory_frame *frame,
                                    const char *line) {
    struct word word[LAMMPS_DATA_WORDS];
    const size_t count = mf_lammps_data_split(line, word);
    int64_t number = 0;
    bool good = true;
    if (is_word(word, count, 1, "atoms")) {
        good = mf_words_integer(&word[0], &number) && number > 0;
        data->atoms = (size_t)number;
    } else if (is_word(word, count, 1, "atom") && is_word(word, count, 2, "types")) {
        good = mf_words_integer(&word[0], &number) && number > 0 && number <= LAMMPS_DATA_MAX_TYPES;
        data->types = (size_t)number;
    } else if (is_word(word, count, 3, "xy")) {
        good = mf_words_number(&word[0], &data->box[1][0]) &&
               mf_words_number(&word[1], &data->box[2][0]) &&
               mf_words_number(&word[2], &data->box[2][1]);
    }
    if (data->foreign == NULL && is_foreign(word, count))
        data->foreign = line;
    for (int d = 0; d < 3 && good; d++)
        good = read_bounds(data, word, count, d);
    for (int kind = 0; kind < STRUCTURE_TERM_KINDS && good; kind++)
        good = read_counts(word, count, kinds[kind], &data->terms[kind]);
    return good ? STATUS_OK : mf_frame_fail_line(frame, line, "expected numbers in this line");
}

/// Whether a heading is a name in lower case, with its first letter as a capital, and more words.
static bool is_heading(const struct word *word, size_t count, const char *name, const char *more) {
    char text[32];
    snprintf(text, sizeof text, "%c%s%s", toupper((unsigned char)name[0]), name + 1, more);
    return strncmp(word[0].begin, text, strlen(text)) == 0 &&
           word[0].begin + strlen(text) == word[count - 1].begin + word[count - 1].length;
}

/// Where the first line of a section is kept; NULL: nothing is read of it. `*style` is where its
/// comment is kept, or stays as it is.
static const char **find_section(struct lammps_data *data, const struct word *word, size_t count,
                                 char **style) {
    for (int k = 0; k < STRUCTURE_TERM_KINDS; k++) {
        if (is_heading(word, count, kinds[k], " Coeffs")) {
            *style = data->terms[k].style;
            return &data->terms[k].coefficients;
        }
        if (is_heading(word, count, kinds[k], "s"))
            return &data->terms[k].first;
        if (is_heading(word, count, kinds[k], " Type Labels"))
            return &data->terms[k].labels;
    }
    if (is_heading(word, count, "atom", " Type Labels"))
        return &data->labels;
    if (is_heading(word, count, "atoms", ""))
        *style = data->style;
    return is_heading(word, count, "masses", "")       ? &data->masses
           : is_heading(word, count, "velocities", "") ? &data->velocities
           : is_heading(word, count, "atoms", "")      ? &data->atom
           : is_heading(word, count, "types", "")      ? &data->kinds
                                                       : NULL;
}

/// Coefficients of pairs, which are known and not read.
static bool is_of_pairs(const struct word *word, size_t count) {
    return is_heading(word, count, "pair", " Coeffs") ||
           is_heading(word, count, "pairIJ", " Coeffs");
}

bool mf_lammps_data_is_labelled(const struct word *word, size_t count) {
    double number;
    for (size_t k = 0; k < count && k < LAMMPS_DATA_WORDS; k++)
        if (mf_words_number(&word[k], &number))
            return true;
    return false;
}

/// Remember where a section begins: at the first line that is not empty.
static void read_heading(struct lammps_data *data, const struct trajectory_frame *frame,
                         const char *line) {
    enum { LONGEST = 3 };
    struct word word[LAMMPS_DATA_WORDS];
    const size_t count = mf_lammps_data_split(line, word);
    const char *comment = strchr(line, '#');
    char *style = NULL;
    const bool named = count > 0 && count <= LONGEST;
    const char **const section = named ? find_section(data, word, count, &style) : NULL;
    if (section == NULL) {
        if (data->unknown == NULL && count > 0 && !(named && is_of_pairs(word, count)) &&
            !mf_lammps_data_is_labelled(word, count))
            data->unknown = line;
        return;
    }
    *section = line;
    do
        *section = mf_frame_next_line(frame, *section);
    while (*section && mf_words_count(*section) == 0);
    if (style && comment && *comment++ && mf_words_next(&comment, &word[0]))
        mf_words_copy(&word[0], style, sizeof data->style);
}

/// The header ends with the first line that begins with a letter.
enum status mf_lammps_data_read(struct lammps_data *data, const struct trajectory_frame *frame) {
    const char *line = (const char *)frame->raw.data;
    bool in_header = true;
    *data = (struct lammps_data){.step = -1};
    read_title(data, line);
    while ((line = mf_frame_next_line(frame, line))) {
        const char *const first = line + strspn(line, " \t");
        const bool heading = isalpha((unsigned char)*first);
        in_header = in_header && !heading;
        if (in_header)
            TRY(read_header_line(data, frame, line));
        else if (heading)
            read_heading(data, frame, line);
    }
    data->is_text = data->is_text && data->atoms > 0;
    return STATUS_OK;
}

enum status mf_lammps_data_names(const struct trajectory_frame *frame, const char *labels,
                                 size_t types, char (*name)[STRUCTURE_NAME]) {
    struct word word[LAMMPS_DATA_WORDS];
    int64_t type;
    for (size_t k = 1; k <= types; k++)
        snprintf(name[k], STRUCTURE_NAME, "%u", (unsigned)k);
    for (size_t k = 0; labels && k < types; k++, labels = mf_frame_next_line(frame, labels))
        if (mf_lammps_data_split(labels, word) != 2 || !mf_words_integer(&word[0], &type) ||
            type < 1 || (size_t)type > types ||
            !mf_words_copy(&word[1], name[type], STRUCTURE_NAME))
            return mf_frame_fail_line(frame, labels,
                                      "expected a type from 1 to %zu and its label, of up to %d "
                                      "characters",
                                      types, STRUCTURE_NAME - 1);
    return STATUS_OK;
}

size_t mf_lammps_data_type(const struct word *word, size_t types,
                           const char (*name)[STRUCTURE_NAME]) {
    int64_t number;
    if (mf_words_integer(word, &number))
        return number >= 1 && (uint64_t)number <= types ? (size_t)number : 0;
    for (size_t k = 1; k <= types; k++)
        if (mf_words_same(word, name[k]))
            return k;
    return 0;
}

/// Whether each of the atoms has a type as its third word, a whole number or a label, and no
/// charge.
static bool is_third_type(const struct lammps_data *data, const struct trajectory_frame *frame) {
    struct word word[LAMMPS_DATA_WORDS];
    int64_t number;
    double charge;
    const char *line = data->atom;
    for (size_t k = 0; line && k < data->atoms; k++, line = mf_frame_next_line(frame, line))
        if (mf_lammps_data_split(line, word) < 3 ||
            (mf_words_integer(&word[2], &number) ? number < 1 || (size_t)number > data->types
                                                 : mf_words_number(&word[2], &charge)))
            return false;
    return true;
}

/// A comment after "Atoms" is the style that LAMMPS writes there, or any words of a person.
static bool is_style(const char *word) {
    static const char *const all[] = {
        "amoeba",       "body",   "dielectric", "dipole",    "dpd",   "edpd", "electron",
        "ellipsoid",    "hybrid", "line",       "mdpd",      "oxdna", "peri", "rheo",
        "rheo/thermal", "smd",    "sph",        "sphere",    "spin",  "tdpd", "template",
        "tri",          "apip",   "wavepacket", "bpm/sphere"};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        if (strcmp(word, all[k]) == 0)
            return true;
    return false;
}

enum status mf_lammps_data_style(const struct lammps_data *data,
                                 const struct trajectory_frame *frame,
                                 const struct lammps_style **style) {
    struct word word[LAMMPS_DATA_WORDS];
    *style = NULL;
    for (int k = 0; k < STYLES; k++)
        if (strcmp(data->style, styles[k].name) == 0)
            *style = &styles[k];
    if (strcmp(data->style, "bond") == 0 || strcmp(data->style, "angle") == 0)
        *style = &styles[MOLECULAR];
    if (*style)
        return STATUS_OK;
    if (is_style(data->style))
        return mf_frame_fail_line(frame, data->atom,
                                  "the atom style \"%s\" is not read; known: "
                                  "atomic, charge, bond, angle, molecular, full",
                                  data->style);
    const size_t count = mf_lammps_data_split(data->atom, word);
    if (count == 5 || count == 8)
        *style = &styles[ATOMIC];
    else if (count == 6 || count == 9)
        *style = &styles[is_third_type(data, frame) ? MOLECULAR : CHARGE];
    else if (count == 7 || count == 10)
        *style = &styles[FULL];
    else
        return mf_frame_fail_line(
            frame, data->atom,
            "no atom style has %zu columns; name the style, as in \"Atoms # full\"", count);
    return STATUS_OK;
}
