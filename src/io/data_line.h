// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Lines of a table of numbers in a text, and their words: quoted or not, parted by blanks,
/// commas or semicolons.
#pragma once

#include <stdint.h>
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

/// Columns that may be text.
enum { DATA_HEADING_MAX = 64 };

/// Make one line of names, "r[nm]\tg", of the last lines before the rows, comments or not.
///
/// A unit may stand in brackets or, if it is one that is known, in parentheses, or for all columns
/// in the last line, below the names: "r (nm)", "r [nm]" or "nm" below "r" all become "r[nm]".
/// @param[in]  before, last  lines, or zeros
/// @param[in]  separator     of the rows
/// @param[in]  label         a bit for each column of text, whose name is left out
/// @param[in]  columns       of the rows, with those of text
/// @param[out] heading       large enough for both lines and 2 characters more
/// Tested: test_data_table_units.
void mf_data_heading_make(const struct data_line *before, const struct data_line *last,
                          char separator, uint64_t label, size_t columns, char *heading);

enum data_lammps_kind {
    DATA_LAMMPS_NONE,
    DATA_LAMMPS_LAW,     ///< "N 98 R 2.3 12.0": a section of pair_style, bond_style, … table
    DATA_LAMMPS_AVERAGE, ///< "60000 500": a step and rows, of fix ave/time in mode vector
};

/// Put blanks in place of the numbers of rows, and of the line of an average, so that r and its
/// values are left. Nothing changes where rows are not numbered from 1 to what the line says.
/// @param[out] again  line, from 1, at which another section begins, or 0
/// Tested: test_data_table.
enum data_lammps_kind mf_data_lammps_strip(char *text, size_t *again);
