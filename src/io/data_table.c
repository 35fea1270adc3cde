// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/data_table.h"

#include "base/memory.h"
#include "io/data_line.h"
#include "io/text_file.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/// What is asked of a file, and what its text turns out to be.
struct layout {
    size_t columns;   ///< at least, and strictly numbers
    bool flagged;     ///< a letter ends each row
    bool core;        ///< the second number of a row may be infinite
    bool result;      ///< of this program: any number may be unknown or infinite
    char separator;   ///< of the first row
    bool commas;      ///< may be those of decimals
    char decimal;     ///< how decimals begin: '.', ',', or 0 until one is seen
    uint64_t label;   ///< columns of text beside the numbers, a bit each
    size_t labels;    ///< how many
    const char *rows; ///< where the first begins: before are names and comments
};

static bool is_label(const struct layout *layout, size_t column) {
    return column < DATA_HEADING_MAX && (layout->label >> column & 1);
}

static bool is_row(const struct layout *layout, const struct data_line *line) {
    return line->begin >= layout->rows && mf_data_line_is_data(line);
}

/// Text, but none of the flags of VOTCA's tables, which say what is no measurement.
static bool is_text(const struct data_word *word) {
    return word->length > 0 && !mf_data_word_is_numeric(word) &&
           !(word->length == 1 && strchr("iou", *word->begin));
}

/// The columns of a line that have text, and how many have none.
static uint64_t find_text(const struct data_line *line, char separator, size_t *numbers) {
    struct data_word word = mf_data_word_first(line, separator);
    uint64_t text = 0;
    size_t column = 0;
    *numbers = 0;
    do {
        if (column < DATA_HEADING_MAX && is_text(&word))
            text |= (uint64_t)1 << column;
        else
            ++*numbers;
        column++;
    } while (mf_data_word_next(line, separator, &word));
    return text;
}

/// Columns of labels are text in the last two lines.
static void find_labels(struct layout *layout, const struct data_line last[2]) {
    size_t numbers, before;
    if (layout->flagged || last[1].begin == NULL)
        return;
    const char separator = mf_data_line_separator(&last[0]);
    const uint64_t text =
        find_text(&last[0], separator, &numbers) & find_text(&last[1], separator, &before);
    if (numbers < layout->columns || before < layout->columns)
        return;
    layout->label = text;
    for (size_t column = 0; column < DATA_HEADING_MAX; column++)
        layout->labels += is_label(layout, column);
}

/// Whether a line before the rows is text: it does not begin as a row does.
static bool is_heading(const struct layout *layout, const struct data_line *line) {
    const char separator = mf_data_line_separator(line);
    struct data_word word = mf_data_word_first(line, separator);
    size_t column = 0;
    while (is_label(layout, column) && mf_data_word_next(line, separator, &word))
        column++;
    return is_label(layout, column) || !mf_data_word_is_numeric(&word);
}

/// End the text where its first set of data ends, by a line "&" as xmgrace has it, and find its
/// last two lines.
static void end_set(char *text, struct data_line last[2]) {
    struct data_line line = mf_data_line_first(text);
    do {
        if (!mf_data_line_is_data(&line))
            continue;
        if (*mf_data_line_start(&line) == '&' && last[0].begin) {
            text[line.begin - text] = '\0';
            return;
        }
        last[1] = last[0];
        last[0] = line;
    } while (mf_data_line_next(&line));
}

/// Find where the rows begin, their separator, and columns of labels.
static void recognise(struct layout *layout, char *text) {
    struct data_line last[2] = {0};
    end_set(text, last);
    find_labels(layout, last);
    struct data_line line = mf_data_line_first(text);
    layout->rows = text + strlen(text);
    do {
        if (!mf_data_line_is_data(&line) || is_heading(layout, &line))
            continue;
        layout->rows = line.begin;
        layout->separator = mf_data_line_separator(&line);
        layout->commas = mf_data_line_may_have_commas(&line, layout->separator);
        return;
    } while (mf_data_line_next(&line));
}

