// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/data_table.h"

#include "base/memory.h"
#include "io/output.h"
#include "io/text_file.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const char blanks[] = " \t\r\f\v";

/// One line of the text, without its line end.
struct line {
    const char *begin, *end;
    size_t number; ///< from 1
};

static struct line first_line(const char *text) {
    return (struct line){text, text + strcspn(text, "\n"), 1};
}

/// Step to the next line; false at the end of the text.
static bool next_line(struct line *line) {
    if (*line->end == '\0')
        return false;
    const char *begin = line->end + 1;
    *line = (struct line){begin, begin + strcspn(begin, "\n"), line->number + 1};
    return true;
}

static const char *first_word(const struct line *line) {
    return line->begin + strspn(line->begin, blanks);
}

static bool is_comment(const struct line *line) {
    const char *word = first_word(line);
    return word < line->end && strchr("#@%", *word) != NULL;
}

static bool is_data(const struct line *line) {
    return first_word(line) < line->end && !is_comment(line);
}

/// What is between two words: a comma, a semicolon, or blanks alone (' '). Where blanks part words
/// that no comma parts, the commas are those of decimals, which read_number refuses.
static char separator_of(const struct line *line) {
    const size_t length = (size_t)(line->end - line->begin);
    if (memchr(line->begin, ';', length))
        return ';';
    if (memchr(line->begin, ',', length) == NULL)
        return ' ';
    for (const char *at = first_word(line); at < line->end; at++) {
        const char *after = at + strspn(at, blanks);
        if (after > at && after < line->end && at[-1] != ',' && *after != ',')
            return ' ';
    }
    return ',';
}

/// A word of a line, without blanks around it.
struct word {
    const char *begin;
    size_t length;
    char separator; ///< of the line
};

static struct word take_word(const struct line *line, char separator, const char *begin) {
    const char stop[] = {separator, '\n', '\0'};
    size_t length = strcspn(begin, separator == ' ' ? " \t\r\f\v\n" : stop);
    if (begin + length > line->end)
        length = (size_t)(line->end - begin);
    while (length > 0 && strchr(blanks, begin[length - 1]))
        length--;
    return (struct word){begin, length, separator};
}

static struct word line_word(const struct line *line, char separator) {
    return take_word(line, separator, first_word(line));
}

/// Step to the next word; false behind the last. A separator at the end begins no further word.
static bool next_word(const struct line *line, struct word *word) {
    const char *at = word->begin + word->length;
    at += strspn(at, blanks);
    if (word->separator != ' ' && *at == word->separator)
        at += 1 + strspn(at + 1, blanks);
    *word = take_word(line, word->separator, at);
    return at < line->end;
}

static size_t count_words(const struct line *line, char separator) {
    struct word word = line_word(line, separator);
    size_t count = 1;
    while (next_word(line, &word))
        count++;
    return count;
}

/// Whether the word is a finite number and nothing else. strtod alone would take inf and 0x10.
static bool is_number(const struct word *word, double *value) {
    char *end;
    *value = strtod(word->begin, &end);
    return word->length > 0 && end == word->begin + word->length && isfinite(*value) &&
           strspn(word->begin, "0123456789+-.eE") >= word->length;
}

/// Whether these are names of columns that no comment mark begins: no word is "nan" or begins as a
/// number does.
static bool is_names(const struct line *line) {
    const char separator = separator_of(line);
    struct word word = line_word(line, separator);
    do {
        char *end;
        strtod(word.begin, &end);
        if (word.length == 0 || strspn(word.begin, "0123456789+-.,") > 0 ||
            end == word.begin + word.length)
            return false;
    } while (next_word(line, &word));
    return true;
}

/// What is asked of a file, and what its text turns out to be.
struct demand {
    size_t columns;    ///< at least, and strictly numbers
    bool flagged;      ///< a letter ends each row
    char separator;    ///< of the first row
    const char *names; ///< the line of names before it, or NULL
};

static bool is_row(const struct demand *demand, const struct line *line) {
    return is_data(line) && line->begin != demand->names;
}

