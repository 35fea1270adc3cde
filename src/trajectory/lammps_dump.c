// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/lammps_dump.h"

#include <math.h>
#include <string.h>

static const char *const column_name[LAMMPS_COLUMNS] = {
    "id", "type", "mol", "element", "typelabel", "mass", "x",   "y",   "z",
    "xs", "ys",   "zs",  "xu",      "yu",        "zu",   "xsu", "ysu", "zsu",
    "ix", "iy",   "iz",  "vx",      "vy",        "vz",   "fx",  "fy",  "fz",
};

/// What follows "ITEM: …", or NULL.
static const char *after(const char *line, const char *item) {
    const size_t length = strlen(item);
    return strncmp(line, item, length) == 0 ? line + length : NULL;
}

static bool read_number(const char *line, double *value) {
    return mf_words_numbers(&line, value, 1);
}

static bool read_integer(const char *line, int64_t *value) {
    struct word word;
    return mf_words_next(&line, &word) && mf_words_integer(&word, value);
}

static double min(const double *values, int count) {
    double found = 0;
    for (int k = 0; k < count; k++)
        found = fmin(found, values[k]);
    return found;
}

static double max(const double *values, int count) {
    double found = 0;
    for (int k = 0; k < count; k++)
        found = fmax(found, values[k]);
    return found;
}

/// Bounds of a tilted box are those of the upright one around it: manual, "Triclinic simulation
/// boxes".
static void set_tilted(struct lammps_dump *dump, double v[3][4]) {
    const double xy = v[0][2], xz = v[1][2], yz = v[2][2];
    const double shifts[] = {xy, xz, xy + xz};
    v[0][0] -= min(shifts, 3), v[0][1] -= max(shifts, 3);
    v[1][0] -= min(&yz, 1), v[1][1] -= max(&yz, 1);
    dump->box[1][0] = xy, dump->box[2][0] = xz, dump->box[2][1] = yz;
}

/// "xy xz yz pp pp ff", "abc origin pp pp pp" or "pp pp pp", and three lines of numbers.
static enum status read_box(struct lammps_dump *dump, const struct trajectory_frame *frame,
                            const char *line, const char *words) {
    const bool tilted = strstr(words, "xy xz yz"), vectors = strstr(words, "abc origin");
    const char *flags = words, *at = line;
    double v[3][4] = {{0}};
    struct word word;
    for (int d = 0; d < 3; d++)
        dump->periodic[d] = true; // unless a flag says otherwise
    for (int d = 0; mf_words_next(&flags, &word) && d < 3;)
        if (word.length == 2 && strchr("pfsm", word.begin[0]))
            dump->periodic[d++] = word.begin[0] == 'p';
    for (int d = 0; d < 3; d++) {
        const char *rest = at = mf_frame_next_line(frame, at);
        if (rest == NULL || !mf_words_numbers(&rest, v[d], vectors ? 4 : tilted ? 3 : 2))
            return mf_frame_fail_line(frame, at ? at : line, "expected the bounds of the box%s",
                                      at ? mf_words_number_hint(at) : "");
    }
    if (tilted)
        set_tilted(dump, v);
    for (int d = 0; d < 3; d++) {
        if (vectors)
            memcpy(dump->box[d], v[d], sizeof dump->box[d]);
        else
            dump->box[d][d] = v[d][1] - v[d][0];
        dump->origin[d] = v[d][vectors ? 3 : 0];
    }
    return STATUS_OK;
}

static enum status read_columns(struct lammps_dump *dump, const struct trajectory_frame *frame,
                                const char *words) {
    struct word word;
    const char *rest = words;
    for (int k = 0; k < LAMMPS_COLUMNS; k++)
        dump->column[k] = -1;
    for (; mf_words_next(&rest, &word); dump->columns++)
        for (int k = 0; k < LAMMPS_COLUMNS; k++)
            if (mf_words_same(&word, column_name[k]) && dump->column[k] < 0)
                dump->column[k] = (int)dump->columns;
    if (dump->columns > LAMMPS_MAX_COLUMNS)
        return mf_frame_fail_line(frame, words, "more than %d columns", LAMMPS_MAX_COLUMNS);
    return STATUS_OK;
}

