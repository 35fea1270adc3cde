// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesofit/result.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "io/output.h"
#include "io/text_file.h"
#include "library/guard.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const char ending[] = ".tsv";

/// A table, once it was asked for.
struct table {
    char *name;
    bool read;
    struct data_table data;
    char **names, **units; ///< shape [columns]
    char *comment;
};

/// A text, once it was asked for.
struct text {
    char *file, *content;
    struct text *next;
};

struct mesofit_result {
    char folder[OUTPUT_PATH_SIZE];
    struct table *table; ///< shape [tables]
    size_t tables;
    struct text *texts;
};

// A folder ----------------------------------------------------------------------------------------

static int is_table(const struct dirent *entry) {
    const size_t length = strlen(entry->d_name);
    return length > strlen(ending) && strcmp(entry->d_name + length - strlen(ending), ending) == 0;
}

static int by_name(const void *a, const void *b) {
    return strcmp(((const struct table *)a)->name, ((const struct table *)b)->name);
}

static enum status list_tables(struct mesofit_result *result) {
    enum status status = STATUS_OK;
    struct dirent **entries;
    const int files = scandir(result->folder, &entries, is_table, alphasort);
    if (files < 0)
        return mf_status_fail(STATUS_IO, "%s: %s", result->folder, strerror(errno));
    NEW_ARRAY(result->table, (size_t)files + 1);
    for (int k = 0; k < files; k++) {
        char *name = strdup(entries[k]->d_name);
        if (name == NULL)
            CHECK(mf_status_fail(STATUS_NO_MEMORY, "out of memory"));
        name[strlen(name) - strlen(ending)] = '\0';
        result->table[result->tables++].name = name;
    }
    qsort(result->table, result->tables, sizeof *result->table, by_name);
done:
    for (int k = 0; k < files; k++)
        free(entries[k]);
    free(entries);
    return status;
}

static enum status find_path(const struct mesofit_result *result, const char *file,
                             const char *after, char path[OUTPUT_PATH_SIZE]) {
    const int length = snprintf(path, OUTPUT_PATH_SIZE, "%s/%s%s", result->folder, file, after);
    return length > 0 && length < OUTPUT_PATH_SIZE
               ? STATUS_OK
               : mf_status_fail(STATUS_BAD_INPUT, "%.60s…: the path is too long", result->folder);
}

static enum status open_folder(struct mesofit_result *result, const char *folder) {
    static const char *const sure[] = {"summary.json", "target.json", "used.json"};
    char path[OUTPUT_PATH_SIZE];
    if (folder == NULL || strlen(folder) >= sizeof result->folder)
        return mf_status_fail(STATUS_BAD_INPUT, "a folder without a name, or with too long a one");
    strcpy(result->folder, folder);
    TRY(list_tables(result));
    bool found = result->tables > 0;
    for (size_t k = 0; k < sizeof sure / sizeof *sure && !found; k++) {
        TRY(find_path(result, sure[k], "", path));
        FILE *const stream = fopen(path, "rbe");
        found = stream != NULL;
        if (stream)
            fclose(stream);
    }
    return found ? STATUS_OK
                 : mf_status_fail(STATUS_BAD_INPUT,
                                  "%s holds no results: neither summary.json nor a table", folder);
}

struct mesofit_result *mesofit_result_open(const char *folder) {
    mf_guard_enter();
    struct mesofit_result *result = mf_memory_zeroed(1, sizeof *result);
    if (result && open_folder(result, folder) != STATUS_OK) {
        mesofit_result_free(result);
        result = NULL;
    }
    mf_guard_leave();
    return result;
}

static void clear_table(struct table *table) {
    for (size_t k = 0; table->names && k < table->data.columns; k++)
        free(table->names[k]), free(table->units[k]);
    mf_memory_free(table->names);
    mf_memory_free(table->units);
    free(table->comment);
    mf_data_table_clear(&table->data);
    free(table->name);
}

void mesofit_result_free(struct mesofit_result *result) {
    if (result == NULL)
        return;
    for (size_t k = 0; k < result->tables; k++)
        clear_table(&result->table[k]);
    for (struct text *text = result->texts, *next; text; text = next) {
        next = text->next;
        mf_memory_free(text->content);
        free(text->file);
        free(text);
    }
    mf_memory_free(result->table);
    mf_memory_free(result);
}

const char *mesofit_result_name(const struct mesofit_result *result, size_t number) {
    return number < result->tables ? result->table[number].name : NULL;
}