/// Columns of numbers, and one of flags, of the first row, which has all labels of the last two.
static enum status count_columns(struct data_table *table, const char *file,
                                 const struct data_line *line, const struct layout *layout) {
    const size_t words = mf_data_word_count(line, layout->separator);
    for (size_t column = words; column < DATA_HEADING_MAX; column++)
        if (is_label(layout, column))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s:%zu: %zu columns, and the last rows have text in column %zu",
                                  file, line->number, words, column + 1);
    table->columns = words - layout->labels;
    return STATUS_OK;
}

/// Count the rows and take the number of columns from the first one.
static enum status measure(struct data_table *table, const char *file, const char *text,
                           const struct layout *layout) {
    const size_t min = layout->columns + layout->flagged;
    struct data_line line = mf_data_line_first(text);
    do {
        if (!is_row(layout, &line))
            continue;
        if (table->rows++ == 0)
            TRY(count_columns(table, file, &line, layout));
        if (table->columns < min)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s:%zu: %zu columns, at least %zu are needed (blanks, commas or "
                                  "semicolons separate columns)",
                                  file, line.number, table->columns, min);
    } while (mf_data_line_next(&line));
    if (table->rows == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: the file ends without a row of numbers",
                              file, line.number);
    table->columns -= layout->flagged;
    return STATUS_OK;
}

/// What a person can do about a word that is no number.
static const char *find_remedy(const struct data_word *word, const struct layout *layout) {
    const bool comma = word->length > 0 && memchr(word->begin, ',', word->length) &&
                       strspn(word->begin, "0123456789+-.,eE") >= word->length;
    if (comma && layout->decimal == '.')
        return ": a decimal comma? other decimals of the file begin with a point";
    if (comma)
        return ": a decimal comma? separate columns by semicolons or tabs, or write decimals with "
               "a point";
    if (layout->decimal == ',' && word->length > 0 && memchr(word->begin, '.', word->length))
        return ": other decimals of the file begin with a comma";
    return is_text(word) ? ": begin lines of text with #" : "";
}

static bool is_infinite(const struct data_word *word) {
    static const char *const names[] = {"inf", "+inf", "infinity", "+infinity"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (word->length == strlen(names[k]) &&
            strncasecmp(word->begin, names[k], word->length) == 0)
            return true;
    return false;
}

/// Whether the word is a number as this program prints it, also one that is not known or infinite.
static bool is_printed(const struct data_word *word, double *value) {
    char *end;
    *value = strtod(word->begin, &end);
    return word->length > 0 && end == word->begin + word->length;
}

/// Read the number that is exactly `word`; "nan" where it is allowed.
static enum status read_number(const char *file, size_t line, size_t column,
                               const struct data_word *word, struct layout *layout, size_t number,
                               double *value) {
    if (mf_data_word_is_number(word, layout->commas, &layout->decimal, value) ||
        (layout->result && is_printed(word, value)) ||
        (number >= layout->columns && word->length == 3 && strncasecmp(word->begin, "nan", 3) == 0))
        return STATUS_OK;
    if (layout->core && number == 1 && is_infinite(word)) {
        *value = INFINITY;
        return STATUS_OK;
    }
    return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: column %zu: \"%.*s\" is not a finite number%s",
                          file, line, column + 1, word->length > 40 ? 40 : (int)word->length,
                          word->begin, find_remedy(word, layout));
}

/// The letter that is exactly `word`.
static enum status read_flag(const char *file, const struct data_line *line,
                             const struct data_word *of, char *flag) {
    const char *word = of->begin;
    *flag = *word;
    if (of->length == 1 && ((*word >= 'a' && *word <= 'z') || (*word >= 'A' && *word <= 'Z')))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s:%zu: expected a flag i, o or u of VOTCA at the end of the row", file,
                          line->number);
}

/// A column of text must not have numbers, too, which would be lost.
static enum status check_label(const char *file, const struct data_line *line, size_t column,
                               const struct data_word *word, const struct layout *layout) {
    double value;
    char decimal = layout->decimal;
    if (!mf_data_word_is_number(word, layout->commas, &decimal, &value))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s:%zu: column %zu: %g is a number, and the last rows have text there",
                          file, line->number, column + 1, value);
}

