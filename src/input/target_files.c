// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/target_files.h"

#include "base/digest.h"
#include "base/memory.h"
#include "io/data_table.h"

#include <math.h>
#include <string.h>

/// Origins of escape windows are this many sampling intervals apart in a fit's simulations.
static const double origin_intervals = 10;

/// Window of a D whose motion no other target defines, and its intervals [τ].
static const double default_window = 1.6;
enum { DEFAULT_LAGS = 50 };

#define CURVE(name) .offset = offsetof(struct target_curve_parameters, name)
#define COLUMN .maximum = 1000, .unit = ""
const struct field mf_target_files_curve_fields[] = {
    {"file", FIELD_FILE, CURVE(file), .required = true, .unit = "",
     .help = "values at equally spaced times from 0 on, in units of the scene"},
    {"time_column", FIELD_INTEGER, CURVE(time_column), .initial = 1, .minimum = 1, COLUMN,
     .help = "number of the column with the times, from 1"},
    {"value_column", FIELD_INTEGER, CURVE(value_column), .initial = 2, .minimum = 1, COLUMN,
     .help = "number of the column with the values"},
    {"error_column", FIELD_INTEGER, CURVE(error_column), .initial = -1, .minimum = -1, COLUMN,
     .help = "number of the column with their standard errors; 0: none; -1: 3 if there are so many "
             "columns, else none"},
    FIELD_END,
};

#define NUMBER(name) .offset = offsetof(struct target_number, name)
const struct field mf_target_files_number_fields[] = {
    {"value", FIELD_NUMBER, NUMBER(value), .required = true, .minimum = -DBL_MAX,
     .maximum = DBL_MAX, .unit = "reduced", .help = "measured"},
    {"error", FIELD_NUMBER, NUMBER(error), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "reduced", .help = "its standard error"},
    FIELD_END,
};

const struct field mf_target_files_diffusion_fields[] = {
    {"window", FIELD_NUMBER, NUMBER(window), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "tau",
     .help =
         "D is the slope of the MSD over the second half of it, as the value must be; 0: that of "
         "\"vacf\", \"msd\" or \"etd\" if they are given, else 1.6"},
    FIELD_END,
};

#define USE(name) .offset = offsetof(struct target_use, name)
static const char *const no_or_yes[] = {"no", "yes", NULL};
const struct field mf_target_files_use_fields[] = {
    {"weight", FIELD_NUMBER, USE(weight), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "",
     .help = "of its error beside those of other files; 0: one over its statistical error"},
    {"fitted", FIELD_CHOICE, USE(fitted), .choices = no_or_yes, .initial = 1, .unit = "",
     .help = "no: only compared with the result"},
    FIELD_END,
};

static double cell(const struct data_table *table, size_t row, int64_t column) {
    return table->values[row * table->columns + (size_t)column - 1];
}

/// Times must be 0, h, 2h, … to the digits of the file.
static enum status check_times(const struct target_curve *curve, const struct data_table *table) {
    const struct target_curve_parameters *p = &curve->parameters;
    for (size_t k = 0; k < table->rows; k++)
        if (fabs(cell(table, k, p->time_column) - (double)k * curve->interval) >
            0.01 * curve->interval)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s:%zu: the times are not equally spaced from 0", p->file,
                                  table->line[k]);
    return STATUS_OK;
}

