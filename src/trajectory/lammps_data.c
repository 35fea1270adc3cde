// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/lammps_data.h"

#include <ctype.h>
#include <string.h>

enum { ATOMIC, CHARGE, MOLECULAR, FULL, STYLES };

static const struct lammps_style styles[STYLES] = {
    [ATOMIC] = {"atomic", -1, 1, -1, 2},
    [CHARGE] = {"charge", -1, 1, 2, 3},
    [MOLECULAR] = {"molecular", 1, 2, -1, 3},
    [FULL] = {"full", 1, 2, 3, 4},
};

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

/// "0 10 xlo xhi" and its like.
static bool read_bounds(struct lammps_data *data, const struct word *word, size_t count, int d) {
    static const char *const low[] = {"xlo", "ylo", "zlo"};
    double begin, end;
    if (!is_word(word, count, 2, low[d]))
        return true;
    data->is_text |= d == 0;
    if (!mf_words_number(&word[0], &begin) || !mf_words_number(&word[1], &end))
        return false;
    data->origin[d] = begin;
    data->box[d][d] = end - begin;
    return true;
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
    for (int d = 0; d < 3 && good; d++)
        good = read_bounds(data, word, count, d);
    return good ? STATUS_OK : mf_frame_fail_line(frame, line, "expected numbers in this line");
}

/// Remember where a section begins: at the first line that is not empty.
static void read_heading(struct lammps_data *data, const struct trajectory_frame *frame,
                         const char *line) {
    struct word word[LAMMPS_DATA_WORDS];
    const size_t count = mf_lammps_data_split(line, word);
    const char *first = line, *comment = strchr(line, '#');
    do
        first = mf_frame_next_line(frame, first);
    while (first && mf_words_count(first) == 0);
    if (count != 1)
        return;
    if (mf_words_same(&word[0], "Masses"))
        data->masses = first;
    else if (mf_words_same(&word[0], "Velocities"))
        data->velocities = first;
    else if (mf_words_same(&word[0], "Atoms")) {
        data->atom = first;
        if (comment++ && mf_words_next(&comment, &word[0]))
            mf_words_copy(&word[0], data->style, sizeof data->style);
    }
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

/// Whether each of the atoms has a whole number as its third word: a type then, and no charge.
static bool is_third_whole(const struct lammps_data *data, const struct trajectory_frame *frame) {
    struct word word[LAMMPS_DATA_WORDS];
    int64_t number;
    const char *line = data->atom;
    for (size_t k = 0; line && k < data->atoms; k++, line = mf_frame_next_line(frame, line))
        if (mf_lammps_data_split(line, word) < 3 || !mf_words_integer(&word[2], &number) ||
            number < 1 || (size_t)number > data->types)
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
        *style = &styles[is_third_whole(data, frame) ? MOLECULAR : CHARGE];
    else if (count == 7 || count == 10)
        *style = &styles[FULL];
    else
        return mf_frame_fail_line(
            frame, data->atom,
            "no atom style has %zu columns; name the style, as in \"Atoms # full\"", count);
    return STATUS_OK;
}
