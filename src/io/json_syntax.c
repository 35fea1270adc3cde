// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/json_syntax.h"

#include "io/text_file.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    DEEPEST_NESTING = 64, ///< run files need 6; the checker and cJSON recurse
    LONGEST_NUMBER = 60,  ///< cJSON reads at most 63 characters of a number
};

struct checker {
    const char *file, *text, *at;
    int depth;
};

static enum status check_value(struct checker *checker);

static enum status expected(const struct checker *checker, const char *what) {
    const struct text_place place = mf_text_file_place(checker->text, checker->at);
    const unsigned char c = (unsigned char)*checker->at;
    char found[32];
    if (c == '\0')
        snprintf(found, sizeof found, "the end of the file");
    else if (c == '\n' || c == '\r')
        snprintf(found, sizeof found, "the end of the line");
    else if (c == '/' || c == '#')
        snprintf(found, sizeof found, "'%c' (JSON has no comments)", c);
    else if (c > ' ' && c < 127)
        snprintf(found, sizeof found, "'%c'", c);
    else
        snprintf(found, sizeof found, "byte 0x%02x", c);
    return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu:%zu: expected %s, found %s", checker->file,
                          place.line, place.column, what, found);
}

static void skip_space(struct checker *checker) {
    checker->at += strspn(checker->at, " \t\r\n");
}

static enum status check_escape(struct checker *checker) {
    const char *c = checker->at + 1;
    if (*c != '\0' && strchr("\"\\/bfnrt", *c)) {
        checker->at += 2;
        return STATUS_OK;
    }
    char digits[5] = "";
    if (*c == 'u')
        for (int i = 0; i < 4 && isxdigit((unsigned char)c[1 + i]); i++)
            digits[i] = c[1 + i];
    if (strlen(digits) != 4)
        return expected(checker, "an escape of JSON such as \\n or \\u00e9");
    if (strtoul(digits, NULL, 16) == 0)
        return expected(checker, "a text without the character \\u0000");
    checker->at += 6;
    return STATUS_OK;
}

static enum status check_text(struct checker *checker) {
    checker->at++;
    while (*checker->at != '"') {
        const unsigned char c = (unsigned char)*checker->at;
        if (c < ' ')
            return expected(checker, "the closing '\"' of a text");
        if (c == '\\')
            TRY(check_escape(checker));
        else
            checker->at++;
    }
    checker->at++;
    return STATUS_OK;
}

static bool skip_digits(struct checker *checker) {
    const size_t digits = strspn(checker->at, "0123456789");
    checker->at += digits;
    return digits > 0;
}

static enum status check_number(struct checker *checker) {
    const char *begin = checker->at;
    checker->at += *begin == '-';
    if (*checker->at == '0')
        checker->at++;
    else if (!skip_digits(checker))
        return expected(checker, "a digit");
    if (*checker->at == '.') {
        checker->at++;
        if (!skip_digits(checker))
            return expected(checker, "a digit after the decimal point");
    }
    if (*checker->at == 'e' || *checker->at == 'E') {
        checker->at++;
        checker->at += *checker->at == '+' || *checker->at == '-';
        if (!skip_digits(checker))
            return expected(checker, "a digit in the exponent");
    }
    if (checker->at - begin > LONGEST_NUMBER)
        return expected(checker, "a number of at most 60 characters");
    return STATUS_OK;
}

static enum status check_word(struct checker *checker, const char *word) {
    if (strncmp(checker->at, word, strlen(word)) != 0)
        return expected(checker, "a value");
    checker->at += strlen(word);
    return STATUS_OK;
}

static enum status check_member(struct checker *checker) {
    if (*checker->at != '"')
        return expected(checker, "a key in double quotes");
    TRY(check_text(checker));
    skip_space(checker);
    if (*checker->at != ':')
        return expected(checker, "':' after the key");
    checker->at++;
    skip_space(checker);
    return check_value(checker);
}

/// What an object and an array share: elements between commas up to the closing bracket.
static enum status check_list(struct checker *checker, char close, const char *separator,
                              enum status (*check_element)(struct checker *)) {
    if (++checker->depth > DEEPEST_NESTING)
        return expected(checker, "at most 64 nested objects and arrays");
    checker->at++;
    skip_space(checker);
    if (*checker->at != close)
        TRY(check_element(checker));
    skip_space(checker);
    while (*checker->at == ',') {
        checker->at++;
        skip_space(checker);
        if (*checker->at == close)
            return expected(checker, "something behind the last comma");
        TRY(check_element(checker));
        skip_space(checker);
    }
    if (*checker->at != close)
        return expected(checker, separator);
    checker->at++;
    checker->depth--;
    return STATUS_OK;
}

static enum status check_value(struct checker *checker) {
    const char c = *checker->at;
    if (c == '{')
        return check_list(checker, '}', "',' or '}'", check_member);
    if (c == '[')
        return check_list(checker, ']', "',' or ']'", check_value);
    if (c == '"')
        return check_text(checker);
    if (c == '-' || isdigit((unsigned char)c))
        return check_number(checker);
    return check_word(checker, c == 't' ? "true" : c == 'f' ? "false" : "null");
}

enum status mf_json_syntax_check(const char *file, const char *text) {
    struct checker checker = {.file = file, .text = text, .at = text};
    skip_space(&checker);
    TRY(check_value(&checker));
    skip_space(&checker);
    if (*checker.at != '\0')
        return expected(&checker, "nothing after the document");
    return STATUS_OK;
}
