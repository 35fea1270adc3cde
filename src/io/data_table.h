// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Tables of numbers in text files.
///
/// Written: tab-separated, one `#` header line with column names and units, %.17g or fewer digits
/// where asked; numpy.loadtxt and gnuplot read them as they are.
/// Read: columns parted by blanks and tabs, by commas or by semicolons, as the first row has them;
/// `#`, `@` and `%` start comment lines; empty lines pass, and so do lines of text before the rows,
/// which do not begin with a number. Words may stand in quotes. Columns of text are left out and
/// not counted. A line `&` ends the first set of data, and what follows is another. Decimals begin
/// with a point or, where columns are parted by semicolons or tabs or stand in quotes, all of them
/// with a comma. Of LAMMPS's tables one section is read, without the numbers of its rows, which are
/// not counted as a column either.
#pragma once

#include "base/status.h"
#include "io/data_line.h"
#include "io/units_scale.h"

#include <stdbool.h>
#include <stddef.h>

struct data_table {
    size_t rows, columns;
    double *values; ///< shape [rows, columns], row-major
    size_t *line;   ///< shape [rows]: line number in the file, for messages
    char *flags;    ///< shape [rows]: the letter that ends each row; NULL unless asked for
    char *header;   ///< names of columns: the last line before the rows, as mf_data_heading_make
    char *comments; ///< all comment lines before the data, as they stand in the file
    char separator; ///< of columns, as mf_data_line_separator
    /// What of LAMMPS it is: of a g(r) that is averaged the third column counts neighbours.
    enum data_lammps_kind lammps;
};

/// Read a file. BAD_INPUT with file:line for a word that is not a finite number, a row of another
/// length than the first, fewer than `min_columns` columns, or no row at all. Only beyond the
/// first `min_columns` may a word be "nan": what the caller did not ask for may be unknown.
enum status mf_data_table_read(struct data_table *table, const char *file,
                               size_t min_columns) MUST_USE;

/// The same for rows that end with a letter, such as "0.24 28.4 i"; it is not among the columns.
enum status mf_data_table_read_flagged(struct data_table *table, const char *file,
                                       size_t min_columns) MUST_USE;

/// The same of r and a potential, which may begin with "inf" or "Infinity", a hard core: those rows
/// are left out. Fails, too: BAD_INPUT if one is behind a finite one. Tested: test_data_table.
enum status mf_data_table_read_core(struct data_table *table, const char *file) MUST_USE;

/// The same of a result of this program, whose numbers may be nan or infinite, not known; only
/// those of the first column are.
enum status mf_data_table_read_result(struct data_table *table, const char *file) MUST_USE;

void mf_data_table_clear(struct data_table *table);

/// Check that column `column` grows strictly and starts at `min` or above.
/// BAD_INPUT with file:line of the first row that does not, or what is likely to be wrong with the
/// whole: rows that should be columns, commas that part columns and begin decimals, too.
enum status mf_data_table_check_increasing(const struct data_table *table, const char *file,
                                           size_t column, double min) MUST_USE;

/// Whether a column numbers at least three rows: 1, 2, 3, … from any number on.
bool mf_data_table_numbers_rows(const struct data_table *table, size_t column);

/// Whether a column grows in equal steps but for `rounding`, a share of them, as r and times do:
/// DATA_ROUNDING of any digits, and no measured function within DATA_EXACT.
#define DATA_ROUNDING 0.2
#define DATA_EXACT 1e-3
bool mf_data_table_is_spaced(const struct data_table *table, size_t column, double rounding);

/// Whether the first of at least three columns numbers the rows and the second is an argument as r:
/// what a table of another program is if nobody has said so. Behind 1, 2, 3, … it only increases.
bool mf_data_table_is_numbered(const struct data_table *table);

/// Number, from 1, of the column that the line of names calls `name`, units in brackets aside; 0 if
/// there is none, or if that line has not as many names as there are columns. Tested:
/// test_data_table.
size_t mf_data_table_find(const struct data_table *table, const char *name);

/// Whether a heading says the unit of a column, and which.
enum { DATA_UNIT_SIZE = 64 };
bool mf_data_table_unit(const struct data_table *table, size_t column, char unit[DATA_UNIT_SIZE]);

/// Make numbers of the reduced `unit` of a column: they are in the unit in brackets after its
/// name, or, of the first column, in that of the x axis of xmgrace's "@" lines, or else in those of
/// the file that names the table. Nothing changes for a reduced file. Fails: BAD_INPUT if the name
/// has no such unit, or, of a reduced file with a scale, one whose 1 is not that of the scale.
/// Tested: test_data_table_units.
enum status mf_data_table_convert(struct data_table *table, const char *file, size_t column,
                                  const char *unit, const struct units *units) MUST_USE;

/// One column to be written.
struct data_column {
    const char *name; ///< with unit, such as "r[lambda]"
    const double *values;
    const char *format; ///< printf format of one number, such as "%.6f"; NULL is "%.10g"
};

/// Write `rows` rows, whole or not at all. `comment` (or NULL) becomes `#` lines above the header.
enum status mf_data_table_write(const char *file, const char *comment,
                                const struct data_column *columns, size_t column_count,
                                size_t rows) MUST_USE;

/// Call a column `name`, whose numbers are of the reduced `unit`: a reduced table leaves that out.
void mf_data_table_name(const struct units *units, const char *name, const char *unit,
                        char *heading, size_t size);

/// What a heading, "r[lambda]", is called in the units of the file, "r[nm]"; returns the factor
/// of its numbers.
double mf_data_table_translate(const struct units *units, const char *heading, char *name,
                               size_t size);

/// Write columns of reduced units in those of the file: by the unit in brackets after its name
/// each is converted and renamed, "r[lambda]" as "r[nm]"; columns of other units stay. Tested:
/// test_data_table_units.
enum status mf_data_table_write_in(const char *file, const struct units *units, const char *comment,
                                   const struct data_column *columns, size_t column_count,
                                   size_t rows) MUST_USE;

/// The same for columns of which some stand twice in a reduced file whose units have a scale:
/// after all columns again in nm, ps and kJ/mol, "r[nm]".
/// @param[in] beside  shape [columns]: format of each there; NULL: it does not stand again
enum status mf_data_table_write_beside(const char *file, const struct units *units,
                                       const char *comment, const struct data_column *columns,
                                       const char *const *beside, size_t column_count,
                                       size_t rows) MUST_USE;