static enum status load_curve(struct target_curve *curve, struct data_table *table) {
    enum status status = STATUS_OK;
    const struct target_curve_parameters *p = &curve->parameters;
    CHECK(mf_data_table_read(
        table, p->file,
        (size_t)(p->time_column > p->value_column ? p->time_column : p->value_column)));
    int64_t error_column;
    CHECK(mf_target_rdf_error_column(p->error_column, p->time_column, p->value_column, table,
                                     p->file, &error_column));
    if (table->rows < 3)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: only %zu times", p->file, table->rows);
    CHECK(mf_data_table_check_increasing(table, p->file, (size_t)p->time_column - 1, 0));
    curve->interval = cell(table, table->rows - 1, p->time_column) / (double)(table->rows - 1);
    CHECK(check_times(curve, table));
    NEW_ARRAY(curve->value, table->rows);
    NEW_ARRAY(curve->error, table->rows);
    curve->times = table->rows;
    for (size_t k = 0; k < table->rows; k++) {
        curve->value[k] = cell(table, k, p->value_column);
        curve->error[k] = error_column ? cell(table, k, error_column) : 0;
        if (!(curve->error[k] >= 0)) {
            status =
                mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: column %lld: %g is not a standard error",
                               p->file, table->line[k], (long long)error_column, curve->error[k]);
            goto done;
        }
    }
done:
    return status;
}

static enum status read_curve(struct target_curve *curve, struct json_object *object) {
    const size_t faults = mf_json_fault_count(object->document);
    mf_json_fields(object, mf_target_files_curve_fields, &curve->parameters);
    mf_json_finish(object);
    if (mf_json_fault_count(object->document) > faults)
        return STATUS_OK;
    struct data_table table = {0};
    const enum status status = load_curve(curve, &table);
    mf_data_table_clear(&table);
    if (status == STATUS_NO_MEMORY)
        return status;
    if (status != STATUS_OK)
        mf_json_fault(object, "file", "%s", mf_status_message());
    return STATUS_OK;
}

static enum status read_number(struct target_number *number, struct json_object *object) {
    mf_json_fields(object, mf_target_files_number_fields, number);
    mf_json_finish(object);
    return STATUS_OK;
}

