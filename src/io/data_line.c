// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/data_line.h"

#include "io/units_text.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char blanks[] = " \t\r\f\v";

struct data_line mf_data_line_first(const char *text) {
    return (struct data_line){text, text + strcspn(text, "\n"), 1};
}

bool mf_data_line_next(struct data_line *line) {
    if (*line->end == '\0')
        return false;
    const char *begin = line->end + 1;
    *line = (struct data_line){begin, begin + strcspn(begin, "\n"), line->number + 1};
    return true;
}

const char *mf_data_line_start(const struct data_line *line) {
    return line->begin + strspn(line->begin, blanks);
}

bool mf_data_line_is_comment(const struct data_line *line) {
    const char *word = mf_data_line_start(line);
    return word < line->end && strchr("#@%", *word) != NULL;
}

bool mf_data_line_is_data(const struct data_line *line) {
    return mf_data_line_start(line) < line->end && !mf_data_line_is_comment(line);
}

size_t mf_data_line_copy(const struct data_line *line, const char *begin, char *text) {
    size_t length = (size_t)(line->end - begin);
    while (length > 0 && strchr(blanks, begin[length - 1]))
        length--;
    memcpy(text, begin, length);
    text[length] = '\0';
    return length;
}

/// After a word in quotes, which may have any separator; `at` if none begins there.
static const char *after_quotes(const struct data_line *line, const char *at) {
    const char *close =
        at < line->end && *at == '"' ? memchr(at + 1, '"', (size_t)(line->end - at - 1)) : NULL;
    return close ? close + 1 : at;
}

/// The next place of `character` outside quotes, or NULL.
static const char *find_outside(const struct data_line *line, const char *at, char character) {
    for (; at < line->end; at++) {
        const char *past = after_quotes(line, at);
        at = past > at ? past - 1 : at;
        if (*at == character && past <= at)
            return at;
    }
    return NULL;
}

char mf_data_line_separator(const struct data_line *line) {
    if (find_outside(line, line->begin, ';'))
        return ';';
    if (find_outside(line, line->begin, ',') == NULL)
        return ' ';
    for (const char *at = mf_data_line_start(line); at < line->end; at++) {
        const char *past = after_quotes(line, at), *after = at + strspn(at, blanks);
        if (after > at && after < line->end && at[-1] != ',' && *after != ',')
            return ' ';
        at = past > at ? past - 1 : at;
    }
    return ',';
}

bool mf_data_line_may_have_commas(const struct data_line *line, char separator) {
    const char *start = mf_data_line_start(line);
    return separator == ';' ||
           (separator == ' ' && memchr(start, '\t', (size_t)(line->end - start)));
}

static struct data_word take_word(const struct data_line *line, char separator, const char *begin) {
    const char stop[] = {separator, '\n', '\0'};
    const char *quoted = after_quotes(line, begin);
    if (quoted > begin)
        return (struct data_word){begin + 1, (size_t)(quoted - begin - 2), quoted, true};
    size_t length = strcspn(begin, separator == ' ' ? " \t\r\f\v\n" : stop);
    if (begin + length > line->end)
        length = (size_t)(line->end - begin);
    while (length > 0 && strchr(blanks, begin[length - 1]))
        length--;
    return (struct data_word){begin, length, begin + length, false};
}

struct data_word mf_data_word_first(const struct data_line *line, char separator) {
    return take_word(line, separator, mf_data_line_start(line));
}

bool mf_data_word_next(const struct data_line *line, char separator, struct data_word *word) {
    const char *at = word->past + strspn(word->past, blanks);
    if (separator != ' ' && *at == separator)
        at += 1 + strspn(at + 1, blanks);
    *word = take_word(line, separator, at);
    // Empty cells at the end, as of ",,", are no words.
    const char more[] = {separator, ' ', '\t', '\r', '\0'};
    return at + strspn(at, more) < line->end;
}

size_t mf_data_word_count(const struct data_line *line, char separator) {
    struct data_word word = mf_data_word_first(line, separator);
    size_t count = 1;
    while (mf_data_word_next(line, separator, &word))
        count++;
    return count;
}

bool mf_data_word_is_number(const struct data_word *word, bool commas, char *decimal,
                            double *value) {
    enum { LONGEST = 400 }; // digits of any double, written out
    char text[LONGEST], *end;
    char mark = '\0';
    *value = NAN;
    if (word->length == 0 || word->length >= LONGEST)
        return false;
    memcpy(text, word->begin, word->length);
    text[word->length] = '\0';
    for (char *at = text; *at; at++) {
        if (*at != ',' && *at != '.')
            continue;
        if (*at == ',' && !(commas || word->quoted))
            return false;
        mark = *at;
        *at = '.';
    }
    if (mark && *decimal && mark != *decimal)
        return false;
    *value = strtod(text, &end);
    // strtod alone would take inf and 0x10.
    if (*end || !isfinite(*value) || text[strspn(text, "0123456789+-.eE")])
        return false;
    *decimal = mark ? mark : *decimal;
    return true;
}

bool mf_data_word_is_numeric(const struct data_word *word) {
    char *end;
    strtod(word->begin, &end);
    return word->length > 0 &&
           (strspn(word->begin, "0123456789+-.,") > 0 || end == word->begin + word->length);
}

// Names of columns, and their units, as people write them -----------------------------------------

enum { UNIT_SIZE = 64 };

/// Whether these characters are a unit other than that of a pure number.
static bool is_unit(const char *begin, size_t length) {
    struct units_text unit;
    char text[UNIT_SIZE];
    if (length == 0 || length >= sizeof text)
        return false;
    snprintf(text, sizeof text, "%.*s", (int)length, begin);
    return mf_units_text_parse(&unit, text, 0);
}

