// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/words.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static bool is_blank(char c) {
    return c == ' ' || c == '\t';
}

bool mf_words_next(const char **line, struct word *word) {
    const char *at = *line;
    while (is_blank(*at))
        at++;
    word->begin = at;
    while (*at && !is_blank(*at))
        at++;
    word->length = (size_t)(at - word->begin);
    *line = at;
    return word->length > 0;
}

size_t mf_words_count(const char *line) {
    struct word word;
    size_t count = 0;
    while (mf_words_next(&line, &word))
        count++;
    return count;
}

struct word mf_words_columns(const char *line, size_t first, size_t count) {
    const size_t length = strnlen(line, first + count);
    size_t begin = first < length ? first : length, end = length;
    while (begin < end && is_blank(line[begin]))
        begin++;
    while (end > begin && is_blank(line[end - 1]))
        end--;
    return (struct word){line + begin, end - begin};
}

bool mf_words_same(const struct word *word, const char *text) {
    return strlen(text) == word->length && memcmp(word->begin, text, word->length) == 0;
}

bool mf_words_alike(const struct word *word, const char *text) {
    return strlen(text) == word->length && strncasecmp(word->begin, text, word->length) == 0;
}

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// By the library, for numbers of many digits or with an exponent.
static bool long_number(const struct word *word, double *value) {
    char text[128], *end;
    if (!mf_words_copy(word, text, sizeof text) || strspn(text, "0123456789+-.eE") != word->length)
        return false;
    *value = strtod(text, &end);
    return *end == '\0' && isfinite(*value);
}

/// A mantissa below 2^53 and a power of ten up to 10^22 are exact, so one division gives the
/// nearest double: W. D. Clinger, Proc. PLDI '90, 92 (1990).
bool mf_words_number(const struct word *word, double *value) {
    static const double power[] = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                   1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
    enum { MAX_DIGITS = 15 };
    const char *at = word->begin, *const end = at + word->length;
    const bool negative = at < end && *at == '-';
    uint64_t mantissa = 0;
    size_t digits = 0, decimals = 0;
    if (at < end && (*at == '-' || *at == '+'))
        at++;
    if (end - at > MAX_DIGITS + 1)
        return long_number(word, value);
    for (; at < end && is_digit(*at); at++, digits++)
        mantissa = 10 * mantissa + (uint64_t)(*at - '0');
    if (at < end && *at == '.')
        for (at++; at < end && is_digit(*at); at++, digits++, decimals++)
            mantissa = 10 * mantissa + (uint64_t)(*at - '0');
    if (at < end || digits > MAX_DIGITS)
        return long_number(word, value);
    const double size = (double)mantissa / power[decimals];
    *value = negative ? -size : size;
    return digits > 0;
}

const char *mf_words_number_hint(const char *line) {
    return strchr(line, ',') ? ": a decimal comma?" : "";
}

bool mf_words_integer(const struct word *word, int64_t *value) {
    const char *at = word->begin, *const end = at + word->length;
    const bool negative = at < end && *at == '-';
    if (at < end && (*at == '-' || *at == '+'))
        at++;
    if (at == end || end - at > 18)
        return false;
    int64_t size = 0;
    for (; at < end; at++) {
        if (!is_digit(*at))
            return false;
        size = 10 * size + (*at - '0');
    }
    *value = negative ? -size : size;
    return true;
}

bool mf_words_numbers(const char **line, double *values, size_t count) {
    struct word word;
    for (size_t k = 0; k < count; k++)
        if (!mf_words_next(line, &word) || !mf_words_number(&word, &values[k]))
            return false;
    return true;
}

bool mf_words_copy(const struct word *word, char *text, size_t size) {
    if (word->length >= size)
        return false;
    memcpy(text, word->begin, word->length);
    text[word->length] = '\0';
    return true;
}

bool mf_words_line(const unsigned char *begin, size_t bytes, size_t number, char *line,
                   size_t size) {
    const unsigned char *const end = begin + bytes;
    for (; number > 0; number--) {
        const unsigned char *newline = memchr(begin, '\n', (size_t)(end - begin));
        if (newline == NULL)
            return false;
        begin = newline + 1;
    }
    const unsigned char *newline = memchr(begin, '\n', (size_t)(end - begin));
    size_t length = (size_t)((newline ? newline : end) - begin);
    if (length > 0 && begin[length - 1] == '\r')
        length--;
    if (length >= size)
        length = size - 1;
    memcpy(line, begin, length);
    line[length] = '\0';
    return begin < end;
}