/// All pair types must have the bins of the first.
static void check_bins(const struct target_files *files, struct json_object *object) {
    const struct rdf_bins *first = &files->rdf[0].bins;
    for (size_t pair = 1; pair < files->pairs; pair++) {
        const struct rdf_bins *bins = &files->rdf[pair].bins;
        char name[COMPOSITION_PAIR_NAME_SIZE], first_name[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(&files->composition, (int)pair, name);
        mf_composition_pair_name(&files->composition, 0, first_name);
        // A file that could not be read has its own fault.
        if (first->count > 0 && bins->count > 0 &&
            (bins->count != first->count || fabs(bins->width / first->width - 1) > 1e-6 ||
             fabs(bins->low - first->low) > 1e-6 * first->width))
            mf_json_fault(object, name, "must have the bins of \"%s\"", first_name);
    }
}

/// What the file calls a pair type: "A-B" or "B-A".
static const char *pair_key(const struct composition *composition, int pair,
                            const struct json_object *object,
                            char name[COMPOSITION_PAIR_NAME_SIZE]) {
    const char *key;
    mf_composition_pair_name(composition, pair, name);
    for (size_t n = 0; (key = mf_json_key(object, n)); n++)
        if (mf_composition_find_pair(composition, key) == pair)
            return key;
    return name;
}

/// g and errors of all pair types in the numbers of the scene, one behind the other, if all
/// could be read.
static enum status collect_rdf(struct target_files *files, const struct box *box) {
    enum status status = STATUS_OK;
    const size_t bins = files->rdf[0].bins.count;
    for (size_t pair = 0; pair < files->pairs; pair++)
        if (files->rdf[pair].bins.count != bins)
            return STATUS_OK;
    NEW_ARRAY(files->rdf_g, files->pairs * bins);
    NEW_ARRAY(files->rdf_error, files->pairs * bins);
    NEW_ARRAY(files->rdf_given, files->pairs * bins);
    for (size_t pair = 0; pair < files->pairs; pair++)
        mf_target_rdf_convert(&files->rdf[pair], box, &files->composition, (int)pair,
                              files->rdf_g + pair * bins, files->rdf_error + pair * bins);
    memcpy(files->rdf_given, files->rdf_g, files->pairs * bins * sizeof(double));
done:
    return status;
}

/// g(r), or in a mixture that of each pair type: {"A-A": {"file": …}, …}.
static enum status read_rdf(struct target_files *files, struct json_object *object,
                            const struct box *box, const struct units *units) {
    if (files->composition.types == 0)
        return STATUS_OK; // a fault of the types is told, those of their pairs would mislead
    if (!composition_is_mixed(&files->composition)) {
        TRY(mf_target_rdf_read(&files->rdf[0], object, units, box->dimensions));
        return collect_rdf(files, box);
    }
    // The object remembers what it was asked for until it is finished.
    char name[COMPOSITION_MOST_PAIRS][COMPOSITION_PAIR_NAME_SIZE];
    for (size_t pair = 0; pair < files->pairs; pair++) {
        struct json_object child = mf_json_child(
            object, pair_key(&files->composition, (int)pair, object, name[pair]), true);
        if (child.item)
            TRY(mf_target_rdf_read(&files->rdf[pair], &child, units, box->dimensions));
    }
    mf_json_finish(object);
    check_bins(files, object);
    return collect_rdf(files, box);
}

/// What belongs to one kind alone.
static enum status read_kind(struct target_files *files, enum target_kind kind,
                             struct json_object *object, const struct box *box,
                             const struct units *units) {
    switch (kind) {
    case TARGET_RDF:
        return read_rdf(files, object, box, units);
    case TARGET_ETD:
        return mf_target_etd_read(&files->etd, object);
    case TARGET_VACF:
        return read_curve(&files->vacf, object);
    case TARGET_MSD:
        return read_curve(&files->msd, object);
    case TARGET_DIFFUSION:
        mf_json_fields(object, mf_target_files_diffusion_fields, &files->diffusion);
        return read_number(&files->diffusion, object);
    case TARGET_PRESSURE:
        return read_number(&files->pressure, object);
    case TARGETS:
        break;
    }
    return STATUS_OK;
}

/// A window of D's own beside a curve that has another.
static void check_window(const struct target_files *files, struct json_object *object) {
    if (files->diffusion.window > 0 &&
        (files->vacf.times > 0 || files->msd.times > 0 || files->given[TARGET_ETD]))
        mf_json_fault(
            object, "diffusion",
            "has a \"window\" of its own beside \"vacf\", \"msd\" or \"etd\", which say it");
}

/// VACF and MSD come from the same samples.
static void check_motion(const struct target_files *files, struct json_object *object) {
    const struct target_curve *vacf = &files->vacf, *msd = &files->msd;
    if (vacf->times > 0 && msd->times > 0 &&
        (vacf->times != msd->times || fabs(vacf->interval / msd->interval - 1) > 1e-3))
        mf_json_fault(object, "msd", "must have the times of \"vacf\"");
}

enum status mf_target_files_read(struct target_files *files, struct json_object *root,
                                 const struct box *box, const struct composition *composition,
                                 const struct units *units) {
    *files = (struct target_files){.composition = *composition,
                                   .pairs = (size_t)mf_composition_pairs(composition)};
    struct json_object object = mf_json_child(root, "target", true);
    if (object.item == NULL)
        return STATUS_OK;
    for (int kind = 0; kind < TARGETS; kind++) {
        struct json_object child = mf_json_child(&object, mf_targets_names[kind], false);
        files->given[kind] = child.item != NULL;
        mf_json_fields(&child, mf_target_files_use_fields, &files->use[kind]);
        if (!files->given[kind])
            continue;
        TRY(read_kind(files, kind, &child, box, units));
    }
    mf_json_finish(&object);
    check_motion(files, &object);
    check_window(files, &object);
    return STATUS_OK;
}

void mf_target_files_clear(struct target_files *files) {
    for (size_t pair = 0; pair < files->pairs; pair++)
        mf_target_rdf_clear(&files->rdf[pair]);
    mf_memory_free(files->rdf_g);
    mf_memory_free(files->rdf_error);
    mf_memory_free(files->rdf_given);
    mf_target_etd_clear(&files->etd);
    mf_memory_free(files->vacf.value);
    mf_memory_free(files->vacf.error);
    mf_memory_free(files->msd.value);
    mf_memory_free(files->msd.error);
    *files = (struct target_files){0};
}

static void write_rdf(const struct target_files *files, struct json_writer *writer) {
    if (!composition_is_mixed(&files->composition)) {
        mf_json_put_fields(writer, mf_target_rdf_fields, &files->rdf[0].parameters);
        return;
    }
    for (size_t pair = 0; pair < files->pairs; pair++) {
        char name[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(&files->composition, (int)pair, name);
        mf_json_begin(writer, name);
        mf_json_put_fields(writer, mf_target_rdf_fields, &files->rdf[pair].parameters);
        mf_json_end(writer);
    }
}

void mf_target_files_write(const struct target_files *files, struct json_writer *writer) {
    const struct {
        const struct field *fields;
        const void *parameters;
    } parts[TARGETS] = {
        [TARGET_ETD] = {mf_target_etd_fields, &files->etd.parameters},
        [TARGET_VACF] = {mf_target_files_curve_fields, &files->vacf.parameters},
        [TARGET_MSD] = {mf_target_files_curve_fields, &files->msd.parameters},
        [TARGET_DIFFUSION] = {mf_target_files_number_fields, &files->diffusion},
        [TARGET_PRESSURE] = {mf_target_files_number_fields, &files->pressure},
    };
    mf_json_begin(writer, "target");
    for (int kind = 0; kind < TARGETS; kind++) {
        if (!files->given[kind])
            continue;
        mf_json_begin(writer, mf_targets_names[kind]);
        if (kind == TARGET_RDF)
            write_rdf(files, writer);
        else
            mf_json_put_fields(writer, parts[kind].fields, parts[kind].parameters);
        if (kind == TARGET_DIFFUSION)
            mf_json_put_fields(writer, mf_target_files_diffusion_fields, &files->diffusion);
        mf_json_put_fields(writer, mf_target_files_use_fields, &files->use[kind]);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

static void digest(const double *values, size_t count, uint64_t *digest) {
    if (values)
        mf_digest_add(digest, values, count * sizeof *values);
}

void mf_target_files_digest(const struct target_files *files, uint64_t *into) {
    const size_t cells = (size_t)(files->etd.grid.times * files->etd.grid.bins);
    digest(files->rdf_g, files->pairs * files->rdf[0].bins.count, into);
    digest(files->rdf_error, files->pairs * files->rdf[0].bins.count, into);
    digest(files->etd.survival, cells, into);
    digest(files->etd.error, cells, into);
    digest(files->vacf.value, files->vacf.times, into);
    digest(files->vacf.error, files->vacf.times, into);
    digest(files->msd.value, files->msd.times, into);
    digest(files->msd.error, files->msd.times, into);
}

/// Window and interval in which motion is measured, by the first target that defines them: D's own
/// comes last, since a curve fixes the times at which it is compared.
static void set_motion(const struct target_files *files, struct targets *targets) {
    const struct target_curve *curve = files->vacf.times > 0 ? &files->vacf : &files->msd;
    targets->motion_lags = DEFAULT_LAGS;
    targets->motion_interval = default_window / DEFAULT_LAGS;
    if (curve->times > 0) {
        targets->motion_lags = curve->times - 1;
        targets->motion_interval = curve->interval;
    } else if (files->given[TARGET_ETD]) {
        targets->motion_lags = (size_t)files->etd.grid.times - 1;
        targets->motion_interval = files->etd.interval;
    } else if (files->diffusion.window > 0) {
        targets->motion_interval = files->diffusion.window / DEFAULT_LAGS;
    }
}

/// Divide g of a pair type.
static void divide(struct target_files *files, size_t pair, double factor) {
    const size_t bins = files->rdf[0].bins.count;
    for (size_t n = pair * bins; n < (pair + 1) * bins; n++) {
        files->rdf_g[n] /= factor;
        files->rdf_error[n] /= factor;
    }
}

enum status mf_target_files_normalise(struct target_files *files, const struct box *box) {
    size_t given = 0;
    double width = 0;
    files->normalisation = (struct normalisation){.factor = 1};
    if (!files->given[TARGET_RDF])
        return STATUS_OK;
    for (size_t pair = 0; pair < files->pairs; pair++) {
        const struct target_rdf_parameters *p = &files->rdf[pair].parameters;
        if (p->normalisation > 0)
            divide(files, pair, p->normalisation);
        given += p->normalisation > 0;
        width = fmax(width, p->normalisation_error);
    }
    // What all together say tells nothing of a part of them.
    if (given > 0)
        return STATUS_OK;
    TRY(mf_normalisation_find(&files->rdf[0].bins, box, &files->composition, files->rdf_g,
                              files->rdf_error, width, &files->normalisation));
    for (size_t pair = 0; pair < files->pairs; pair++)
        divide(files, pair, files->normalisation.factor);
    return STATUS_OK;
}

void mf_target_files_targets(struct target_files *files, bool moves, struct targets *fitted,
                             struct targets *compared) {
    static const double unknown = NAN;
    const struct target_etd *etd = &files->etd;
    *compared = (struct targets){.bins = files->rdf[0].bins,
                                 .etd = etd->grid,
                                 .etd_interval = etd->interval,
                                 .etd_origins = origin_intervals * etd->interval};
    set_motion(files, compared);
    const size_t cells = (size_t)(etd->grid.times * etd->grid.bins);
    const struct target targets[TARGETS] = {
        [TARGET_RDF] = {.count = files->pairs * files->rdf[0].bins.count,
                        .value = files->rdf_g,
                        .error = files->rdf_error},
        [TARGET_ETD] = {.count = cells, .value = etd->survival, .error = etd->error},
        [TARGET_VACF] = {.count = files->vacf.times,
                         .value = files->vacf.value,
                         .error = files->vacf.error},
        [TARGET_MSD] = {.count = files->msd.times,
                        .value = files->msd.value,
                        .error = files->msd.error},
        [TARGET_DIFFUSION] = {.count = 1,
                              .value = &files->diffusion.value,
                              .error = &files->diffusion.error},
        [TARGET_PRESSURE] = {.count = 1,
                             .value = &files->pressure.value,
                             .error = &files->pressure.error},
    };
    for (int kind = 0; kind < TARGETS; kind++) {
        if (!files->given[kind])
            continue;
        compared->target[kind] = targets[kind];
        compared->target[kind].weight = files->use[kind].weight;
    }
    *fitted = *compared;
    for (int kind = 0; kind < TARGETS; kind++)
        if (!files->use[kind].fitted)
            fitted->target[kind] = (struct target){0};
    const bool has_window =
        files->given[TARGET_ETD] || files->given[TARGET_VACF] || files->given[TARGET_MSD];
    if (moves && has_window && !files->given[TARGET_DIFFUSION])
        compared->target[TARGET_DIFFUSION] = (struct target){1, &unknown, &unknown, 0};
}

/// A curve's interval must be a whole number of steps.
static enum status check_interval(const struct target_curve *curve, double time_step) {
    const double steps = curve->interval / time_step;
    if (curve->times == 0 || (steps > 0.5 && fabs(steps / fmax(1, round(steps)) - 1) < 1e-3))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: its interval %.6g is not a whole number of time steps of %g; %.6g "
                          "would do",
                          curve->parameters.file, curve->interval, time_step,
                          curve->interval / fmax(1, ceil(steps)));
}

enum status mf_target_files_check_steps(const struct target_files *files, double time_step) {
    int64_t every;
    if (files->given[TARGET_ETD])
        TRY(mf_target_etd_steps(&files->etd, time_step, &every));
    TRY(check_interval(&files->vacf, time_step));
    return check_interval(&files->msd, time_step);
}