/// Find the names of columns and the separator, and end the text where its first set of data ends,
/// by a line "&" as xmgrace has it.
static void recognise(struct demand *demand, char *text) {
    struct line line = first_line(text);
    bool first = true;
    do {
        if (!is_data(&line))
            continue;
        if (*first_word(&line) == '&' && !first) {
            text[line.begin - text] = '\0';
            return;
        }
        if (first && demand->names == NULL && is_names(&line)) {
            demand->names = line.begin;
        } else if (first) {
            demand->separator = separator_of(&line);
            first = false;
        }
    } while (next_line(&line));
}

/// Count the rows and take the number of columns from the first one.
static enum status measure(struct data_table *table, const char *file, const char *text,
                           const struct demand *demand) {
    const size_t least = demand->columns + demand->flagged;
    struct line line = first_line(text);
    do {
        if (!is_row(demand, &line))
            continue;
        if (table->rows++ == 0)
            table->columns = count_words(&line, demand->separator);
        if (table->columns < least)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s:%zu: %zu columns, at least %zu are needed (blanks, commas or "
                                  "semicolons separate columns)",
                                  file, line.number, table->columns, least);
    } while (next_line(&line));
    if (table->rows == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: the file ends without a row of numbers",
                              file, line.number);
    table->columns -= demand->flagged;
    return STATUS_OK;
}

/// Read the number that is exactly `word`; "nan" where it is allowed.
static enum status read_number(const char *file, size_t line, size_t column, size_t strict,
                               const struct word *word, double *value) {
    if (is_number(word, value) || (column >= strict && word->length == 3 && isnan(*value)))
        return STATUS_OK;
    const bool comma = word->length > 0 && memchr(word->begin, ',', word->length) &&
                       strspn(word->begin, "0123456789+-.,eE") >= word->length;
    return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: column %zu: \"%.*s\" is not a finite number%s",
                          file, line, column + 1, word->length > 40 ? 40 : (int)word->length,
                          word->begin,
                          comma ? ": a decimal comma? decimals begin with a point here" : "");
}

/// The letter that is exactly `word`.
static enum status read_flag(const char *file, const struct line *line, const struct word *of,
                             char *flag) {
    const char *word = of->begin;
    *flag = *word;
    if (of->length == 1 && ((*word >= 'a' && *word <= 'z') || (*word >= 'A' && *word <= 'Z')))
        return STATUS_OK;
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s:%zu: the row does not end with a letter, as the flags i, o and u of VOTCA", file,
        line->number);
}

static enum status read_row(const struct data_table *table, const char *file,
                            const struct demand *demand, const struct line *line, size_t row) {
    const size_t words = count_words(line, demand->separator);
    const size_t wanted = table->columns + demand->flagged;
    struct word word = line_word(line, demand->separator);
    for (size_t column = 0; column < words && column < wanted; column++) {
        if (column < table->columns)
            TRY(read_number(file, line->number, column, demand->columns, &word,
                            &table->values[row * table->columns + column]));
        else
            TRY(read_flag(file, line, &word, &table->flags[row]));
        next_word(line, &word);
    }
    if (words != wanted)
        return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: %zu columns, the first row has %zu", file,
                              line->number, words, wanted);
    return STATUS_OK;
}

static enum status read_rows(struct data_table *table, const char *file,
                             const struct demand *demand, const char *text) {
    struct line line = first_line(text);
    size_t row = 0;
    do {
        if (!is_row(demand, &line))
            continue;
        table->line[row] = line.number;
        TRY(read_row(table, file, demand, &line, row));
        row++;
    } while (next_line(&line));
    return STATUS_OK;
}

/// Copy `line` from `begin` on, without blanks at its end, to `text`; returns its length.
static size_t copy_line(char *text, const struct line *line, const char *begin) {
    size_t length = (size_t)(line->end - begin);
    while (length > 0 && strchr(blanks, begin[length - 1]))
        length--;
    memcpy(text, begin, length);
    text[length] = '\0';
    return length;
}

