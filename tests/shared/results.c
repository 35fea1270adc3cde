// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/results.h"
#include "shared/is_close.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include "io/json.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

/// Numbers between tabs in a line; any other word fails the test.
static size_t count_numbers(const char *file, const char *line) {
    size_t count = 0;
    for (;;) {
        char *end;
        strtod(line, &end);
        if (end == line || (*end != '\t' && *end != '\n'))
            fail_msg("%s: \"%.40s\" is not a number", file, line);
        count++;
        if (*end == '\n')
            return count;
        line = end + 1;
    }
}

static size_t count_names(const char *header) {
    size_t count = 1;
    for (; *header && *header != '\n'; header++)
        count += *header == '\t';
    return count;
}

void results_assert_table(const char *file, size_t columns, size_t rows) {
    char *text = temporary_folder_read(file);
    size_t found = 0;
    if (strncmp(text, "# ", 2) != 0)
        fail_msg("%s does not begin with a header", file);
    const char *const second = strchr(text, '\n') + 1;
    const char *const header = strncmp(second, "# ", 2) == 0 ? second : text; // below a comment
    const size_t names = count_names(header);
    if (columns > 0 && names != columns)
        fail_msg("%s has %zu columns, not %zu", file, names, columns);
    for (const char *end = strchr(header, '\n'); end && end[1]; end = strchr(end + 1, '\n')) {
        const size_t numbers = count_numbers(file, end + 1);
        if (numbers != names)
            fail_msg("%s: %zu numbers under %zu names: %.60s", file, numbers, names, end + 1);
        found++;
    }
    if (found == 0 || (rows > 0 && found != rows))
        fail_msg("%s has %zu rows, not %zu", file, found, rows);
    free(text);
}

static bool is_same(const char *first, const char *second, const char *name) {
    char path[2][1024];
    snprintf(path[0], sizeof path[0], "%s/%s", first, name);
    snprintf(path[1], sizeof path[1], "%s/%s", second, name);
    char *a = temporary_folder_read(path[0]), *b = temporary_folder_read(path[1]);
    const bool same = strcmp(a, b) == 0;
    free(a);
    free(b);
    return same;
}

void results_assert_same(const char *first, const char *second, const char *const *names) {
    for (; *names; names++)
        if (!is_same(first, second, *names))
            fail_msg("%s/%s and %s/%s differ", first, *names, second, *names);
}

void results_assert_differ(const char *first, const char *second, const char *name) {
    if (is_same(first, second, name))
        fail_msg("%s/%s and %s/%s are the same", first, name, second, name);
}

/// Read one member of a JSON file into `value`; what else the file holds does not matter.
static void read_member(const char *file, const char *key, enum field_type type, void *value) {
    struct json_document *document;
    const char *last = strrchr(key, '.');
    const struct field fields[] = {{.name = last ? last + 1 : key,
                                    .type = type,
                                    .required = true,
                                    .minimum = -DBL_MAX,
                                    .maximum = DBL_MAX},
                                   FIELD_END};
    assert_ok(mf_json_open(&document, file));
    struct json_object object = mf_json_root(document);
    for (const char *dot; (dot = strchr(key, '.')); key = dot + 1) {
        char outer[64];
        snprintf(outer, sizeof outer, "%.*s", (int)(dot - key), key);
        object = mf_json_child(&object, outer, true);
    }
    mf_json_fields(&object, fields, value);
    assert_ok(mf_json_close(document, STATUS_OK));
}

double results_number(const char *file, const char *key) {
    double value = NAN;
    read_member(file, key, FIELD_NUMBER, &value);
    if (!isfinite(value))
        fail_msg("%s: %s is %g", file, key, value);
    return value;
}

void results_assert_number(const char *file, const char *key, double expected) {
    const double value = results_number(file, key);
    if (!is_identical(value, expected))
        fail_msg("%s: %s is %.17g, not %.17g", file, key, value, expected);
}

void results_assert_numbers(const char *file, const char *const *keys) {
    for (; *keys; keys++)
        results_number(file, *keys);
}

void results_assert_text(const char *file, const char *key, const char *expected) {
    char value[FIELD_TEXT_SIZE];
    read_member(file, key, FIELD_TEXT, value);
    if (strcmp(value, expected) != 0)
        fail_msg("%s: %s is \"%s\", not \"%s\"", file, key, value, expected);
}

double results_parameter(const char *file, const char *name, const char *key) {
    char quoted[96];
    char *text = temporary_folder_read(file);
    char *object = strstr(text, "\"parameters\"");
    assert_non_null(object);
    snprintf(quoted, sizeof quoted, "\"%s\"", name);
    object = strstr(object, quoted);
    assert_non_null(object);
    *strchr(object, '}') = '\0';
    snprintf(quoted, sizeof quoted, "\"%s\"", key);
    const char *at = strstr(object, quoted);
    const double value = at ? strtod(strchr(at, ':') + 1, NULL) : NAN;
    free(text);
    return value;
}