/// What our files have behind "ITEM: NUMBER OF ATOMS".
static void read_notes(struct lammps_dump *dump, const char *words) {
    struct word word;
    while (mf_words_next(&words, &word)) {
        const char *const units = after(word.begin, "units="), *const time =
                                                                   after(word.begin, "time=");
        if (units)
            dump->units = units;
        else if (time)
            (void)read_number(time, &dump->time);
    }
}

/// Take one item; `*line` becomes the last of its lines.
static enum status read_item(struct lammps_dump *dump, const struct trajectory_frame *frame,
                             const char **line) {
    const char *words, *const value = mf_frame_next_line(frame, *line);
    const char *const begin = *line;
    int64_t count;
    *line = value;
    if (value == NULL)
        return mf_frame_fail_line(frame, begin, "nothing follows this item");
    if ((words = after(begin, "ITEM: BOX BOUNDS"))) {
        *line = mf_frame_next_line(frame, mf_frame_next_line(frame, value));
        return read_box(dump, frame, begin, words);
    }
    if ((words = after(begin, "ITEM: NUMBER OF ATOMS")))
        read_notes(dump, words);
    if (after(begin, "ITEM: UNITS"))
        dump->units = value;
    else if (after(begin, "ITEM: TIMESTEP") && !read_integer(value, &dump->step))
        return mf_frame_fail_line(frame, value, "expected the time step");
    else if (after(begin, "ITEM: TIME") && !after(begin, "ITEM: TIMESTEP") &&
             !read_number(value, &dump->time))
        return mf_frame_fail_line(frame, value, "expected the time");
    else if (after(begin, "ITEM: NUMBER OF ATOMS") && read_integer(value, &count))
        dump->atoms = (size_t)count;
    return STATUS_OK;
}

/// "dump_modify types labels" writes labels in the column of types. None begins as a number.
static void find_labels(struct lammps_dump *dump, const char *line) {
    const int column = dump->column[LAMMPS_TYPE];
    struct word word = {0};
    int64_t number;
    if (line == NULL || column < 0 || dump->column[LAMMPS_LABEL] >= 0)
        return;
    for (int k = 0; k <= column; k++)
        if (!mf_words_next(&line, &word))
            return;
    if (mf_words_integer(&word, &number))
        return;
    dump->column[LAMMPS_LABEL] = column;
    dump->column[LAMMPS_TYPE] = -1;
}

enum status mf_lammps_dump_read(struct lammps_dump *dump, const struct trajectory_frame *frame) {
    const char *line = (const char *)frame->raw.data, *words = NULL;
    *dump = (struct lammps_dump){.time = NAN, .step = -1};
    for (; line && (words = after(line, "ITEM: ATOMS")) == NULL;
         line = line ? mf_frame_next_line(frame, line) : NULL)
        TRY(read_item(dump, frame, &line));
    if (line == NULL)
        return mf_frame_fail_line(frame, (const char *)frame->raw.data, "the frame has no atoms");
    dump->first = mf_frame_next_line(frame, line);
    TRY(read_columns(dump, frame, words));
    find_labels(dump, dump->first);
    return STATUS_OK;
}

enum status mf_lammps_dump_split(const struct lammps_dump *dump,
                                 const struct trajectory_frame *frame, const char *line,
                                 struct word word[LAMMPS_MAX_COLUMNS]) {
    const char *rest = line;
    for (size_t k = 0; k < dump->columns; k++)
        if (!mf_words_next(&rest, &word[k]))
            return mf_frame_fail_line(frame, line, "%zu columns, expected %zu", k, dump->columns);
    const size_t more = mf_words_count(rest);
    if (more > 0)
        return mf_frame_fail_line(frame, line, "%zu columns, expected %zu", dump->columns + more,
                                  dump->columns);
    return STATUS_OK;
}
