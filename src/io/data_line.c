// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/data_line.h"

#include <math.h>
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
