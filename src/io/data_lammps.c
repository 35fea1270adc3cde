// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/data_lammps.h"

#include "io/data_line.h"

#include <string.h>

/// Next line that is neither empty nor a comment.
static bool next_data(struct data_line *line) {
    while (mf_data_line_next(line))
        if (mf_data_line_is_data(line))
            return true;
    return false;
}

/// A whole number above 0; 0 if it is none.
static size_t whole(const struct data_word *word) {
    enum { MOST_DIGITS = 15 };
    size_t number = 0;
    for (size_t k = 0; k < word->length; k++) {
        if (word->begin[k] < '0' || word->begin[k] > '9' || k == MOST_DIGITS)
            return 0;
        number = 10 * number + (size_t)(word->begin[k] - '0');
    }
    return number;
}

/// What begins in a line, and with how many rows.
static enum data_lammps_kind find_head(const struct data_line *line, size_t *rows) {
    const struct data_word first = mf_data_word_first(line, ' ');
    const size_t words = mf_data_word_count(line, ' ');
    const bool law = first.length == 1 && *first.begin == 'N';
    struct data_word word = first;
    if (words < 2 || !mf_data_word_next(line, ' ', &word) || (*rows = whole(&word)) == 0)
        return DATA_LAMMPS_NONE;
    if (law)
        return DATA_LAMMPS_LAW;
    return words == 2 && (whole(&first) > 0 || (first.length == 1 && *first.begin == '0'))
               ? DATA_LAMMPS_AVERAGE
               : DATA_LAMMPS_NONE;
}

/// Whether so many numbered rows of three words or more follow; the last of them is then `line`.
static bool are_numbered(struct data_line *line, size_t rows) {
    enum { FEWEST_WORDS = 3 };
    for (size_t k = 1; k <= rows; k++) {
        if (!next_data(line) || mf_data_word_count(line, ' ') < FEWEST_WORDS)
            return false;
        const struct data_word word = mf_data_word_first(line, ' ');
        if (whole(&word) != k)
            return false;
    }
    return true;
}

static void blank(char *text, const char *begin, const char *end) {
    memset(text + (begin - text), ' ', (size_t)(end - begin));
}

enum data_lammps_kind mf_data_lammps_strip(char *text, size_t *again) {
    struct data_line line = mf_data_line_first(text);
    enum data_lammps_kind kind = DATA_LAMMPS_NONE;
    size_t rows = 0;
    bool more = mf_data_line_is_data(&line) || next_data(&line);
    *again = 0;
    // Before the line of a law are words, and nothing before that of an average.
    while (more && (kind = find_head(&line, &rows)) == DATA_LAMMPS_NONE) {
        const struct data_word word = mf_data_word_first(&line, ' ');
        more = !mf_data_word_is_numeric(&word) && next_data(&line);
    }
    const struct data_line head = line;
    struct data_line last = line;
    if (!more || !are_numbered(&last, rows))
        return DATA_LAMMPS_NONE;
    if (kind == DATA_LAMMPS_AVERAGE)
        blank(text, head.begin, head.end);
    for (size_t k = 0; k < rows && next_data(&line); k++) {
        const struct data_word word = mf_data_word_first(&line, ' ');
        blank(text, word.begin, word.begin + word.length);
    }
    if (next_data(&last))
        *again = last.number;
    return kind;
}
