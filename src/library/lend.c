// SPDX-License-Identifier: GPL-3.0-or-later
#include "library/lend.h"

#include "base/memory.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/// All digits, so that what is read is what was lent.
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

enum status mf_lend_begin(struct lend *lend, const char *name, const char *text,
                          const struct mesofit_table *tables, size_t table_count) {
    enum status status = STATUS_OK;
    *lend = (struct lend){0};
    if (text == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: there is no text", name);
    NEW_ARRAY(lend->text, table_count + 1);
    lend->text[lend->count++] = (struct text_lent){name, text};
    for (size_t k = 0; k < table_count; k++) {
        const struct mesofit_table *table = &tables[k];
        if (table->name == NULL || table->values == NULL || table->rows * table->columns == 0) {
            status = mf_status_fail(STATUS_BAD_INPUT, "table %zu has no name or no numbers", k);
            goto done;
        }
        const char *written = write_table(table);
        if (written == NULL) {
            status =
                mf_status_fail(STATUS_NO_MEMORY, "no memory for the table \"%s\"", table->name);
            goto done;
        }
        lend->text[lend->count++] = (struct text_lent){table->name, written};
    }
    mf_text_file_lend(lend->text, lend->count);
done:
    if (status != STATUS_OK)
        mf_lend_end(lend);
    return status;
}

void mf_lend_end(struct lend *lend) {
    mf_text_file_lend(NULL, 0);
    for (size_t k = 1; k < lend->count; k++)
        free((char *)(uintptr_t)lend->text[k].text);
    mf_memory_free(lend->text);
    *lend = (struct lend){0};
}