// Tables ------------------------------------------------------------------------------------------

/// "phi[k_B.T_0]" is a name and a unit, whose blanks the reader has made points. False without
/// memory.
static bool split(const char *word, size_t length, char **name, char **unit) {
    const char *const open = memchr(word, '[', length);
    const size_t named = open ? (size_t)(open - word) : length;
    const bool closed = open && word[length - 1] == ']';
    *name = strndup(word, named);
    *unit = closed ? strndup(open + 1, length - named - 2) : strdup("");
    for (char *letter = *unit; letter && *letter; letter++)
        *letter = *letter == '.' ? ' ' : *letter;
    return *name && *unit;
}

static size_t count_words(const char *header) {
    size_t words = 0;
    for (header += strspn(header, "\t"); *header; header += strspn(header, "\t")) {
        words++;
        header += strcspn(header, "\t");
    }
    return words;
}

/// Columns without names of their own, or fewer than there are, are called by their numbers.
static enum status name_columns(struct table *table) {
    enum status status = STATUS_OK;
    const size_t columns = table->data.columns;
    const char *word = table->data.header ? table->data.header : "";
    const bool named = count_words(word) == columns;
    bool fits = true;
    NEW_ARRAY(table->names, columns);
    NEW_ARRAY(table->units, columns);
    for (size_t k = 0; k < columns; k++) {
        char number[24];
        snprintf(number, sizeof number, "%zu", k + 1);
        word += strspn(word, "\t");
        const size_t length = strcspn(word, "\t");
        fits = split(named ? word : number, named ? length : strlen(number), &table->names[k],
                     &table->units[k]) &&
               fits;
        word += length;
    }
    table->comment = strdup(table->data.comments ? table->data.comments : "");
    if (!fits || table->comment == NULL)
        status = mf_status_fail(STATUS_NO_MEMORY, "out of memory");
done:
    return status;
}

static enum status find_table(struct mesofit_result *result, const char *name,
                              struct table **table) {
    *table = NULL;
    for (size_t k = 0; name && k < result->tables; k++)
        if (strcmp(result->table[k].name, name) == 0)
            *table = &result->table[k];
    return *table ? STATUS_OK
                  : mf_status_fail(STATUS_BAD_INPUT, "%s has no table \"%s\"", result->folder,
                                   name ? name : "");
}

static enum status read_table(struct mesofit_result *result, const char *name,
                              struct mesofit_columns *columns) {
    char path[OUTPUT_PATH_SIZE];
    struct table *table;
    TRY(find_table(result, name, &table));
    TRY(find_path(result, name, ending, path));
    if (!table->read) {
        TRY(mf_data_table_read(&table->data, path, 0));
        TRY(name_columns(table));
    }
    table->read = true;
    *columns = (struct mesofit_columns){.rows = table->data.rows,
                                        .columns = table->data.columns,
                                        .values = table->data.values,
                                        .names = (const char *const *)table->names,
                                        .units = (const char *const *)table->units,
                                        .comment = table->comment};
    return STATUS_OK;
}

enum mesofit_status mesofit_result_table(struct mesofit_result *result, const char *name,
                                         struct mesofit_columns *columns) {
    mf_guard_enter();
    return mf_guard_return(read_table(result, name, columns));
}

// Texts -------------------------------------------------------------------------------------------

static enum status read_text(struct mesofit_result *result, const char *file,
                             const char **content) {
    char path[OUTPUT_PATH_SIZE];
    size_t length;
    for (const struct text *text = result->texts; text; text = text->next)
        if (strcmp(text->file, file) == 0) {
            *content = text->content;
            return STATUS_OK;
        }
    TRY(find_path(result, file, "", path));
    struct text *text = calloc(1, sizeof *text);
    if (text == NULL || (text->file = strdup(file)) == NULL) {
        free(text);
        return mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    }
    const enum status status = mf_text_file_read(path, &text->content, &length);
    if (status != STATUS_OK) {
        free(text->file);
        free(text);
        return status;
    }
    text->next = result->texts;
    result->texts = text;
    *content = text->content;
    return STATUS_OK;
}

const char *mesofit_result_text(struct mesofit_result *result, const char *file) {
    const char *content = NULL;
    mf_guard_enter();
    if (file == NULL)
        mf_status_fail(STATUS_BAD_INPUT, "a file without a name");
    else if (read_text(result, file, &content) != STATUS_OK)
        content = NULL;
    mf_guard_leave();
    return content;
}
