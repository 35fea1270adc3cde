// SPDX-License-Identifier: GPL-3.0-or-later
#include "library/memory_files.h"

#include "base/memory.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/// All digits, so that the same numbers are read.
static char *write_table(const struct mesofit_table *table) {
    char *text = NULL;
    size_t length;
    FILE *stream = open_memstream(&text, &length);
    if (stream == NULL)
        return NULL;
    for (size_t row = 0; row < table->rows; row++)
        for (size_t column = 0; column < table->columns; column++)
            fprintf(stream, "%.17g%c", table->values[row * table->columns + column],
                    column + 1 < table->columns ? '\t' : '\n');
    const bool failed = ferror(stream);
    if (fclose(stream) == 0 && !failed)
        return text;
    free(text);
    return NULL;
}

static enum status add_text(struct memory_files *memory_files, const struct mesofit_text *text) {
    if (text->name == NULL || text->text == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: there is no text",
                              text->name ? text->name : "a text without a name");
    memory_files->text[memory_files->count++] = (struct memory_file){text->name, text->text};
    memory_files->borrowed = memory_files->count;
    return STATUS_OK;
}

static enum status add_table(struct memory_files *memory_files, const struct mesofit_table *table,
                             size_t number) {
    if (table->name == NULL || table->values == NULL || table->rows == 0 || table->columns == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "table %zu has no name or no numbers", number);
    const char *written = write_table(table);
    if (written == NULL)
        return mf_status_fail(STATUS_NO_MEMORY, "no memory for the table \"%s\"", table->name);
    memory_files->text[memory_files->count++] = (struct memory_file){table->name, written};
    return STATUS_OK;
}

enum status mf_memory_files_begin(struct memory_files *memory_files,
                                  const struct mesofit_text *texts, size_t text_count,
                                  const struct mesofit_table *tables, size_t table_count) {
    enum status status = STATUS_OK;
    *memory_files = (struct memory_files){0};
    NEW_ARRAY(memory_files->text, text_count + table_count + 1);
    for (size_t k = 0; k < text_count; k++)
        CHECK(add_text(memory_files, &texts[k]));
    for (size_t k = 0; k < table_count; k++)
        CHECK(add_table(memory_files, &tables[k], k));
    mf_text_file_set_memory_files(memory_files->text, memory_files->count);
done:
    if (status != STATUS_OK)
        mf_memory_files_end(memory_files);
    return status;
}

enum status mf_memory_files_begin_one(struct memory_files *memory_files, const char *name,
                                      const char *text, const struct mesofit_table *tables,
                                      size_t table_count) {
    return mf_memory_files_begin(memory_files, &(const struct mesofit_text){name, text}, 1, tables,
                                 table_count);
}

void mf_memory_files_end(struct memory_files *memory_files) {
    mf_text_file_set_memory_files(NULL, 0);
    for (size_t k = memory_files->borrowed; k < memory_files->count; k++)
        free((char *)(uintptr_t)memory_files->text[k].text);
    mf_memory_free(memory_files->text);
    *memory_files = (struct memory_files){0};
}
