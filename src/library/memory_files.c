// SPDX-License-Identifier: GPL-3.0-or-later
#include "library/memory_files.h"

#include "base/memory.h"

static enum status add_text(struct memory_files *memory_files, const struct mesofit_text *text) {
    if (text->name == NULL || text->text == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: there is no text",
                              text->name ? text->name : "a text without a name");
    memory_files->file[memory_files->count++] =
        (struct memory_file){.name = text->name, .text = text->text};
    return STATUS_OK;
}

static enum status add_table(struct memory_files *memory_files, const struct mesofit_table *table,
                             size_t number) {
    if (table->name == NULL || table->values == NULL || table->rows == 0 || table->columns == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "table %zu has no name or no numbers", number);
    memory_files->file[memory_files->count++] = (struct memory_file){.name = table->name,
                                                                     .rows = table->rows,
                                                                     .columns = table->columns,
                                                                     .values = table->values};
    return STATUS_OK;
}

enum status mf_memory_files_begin(struct memory_files *memory_files,
                                  const struct mesofit_text *texts, size_t text_count,
                                  const struct mesofit_table *tables, size_t table_count) {
    enum status status = STATUS_OK;
    *memory_files = (struct memory_files){0};
    NEW_ARRAY(memory_files->file, text_count + table_count + 1);
    for (size_t k = 0; k < text_count; k++)
        CHECK(add_text(memory_files, &texts[k]));
    for (size_t k = 0; k < table_count; k++)
        CHECK(add_table(memory_files, &tables[k], k));
    mf_text_file_set_memory_files(memory_files->file, memory_files->count);
done:
    if (status != STATUS_OK)
        mf_memory_files_end(memory_files);
    return status;
}

void mf_memory_files_end(struct memory_files *memory_files) {
    mf_text_file_set_memory_files(NULL, 0);
    mf_memory_free(memory_files->file);
    *memory_files = (struct memory_files){0};
}