static void read_comments(struct data_table *table, const struct demand *demand, const char *text) {
    struct line line = first_line(text);
    char *end = table->comments;
    do {
        if (is_row(demand, &line))
            return;
        if (line.begin == demand->names) {
            copy_line(table->header, &line, first_word(&line));
            continue;
        }
        if (!is_comment(&line))
            continue;
        const char *after_mark = first_word(&line) + 1;
        copy_line(table->header, &line, after_mark + strspn(after_mark, blanks));
        end += copy_line(end, &line, line.begin);
        *end++ = '\n';
    } while (next_line(&line));
}

static enum status read_table(struct data_table *table, const char *file, struct demand *demand) {
    enum status status = STATUS_OK;
    char *text = NULL;
    size_t length = 0;
    *table = (struct data_table){0};
    CHECK(mf_text_file_read(file, &text, &length));
    recognise(demand, text);
    CHECK(measure(table, file, text, demand));
    NEW_ARRAY(table->values, table->rows * table->columns);
    NEW_ARRAY(table->line, table->rows);
    if (demand->flagged)
        NEW_ARRAY(table->flags, table->rows);
    NEW_ARRAY(table->header, length + 1);
    NEW_ARRAY(table->comments, length + 2);
    CHECK(read_rows(table, file, demand, text));
    read_comments(table, demand, text);
done:
    mf_memory_free(text);
    if (status != STATUS_OK)
        mf_data_table_clear(table);
    return status;
}

enum status mf_data_table_read(struct data_table *table, const char *file, size_t least_columns) {
    return read_table(table, file, &(struct demand){.columns = least_columns});
}

enum status mf_data_table_read_flagged(struct data_table *table, const char *file,
                                       size_t least_columns) {
    return read_table(table, file, &(struct demand){.columns = least_columns, .flagged = true});
}

void mf_data_table_clear(struct data_table *table) {
    mf_memory_free(table->flags);
    mf_memory_free(table->values);
    mf_memory_free(table->line);
    mf_memory_free(table->header);
    mf_memory_free(table->comments);
    *table = (struct data_table){0};
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

enum status mf_data_table_check_increasing(const struct data_table *table, const char *file,
                                           size_t column, double least) {
    if (column >= table->columns)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: there is no column %zu", file, column + 1);
    for (size_t row = 0; row < table->rows; row++) {
        const double value = table->values[row * table->columns + column];
        const size_t line = table->line[row];
        if (row == 0 && !(value >= least))
            return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: column %zu: %.15g is below %.15g",
                                  file, line, column + 1, value, least);
        const double before = row ? table->values[(row - 1) * table->columns + column] : -INFINITY;
        if (!(value > before))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s:%zu: column %zu: %.15g does not grow from %.15g in line %zu "
                                  "(are the columns in another order?)",
                                  file, line, column + 1, value, before, table->line[row - 1]);
    }
    return STATUS_OK;
}

static void write_comment(FILE *stream, const char *comment) {
    struct line line = first_line(comment);
    do
        fprintf(stream, "# %.*s\n", (int)(line.end - line.begin), line.begin);
    while (next_line(&line) && *line.begin);
}

static void write_header(FILE *stream, const struct data_column *columns, size_t count) {
    fputs("# ", stream);
    for (size_t column = 0; column < count; column++)
        fprintf(stream, "%s%s", column ? "\t" : "", columns[column].name);
    fputc('\n', stream);
}

static void write_row(FILE *stream, const struct data_column *columns, size_t count, size_t row) {
    for (size_t column = 0; column < count; column++) {
        const char *format = columns[column].format ? columns[column].format : "%.10g";
        const double value = columns[column].values[row];
        if (column > 0)
            fputc('\t', stream);
        if (isnan(value))
            fputs("nan", stream); // printf would add the sign that a NaN happens to carry
        else
            fprintf(stream, format, value);
    }
    fputc('\n', stream);
}

enum status mf_data_table_write(const char *file, const char *comment,
                                const struct data_column *columns, size_t column_count,
                                size_t rows) {
    struct output output;
    TRY(mf_output_open(&output, file));
    if (comment)
        write_comment(output.stream, comment);
    write_header(output.stream, columns, column_count);
    for (size_t row = 0; row < rows; row++)
        write_row(output.stream, columns, column_count, row);
    return mf_output_commit(&output);
}
