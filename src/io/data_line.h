// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Lines of a table of numbers in a text, and their words: quoted or not, parted by blanks,
/// commas or semicolons.
#pragma once

#include <stdbool.h>
#include <stddef.h>

/// One line of the text, without its line end.
struct data_line {
    const char *begin, *end;
    size_t number; ///< from 1
};

struct data_line mf_data_line_first(const char *text);

/// Step to the next line; false at the end of the text.
bool mf_data_line_next(struct data_line *line);

/// Its first character that is no blank, or its end.
const char *mf_data_line_start(const struct data_line *line);

bool mf_data_line_is_comment(const struct data_line *line);

/// Neither empty nor a comment.
bool mf_data_line_is_data(const struct data_line *line);

/// Copy the line from `begin` on, without blanks at its end, to `text`; returns its length.
size_t mf_data_line_copy(const struct data_line *line, const char *begin, char *text);

/// What is between two words: a comma, a semicolon, or blanks alone (' '). Where blanks part words
/// that no comma parts, the commas are those of decimals.
char mf_data_line_separator(const struct data_line *line);

/// Whether commas in the numbers of a line can be those of decimals alone.
bool mf_data_line_may_have_commas(const struct data_line *line, char separator);

/// A word of a line, without blanks and quotes around it.
struct data_word {
    const char *begin;
    size_t length;
    const char *past; ///< it, its quotes and blanks
    bool quoted;
};

struct data_word mf_data_word_first(const struct data_line *line, char separator);

/// Step to the next word; false after the last. Separators at the end begin no further words.
bool mf_data_word_next(const struct data_line *line, char separator, struct data_word *word);

size_t mf_data_word_count(const struct data_line *line, char separator);

/// Whether the word is a finite number and nothing else. Its decimals begin with `*decimal` or,
/// where that is 0, with a point or, if `commas`, a comma, which is then kept there.
bool mf_data_word_is_number(const struct data_word *word, bool commas, char *decimal,
                            double *value);

/// Whether it begins as a number does, or is "nan" or "inf".
bool mf_data_word_is_numeric(const struct data_word *word);
