// SPDX-License-Identifier: GPL-3.0-or-later
#include "library/fit_text.h"

#include "base/memory.h"
#include "library/scene_text.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

struct mesofit_fit_options mesofit_fit_options_default(void) {
    return (struct mesofit_fit_options){
        .scene = mesofit_scene_default(), .method = "imc", .find_potential = 1};
}

/// A new table, whose values are zero.
static enum status add_table(struct fit_text *run, const char *name, size_t rows, size_t columns,
                             double **values) {
    enum status status = STATUS_OK;
    NEW_ARRAY(*values, rows * columns);
    run->values[run->tables] = *values;
    run->table[run->tables++] = (struct mesofit_table){name, rows, columns, *values};
done:
    return status;
}

static enum status add_rdf(struct fit_text *run, const struct mesofit_fit_options *options) {
    const size_t columns = options->rdf.error ? 3 : 2;
    double *values;
    if (options->rdf.r == NULL || options->rdf.g == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "rdf: r and g are required");
    TRY(add_table(run, "rdf", options->rdf.count, columns, &values));
    for (size_t k = 0; k < options->rdf.count; k++) {
        values[k * columns] = options->rdf.r[k];
        values[k * columns + 1] = options->rdf.g[k];
        if (options->rdf.error)
            values[k * columns + 2] = options->rdf.error[k];
    }
    return STATUS_OK;
}

/// Times, then a column for each bin.
static enum status add_matrix(struct fit_text *run, const char *name,
                              const struct mesofit_fit_options *options, const double *from) {
    const size_t times = options->etd.times, bins = options->etd.bins, columns = bins + 1;
    double *values;
    TRY(add_table(run, name, times, columns, &values));
    for (size_t t = 0; t < times; t++) {
        values[t * columns] = (double)t * options->etd.interval;
        memcpy(values + t * columns + 1, from + t * bins, bins * sizeof *values);
    }
    return STATUS_OK;
}

static enum status add_tables(struct fit_text *run, const struct mesofit_fit_options *options) {
    if (options->rdf.count > 0)
        TRY(add_rdf(run, options));
    if (options->etd.times == 0)
        return STATUS_OK;
    if (options->etd.survival == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "etd: survival is required");
    TRY(add_matrix(run, "etd", options, options->etd.survival));
    return options->etd.error ? add_matrix(run, "etd_error", options, options->etd.error)
                              : STATUS_OK;
}

static void write_target(const struct mesofit_fit_options *options, FILE *stream) {
    const char *separator = "";
    fputs("\"target\": {", stream);
    if (options->rdf.count > 0) {
        fputs("\"rdf\": {\"file\": \"rdf\"}", stream);
        separator = ", ";
    }
    if (options->etd.times > 0)
        fprintf(stream,
                "%s\"etd\": {\"file\": \"etd\"%s, \"r_minimum\": %.17g, \"r_maximum\": %.17g}",
                separator, options->etd.error ? ", \"error_file\": \"etd_error\"" : "",
                options->etd.r_minimum, options->etd.r_maximum);
    fputs("}, ", stream);
}

static void write_unknowns(const struct mesofit_fit_options *options, FILE *stream) {
    fputs("\"unknowns\": {", stream);
    if (options->find_potential)
        fprintf(stream, "\"potential\": %s", options->potential ? options->potential : "{}");
    if (options->find_friction)
        fprintf(stream, "%s\"omega\": %s", options->find_potential ? ", " : "",
                options->friction ? options->friction : "{}");
    fputs("}, ", stream);
}

/// The name, then the members of the object `settings`.
static enum status write_method(const struct mesofit_fit_options *options, FILE *stream) {
    static const char blanks[] = " \t\r\n";
    const char *settings = options->settings ? options->settings : "{}";
    settings += strspn(settings, blanks);
    if (*settings != '{')
        return mf_status_fail(STATUS_BAD_INPUT, "settings: \"%s\" is not a JSON object", settings);
    const char *first = settings + 1 + strspn(settings + 1, blanks);
    fprintf(stream, "\"method\": {\"name\": \"%s\"%s%s", options->method ? options->method : "",
            *first == '}' ? "" : ", ", first);
    return STATUS_OK;
}

enum status mf_fit_text_write(struct fit_text *run, const struct mesofit_fit_options *options) {
    size_t length;
    *run = (struct fit_text){0};
    TRY(add_tables(run, options));
    FILE *stream = open_memstream(&run->text, &length);
    if (stream == NULL)
        return mf_status_fail(STATUS_NO_MEMORY, "no memory for a fit's text");
    fprintf(stream, "{\"seed\": %" PRIu64 ", ", options->scene.seed);
    write_target(options, stream);
    write_unknowns(options, stream);
    fputs("\"scene\": {", stream);
    mf_scene_text_write(&options->scene, stream);
    fputs("}, ", stream);
    const enum status status = write_method(options, stream);
    fputc('}', stream);
    fclose(stream);
    return status;
}

void mf_fit_text_clear(struct fit_text *run) {
    free(run->text);
    for (size_t k = 0; k < run->tables; k++)
        mf_memory_free(run->values[k]);
    *run = (struct fit_text){0};
}