static enum status read_row(const struct data_table *table, const char *file, struct layout *layout,
                            const struct data_line *line, size_t row) {
    const size_t words = mf_data_word_count(line, layout->separator);
    const size_t wanted = table->columns + layout->flagged + layout->labels;
    struct data_word word = mf_data_word_first(line, layout->separator);
    size_t number = 0;
    for (size_t column = 0; column < words && column < wanted; column++) {
        if (is_label(layout, column)) {
            TRY(check_label(file, line, column, &word, layout));
        } else if (number < table->columns) {
            TRY(read_number(file, line->number, column, &word, layout, number,
                            &table->values[row * table->columns + number]));
            number++;
        } else {
            TRY(read_flag(file, line, &word, &table->flags[row]));
        }
        mf_data_word_next(line, layout->separator, &word);
    }
    if (words != wanted)
        return mf_status_fail(
            STATUS_BAD_INPUT, "%s:%zu: %zu columns, the first row has %zu%s", file, line->number,
            words, wanted,
            layout->separator == ',' && !memchr(line->begin, '.', (size_t)(line->end - line->begin))
                ? ": do commas part columns and begin decimals? Part columns by semicolons"
            : layout->separator != ' ' && words < wanted ? ": a cell is empty; leave out its row"
                                                         : "");
    return STATUS_OK;
}

static enum status read_rows(struct data_table *table, const char *file, struct layout *layout,
                             const char *text) {
    struct data_line line = mf_data_line_first(text);
    size_t row = 0;
    do {
        if (!is_row(layout, &line))
            continue;
        table->line[row] = line.number;
        TRY(read_row(table, file, layout, &line, row));
        row++;
    } while (mf_data_line_next(&line));
    return STATUS_OK;
}

/// Keep the comments before the rows, and of all lines there the last one as the names of columns.
static void read_comments(struct data_table *table, const struct layout *layout, const char *text) {
    struct data_line line = mf_data_line_first(text), last = {0}, before = {0};
    char *end = table->comments;
    for (bool more = true; more && !is_row(layout, &line); more = mf_data_line_next(&line)) {
        if (mf_data_line_start(&line) == line.end)
            continue;
        before = last;
        last = line;
        if (!mf_data_line_is_comment(&line))
            continue;
        end += mf_data_line_copy(&line, line.begin, end);
        *end++ = '\n';
    }
    mf_data_heading_make(&before, &last, layout->separator, layout->label,
                         table->columns + layout->labels, table->header);
}

/// A table in the memory of a caller, whose rows are its lines.
static enum status copy_table(struct data_table *table, const struct memory_file *from,
                              const struct layout *layout) {
    if (from->columns < layout->columns || layout->flagged)
        return mf_status_fail(
            STATUS_BAD_INPUT, "%s: %zu columns of numbers, at least %zu%s are needed", from->name,
            from->columns, layout->columns, layout->flagged ? " and one of flags" : "");
    table->rows = from->rows;
    table->columns = from->columns;
    TRY_ARRAY(table->values, table->rows * table->columns);
    TRY_ARRAY(table->line, table->rows);
    TRY_ARRAY(table->header, 1);
    TRY_ARRAY(table->comments, 1);
    memcpy(table->values, from->values, table->rows * table->columns * sizeof *table->values);
    for (size_t k = 0; k < table->rows; k++)
        table->line[k] = k + 1;
    for (size_t n = 0; n < table->rows * table->columns; n++) {
        const size_t column = n % table->columns;
        const double value = table->values[n];
        if (isfinite(value) || (isnan(value) && column >= layout->columns) ||
            (value == INFINITY && layout->core && column == 1))
            continue;
        return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: column %zu: \"%g\" is not a finite number",
                              from->name, n / table->columns + 1, column + 1, value);
    }
    return STATUS_OK;
}

static enum status read_table(struct data_table *table, const char *file, struct layout *layout) {
    enum status status = STATUS_OK;
    char *text = NULL;
    size_t length = 0, again = 0;
    const struct memory_file *in_memory = mf_text_file_find_memory_file(file);
    *table = (struct data_table){0};
    if (in_memory && in_memory->values) {
        status = copy_table(table, in_memory, layout);
        goto done;
    }
    CHECK(mf_text_file_read(file, &text, &length));
    table->lammps = mf_data_lammps_strip(text, &again);
    if (again > 0)
        CHECK(mf_status_fail(STATUS_BAD_INPUT,
                             "%s:%zu: a second section of LAMMPS begins: of several write the one "
                             "that is meant into a file of its own",
                             file, again));
    recognise(layout, text);
    table->separator = layout->separator;
    CHECK(measure(table, file, text, layout));
    NEW_ARRAY(table->values, table->rows * table->columns);
    NEW_ARRAY(table->line, table->rows);
    if (layout->flagged)
        NEW_ARRAY(table->flags, table->rows);
    NEW_ARRAY(table->header, 2 * length + 2);
    NEW_ARRAY(table->comments, length + 2);
    CHECK(read_rows(table, file, layout, text));
    read_comments(table, layout, text);
done:
    mf_memory_free(text);
    if (status != STATUS_OK)
        mf_data_table_clear(table);
    return status;
}