/// Without brackets or parentheses around it.
static struct data_word inside(struct data_word word) {
    const char open = word.length > 1 ? *word.begin : '\0';
    const char close = word.length > 1 ? word.begin[word.length - 1] : '\0';
    if ((open == '[' && close == ']') || (open == '(' && close == ')')) {
        word.begin++;
        word.length -= 2;
    }
    return word;
}

/// The line without the mark of a comment.
static struct data_line unmarked(struct data_line line) {
    if (line.begin && mf_data_line_is_comment(&line))
        line.begin = mf_data_line_start(&line) + 1;
    return line;
}

/// Names may have blanks where tabs part them.
static char separator_of(const struct data_line *line, char separator) {
    const char *start = mf_data_line_start(line);
    if (separator == ' ' && memchr(start, '\t', (size_t)(line->end - start)))
        return '\t';
    return separator;
}

/// Whether all words of a line are units or nothing, as below names.
static bool are_units(const struct data_line *line, char separator) {
    struct data_word word = mf_data_word_first(line, separator);
    bool all = true, any = false;
    do {
        const struct data_word text = inside(word);
        const bool named = is_unit(text.begin, text.length) &&
                           !(text.length == 1 && strchr("g1", *text.begin)),
                   none = text.length == 0 || (text.length == 1 && strchr("-1", *text.begin));
        all = all && (named || none);
        any = any || named;
    } while (mf_data_word_next(line, separator, &word));
    return all && any;
}

/// Put in the words of `line`, each with its word of `units`, if there is such a line.
static void write_names(const struct data_line *line, const struct data_line *units, char separator,
                        uint64_t label, char *heading) {
    struct data_word name = mf_data_word_first(line, separator), unit = {0};
    const char *const begin = heading;
    size_t column = 0;
    bool more = true;
    if (units)
        unit = mf_data_word_first(units, separator);
    for (; more; column++) {
        if (column >= DATA_HEADING_MAX || !(label >> column & 1)) {
            const struct data_word text = inside(unit);
            heading += sprintf(heading, "%s%.*s", heading > begin ? "\t" : "", (int)name.length,
                               name.begin);
            if (units && is_unit(text.begin, text.length))
                heading += sprintf(heading, "[%.*s]", (int)text.length, text.begin);
        }
        more = mf_data_word_next(line, separator, &name);
        if (units)
            mf_data_word_next(units, separator, &unit);
    }
}

/// Write units in parentheses, with or without a blank before them, in brackets.
static void bracket_units(char *heading) {
    for (char *open = strchr(heading, '('); open; open = strchr(open + 1, '(')) {
        const size_t length = strcspn(open + 1, "()");
        if (open[1 + length] != ')' || !is_unit(open + 1, length) ||
            (open[2 + length] && !strchr(" \t,;", open[2 + length])))
            continue;
        *open = '[';
        open[1 + length] = ']';
    }
}

/// Whether a unit of `length` bytes that ends with its name stands behind a name that is no unit,
/// as in "r/nm" but not in "kJ/mol".
static bool is_behind_name(const char *heading, const char *stroke, const char *unit,
                           size_t length) {
    const char *end = stroke;
    while (end > heading && end[-1] == ' ')
        end--;
    const char *name = end;
    while (name > heading && strchr(" \t,;", name[-1]) == NULL)
        name--;
    return end > name && !is_unit(name, (size_t)(end - name)) && is_unit(unit, length);
}

/// Write units after a stroke, "r/nm" and "Distance / Angstrom", in brackets.
static void bracket_strokes(char *heading) {
    const char *const ends = strpbrk(heading, "\t,;") ? "[(\t,;" : "[(\t,; ";
    for (char *at = heading; *(at += strcspn(at, "/[(")); at++) {
        const char *const unit = at + 1 + strspn(at + 1, " ");
        const size_t length = strcspn(unit, ends);
        if (*at != '/') {
            at += strcspn(at, "])");
            at -= *at == '\0';
        } else if (is_behind_name(heading, at, unit, length)) {
            const char *const rest = unit + length;
            *at = '[';
            memmove(at + 1, unit, length);
            memmove(at + 2 + length, rest, strlen(rest) + 1);
            at[1 + length] = ']';
            at += 1 + length;
        }
    }
}

/// Make one word of a name with blanks or marks in it, and of it and its unit.
static void join_words(char *heading) {
    bool unit = false;
    char *to = heading;
    for (const char *at = heading; *at; at++) {
        unit = *at == '[' || (unit && *at != ']');
        if (!unit && *at == ' ' && at[1] == '[')
            continue;
        *to++ = (char)(!unit && strchr(" ,;", *at) ? '_' : *at);
    }
    *to = '\0';
}

void mf_data_heading_make(const struct data_line *before, const struct data_line *last,
                          char separator, uint64_t label, size_t columns, char *heading) {
    *heading = '\0';
    if (last->begin == NULL)
        return;
    const struct data_line line = unmarked(*last), above = unmarked(*before);
    const char between = separator_of(&line, separator);
    const bool units = before->begin && are_units(&line, between) &&
                       mf_data_word_count(&above, between) >= mf_data_word_count(&line, between);
    const struct data_line *names = units ? &above : &line;
    const bool parted = mf_data_word_count(names, between) == columns;
    if (parted && (units || label || between != ' ')) {
        write_names(names, units ? &line : NULL, between, label, heading);
        bracket_units(heading);
        bracket_strokes(heading);
        join_words(heading);
    } else {
        mf_data_line_copy(names, mf_data_line_start(names), heading);
        bracket_units(heading);
        bracket_strokes(heading);
    }
}

// Tables of LAMMPS: rows that are numbered, after a line that says how many there are -------------

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
