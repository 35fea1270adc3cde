// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/result.h"

#include "base/memory.h"
#include "io/json.h"
#include "io/output.h"
#include "io/text_file.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH_SIZE = OUTPUT_PATH_SIZE + 64 };

#define TEXT(member)                                                                               \
    { .name = #member, .type = FIELD_TEXT, .offset = offsetof(struct result_summary, member) }
#define NUMBER(member, its_unit)                                                                   \
    {                                                                                              \
        .name = #member, .type = FIELD_NUMBER, .offset = offsetof(struct result_summary, member),  \
        .initial = NAN, .minimum = -DBL_MAX, .maximum = DBL_MAX, .unit = its_unit                  \
    }

const struct field result_summary_fields[] = {
    TEXT(status),
    TEXT(method),
    TEXT(version),
    NUMBER(seconds, "s"),
    NUMBER(threads, "1"),
    NUMBER(iterations, "1"),
    NUMBER(evaluations, "1"),
    NUMBER(engine_steps, "1"),
    NUMBER(rdf_rmse, "1"),
    NUMBER(rdf_rmse_error, "1"),
    NUMBER(rdf_noise, "1"),
    NUMBER(temperature, "T_0"),
    NUMBER(temperature_configurational, "T_0"),
    NUMBER(pressure, "k_BT_0/lambda^3"),
    NUMBER(seed, "1"),
    FIELD_END,
};

/// Say what is wrong with the folder before a reader complains of a file in it.
static enum status check_folder(const char *folder, const char *summary) {
    struct stat about;
    if (stat(folder, &about) != 0)
        return status_fail(STATUS_IO, "%s: %s", folder, strerror(errno));
    if (!S_ISDIR(about.st_mode))
        return status_fail(STATUS_BAD_INPUT, "%s: not a folder", folder);
    if (access(summary, F_OK) != 0)
        return status_fail(STATUS_BAD_INPUT, "%s: missing, so this is no folder of a finished fit",
                           summary);
    return STATUS_OK;
}

/// Keys that are not in the table are left alone: a later version may write more.
static enum status read_summary(struct result_summary *summary, const char *file) {
    struct json_document *document;
    TRY(json_open(&document, file));
    struct json_object root = json_root(document);
    json_fields(&root, result_summary_fields, summary);
    if (root.item && !json_has(&root, "rdf_rmse"))
        json_fault(&root, NULL, "not the result of a fit: there is no rdf_rmse");
    return json_close(document);
}

/// Cut `*text` behind its first line and step over it; NULL at the end.
static char *take_line(char **text) {
    char *line = *text;
    if (*line == '\0')
        return NULL;
    char *end = line + strcspn(line, "\n");
    *text = *end ? end + 1 : end;
    *end = '\0';
    return line;
}

static bool is_data(const char *line) {
    const char *word = line + strspn(line, " \t\r");
    return *word != '\0' && *word != '#';
}

static enum status read_row(double *row, size_t columns, const char *line, const char *file,
                            size_t number) {
    for (size_t k = 0; k < columns; k++) {
        char *end;
        row[k] = strtod(line, &end);
        if (end == line || strchr(" \t\r", *end) == NULL)
            return status_fail(STATUS_BAD_INPUT, "%s:%zu: column %zu is not a number", file, number,
                               k + 1);
        line = end;
    }
    return STATUS_OK;
}

/// Read the first `columns` columns; more are left alone.
static enum status read_table(struct result_table *table, const char *folder, const char *name,
                              size_t columns) {
    enum status status = STATUS_OK;
    char file[PATH_SIZE], *text = NULL, *line;
    size_t length = 0, most_rows = 1, number = 0;
    snprintf(file, sizeof file, "%s/%s", folder, name);
    CHECK(text_file_read(file, &text, &length));
    for (size_t k = 0; k < length; k++)
        most_rows += text[k] == '\n';
    table->columns = columns;
    NEW_ARRAY(table->values, most_rows * columns);
    for (char *rest = text; (line = take_line(&rest));) {
        number++;
        if (is_data(line))
            CHECK(read_row(table->values + columns * table->rows++, columns, line, file, number));
    }
    if (table->rows == 0)
        status = status_fail(STATUS_BAD_INPUT, "%s: there is no row of numbers", file);
done:
    memory_free(text);
    return status;
}

enum status result_read(struct result *result, const char *folder) {
    enum status status = STATUS_OK;
    char summary[PATH_SIZE];
    snprintf(summary, sizeof summary, "%s/summary.json", folder);
    *result = (struct result){0};
    CHECK(check_folder(folder, summary));
    CHECK(read_summary(&result->summary, summary));
    CHECK(read_table(&result->rdf, folder, "rdf.tsv", 5));
    CHECK(read_table(&result->potential, folder, "potential.tsv", 2));
    CHECK(read_table(&result->history, folder, "history.tsv", 5));
    CHECK(read_table(&result->timing, folder, "timing.tsv", 2));
done:
    if (status != STATUS_OK)
        result_clear(result);
    return status;
}

void result_clear(struct result *result) {
    memory_free(result->rdf.values);
    memory_free(result->potential.values);
    memory_free(result->history.values);
    memory_free(result->timing.values);
    *result = (struct result){0};
}