enum status mf_data_table_read(struct data_table *table, const char *file, size_t min_columns) {
    return read_table(table, file, &(struct layout){.columns = min_columns});
}

enum status mf_data_table_read_flagged(struct data_table *table, const char *file,
                                       size_t min_columns) {
    return read_table(table, file, &(struct layout){.columns = min_columns, .flagged = true});
}

enum status mf_data_table_read_core(struct data_table *table, const char *file) {
    TRY(read_table(table, file, &(struct layout){.columns = 2, .core = true}));
    const size_t width = table->columns;
    size_t core = 0;
    while (core < table->rows && isinf(table->values[core * width + 1]))
        core++;
    table->rows -= core;
    memmove(table->values, table->values + core * width,
            table->rows * width * sizeof *table->values);
    memmove(table->line, table->line + core, table->rows * sizeof *table->line);
    for (size_t k = 0; k < table->rows; k++)
        if (isinf(table->values[k * width + 1]))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s:%zu: an infinite value behind finite ones: only the core, "
                                  "where a potential begins, may be infinite",
                                  file, table->line[k]);
    return STATUS_OK;
}

enum status mf_data_table_read_result(struct data_table *table, const char *file) {
    return read_table(table, file, &(struct layout){.columns = 1, .result = true});
}

void mf_data_table_clear(struct data_table *table) {
    mf_memory_free(table->flags);
    mf_memory_free(table->values);
    mf_memory_free(table->line);
    mf_memory_free(table->header);
    mf_memory_free(table->comments);
    *table = (struct data_table){0};
}

static double cell(const struct data_table *table, size_t row, size_t column) {
    return table->values[row * table->columns + column];
}

bool mf_data_table_numbers_rows(const struct data_table *table, size_t column) {
    enum { FEWEST = 3 };
    const double first = cell(table, 0, column);
    bool numbers = table->rows >= FEWEST && first >= 0 && first == floor(first);
    for (size_t k = 0; k < table->rows && numbers; k++)
        numbers = cell(table, k, column) == first + (double)k;
    return numbers;
}

bool mf_data_table_is_spaced(const struct data_table *table, size_t column, double rounding) {
    const double step = table->rows > 1 ? cell(table, 1, column) - cell(table, 0, column) : 0;
    bool spaced = step > 0;
    for (size_t k = 1; k < table->rows && spaced; k++)
        spaced = fabs(cell(table, k, column) - cell(table, k - 1, column) - step) < rounding * step;
    return spaced;
}

static bool increases(const struct data_table *table, size_t column) {
    size_t k = 1;
    while (k < table->rows && cell(table, k, column) > cell(table, k - 1, column))
        k++;
    return k >= table->rows;
}

bool mf_data_table_is_numbered(const struct data_table *table) {
    enum { FEWEST_COLUMNS = 3 };
    return table->columns >= FEWEST_COLUMNS && mf_data_table_numbers_rows(table, 0) &&
           (cell(table, 0, 0) == 1 ? increases(table, 1)
                                   : mf_data_table_is_spaced(table, 1, DATA_ROUNDING));
}

size_t mf_data_table_find(const struct data_table *table, const char *name) {
    static const char gaps[] = " \t,;";
    size_t names = 0, found = 0;
    for (const char *word = table->header + strspn(table->header, gaps); *word;) {
        const size_t length = strcspn(word, " \t,;[");
        names++;
        if (found == 0 && strlen(name) == length && strncmp(word, name, length) == 0)
            found = names;
        word += strcspn(word, gaps);
        word += strspn(word, gaps);
    }
    return names == table->columns ? found : 0;
}
