// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/data_heading.h"

#include "io/units_text.h"

#include <stdio.h>
#include <string.h>

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
