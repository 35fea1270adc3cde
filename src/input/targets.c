// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/targets.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "io/checkpoint.h"

#include <math.h>
#include <string.h>

/// Origins of escape windows are this many sampling intervals apart in a fit's simulations.
static const double origin_intervals = 10;

/// Window of a D whose motion no other target defines, and its intervals [τ].
static const double default_window = 1.6;
enum { DEFAULT_LAGS = 50 };

#define CURVE(name) .offset = offsetof(struct target_curve_parameters, name)
#define COLUMN .maximum = 1000, .unit = ""
const struct field mf_targets_curve_fields[] = {
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
const struct field mf_targets_number_fields[] = {
    {"value", FIELD_NUMBER, NUMBER(value), .required = true, .minimum = -DBL_MAX,
     .maximum = DBL_MAX, .unit = "reduced", .help = "measured"},
    {"error", FIELD_NUMBER, NUMBER(error), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "reduced", .help = "its standard error"},
    FIELD_END,
};

const struct field mf_targets_diffusion_fields[] = {
    {"window", FIELD_NUMBER, NUMBER(window), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "tau",
     .help =
         "D is the slope of the MSD over the second half of it, as the value must be; 0: that of "
         "\"vacf\", \"msd\" or \"etd\" if they are given, else 1.6"},
    FIELD_END,
};

#define GOAL(name) .offset = offsetof(struct target_goal, name)
static const char *const no_or_yes[] = {"no", "yes", NULL};
const struct field mf_targets_goal_fields[] = {
    {"weight", FIELD_NUMBER, GOAL(weight), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "",
     .help = "of its error beside those of other targets; 0: one over its statistical error"},
    {"fitted", FIELD_CHOICE, GOAL(fitted), .choices = no_or_yes, .initial = 1, .unit = "",
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
    CHECK(mf_target_error_column(p->error_column, p->time_column, p->value_column, table, p->file,
                                 &error_column));
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
    mf_json_fields(object, mf_targets_curve_fields, &curve->parameters);
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
    mf_json_fields(object, mf_targets_number_fields, number);
    mf_json_finish(object);
    return STATUS_OK;
}

/// All kinds of pairs must have the bins of the first.
static void check_bins(const struct targets *targets, struct json_object *object) {
    const struct rdf_bins *first = &targets->rdf[0].bins;
    for (size_t pair = 1; pair < targets->pairs; pair++) {
        const struct rdf_bins *bins = &targets->rdf[pair].bins;
        char name[COMPOSITION_PAIR_NAME_SIZE], first_name[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(&targets->composition, (int)pair, name);
        mf_composition_pair_name(&targets->composition, 0, first_name);
        // A file that could not be read has its own fault.
        if (first->count > 0 && bins->count > 0 &&
            (bins->count != first->count || fabs(bins->width / first->width - 1) > 1e-6 ||
             fabs(bins->low - first->low) > 1e-6 * first->width))
            mf_json_fault(object, name, "must have the bins of \"%s\"", first_name);
    }
}

/// What the file calls a kind of pairs: "A-B" or "B-A".
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

/// g and errors of all kinds of pairs in the numbers of the scene, one behind the other, if all
/// could be read.
static enum status collect_rdf(struct targets *targets, const struct box *box) {
    enum status status = STATUS_OK;
    const size_t bins = targets->rdf[0].bins.count;
    for (size_t pair = 0; pair < targets->pairs; pair++)
        if (targets->rdf[pair].bins.count != bins)
            return STATUS_OK;
    NEW_ARRAY(targets->rdf_g, targets->pairs * bins);
    NEW_ARRAY(targets->rdf_error, targets->pairs * bins);
    NEW_ARRAY(targets->rdf_given, targets->pairs * bins);
    for (size_t pair = 0; pair < targets->pairs; pair++)
        mf_target_convert(&targets->rdf[pair], box, &targets->composition, (int)pair,
                          targets->rdf_g + pair * bins, targets->rdf_error + pair * bins);
    memcpy(targets->rdf_given, targets->rdf_g, targets->pairs * bins * sizeof(double));
done:
    return status;
}

/// g(r), or in a mixture that of each kind of pairs: {"A-A": {"file": …}, …}.
static enum status read_rdf(struct targets *targets, struct json_object *object,
                            const struct box *box, const struct units *units) {
    if (targets->composition.types == 0)
        return STATUS_OK; // a fault of the types is told, those of their pairs would mislead
    if (!composition_is_mixed(&targets->composition)) {
        TRY(mf_target_read(&targets->rdf[0], object, units, box->dimensions));
        return collect_rdf(targets, box);
    }
    // The object remembers what it was asked for until it is finished.
    char name[COMPOSITION_MOST_PAIRS][COMPOSITION_PAIR_NAME_SIZE];
    for (size_t pair = 0; pair < targets->pairs; pair++) {
        struct json_object child = mf_json_child(
            object, pair_key(&targets->composition, (int)pair, object, name[pair]), true);
        if (child.item)
            TRY(mf_target_read(&targets->rdf[pair], &child, units, box->dimensions));
    }
    mf_json_finish(object);
    check_bins(targets, object);
    return collect_rdf(targets, box);
}

/// What belongs to one kind alone.
static enum status read_kind(struct targets *targets, enum goal_kind kind,
                             struct json_object *object, const struct box *box,
                             const struct units *units) {
    switch (kind) {
    case GOAL_RDF:
        return read_rdf(targets, object, box, units);
    case GOAL_ETD:
        return mf_target_etd_read(&targets->etd, object);
    case GOAL_VACF:
        return read_curve(&targets->vacf, object);
    case GOAL_MSD:
        return read_curve(&targets->msd, object);
    case GOAL_DIFFUSION:
        mf_json_fields(object, mf_targets_diffusion_fields, &targets->diffusion);
        return read_number(&targets->diffusion, object);
    case GOAL_PRESSURE:
        return read_number(&targets->pressure, object);
    case GOALS:
        break;
    }
    return STATUS_OK;
}

/// A window of D's own beside a curve that has another.
static void check_window(const struct targets *targets, struct json_object *object) {
    if (targets->diffusion.window > 0 &&
        (targets->vacf.times > 0 || targets->msd.times > 0 || targets->given[GOAL_ETD]))
        mf_json_fault(
            object, "diffusion",
            "has a \"window\" of its own beside \"vacf\", \"msd\" or \"etd\", which say it");
}

/// VACF and MSD come from the same samples.
static void check_motion(const struct targets *targets, struct json_object *object) {
    const struct target_curve *vacf = &targets->vacf, *msd = &targets->msd;
    if (vacf->times > 0 && msd->times > 0 &&
        (vacf->times != msd->times || fabs(vacf->interval / msd->interval - 1) > 1e-3))
        mf_json_fault(object, "msd", "must have the times of \"vacf\"");
}

enum status mf_targets_read(struct targets *targets, struct json_object *root,
                            const struct box *box, const struct composition *composition,
                            const struct units *units) {
    *targets = (struct targets){.composition = *composition,
                                .pairs = (size_t)mf_composition_pairs(composition)};
    struct json_object object = mf_json_child(root, "target", true);
    if (object.item == NULL)
        return STATUS_OK;
    for (int kind = 0; kind < GOALS; kind++) {
        struct json_object child = mf_json_child(&object, mf_goals_names[kind], false);
        targets->given[kind] = child.item != NULL;
        mf_json_fields(&child, mf_targets_goal_fields, &targets->goal[kind]);
        if (!targets->given[kind])
            continue;
        TRY(read_kind(targets, kind, &child, box, units));
    }
    mf_json_finish(&object);
    check_motion(targets, &object);
    check_window(targets, &object);
    return STATUS_OK;
}

void mf_targets_clear(struct targets *targets) {
    for (size_t pair = 0; pair < targets->pairs; pair++)
        mf_target_clear(&targets->rdf[pair]);
    mf_memory_free(targets->rdf_g);
    mf_memory_free(targets->rdf_error);
    mf_memory_free(targets->rdf_given);
    mf_target_etd_clear(&targets->etd);
    mf_memory_free(targets->vacf.value);
    mf_memory_free(targets->vacf.error);
    mf_memory_free(targets->msd.value);
    mf_memory_free(targets->msd.error);
    *targets = (struct targets){0};
}

static void write_rdf(const struct targets *targets, struct json_writer *writer) {
    if (!composition_is_mixed(&targets->composition)) {
        mf_json_put_fields(writer, mf_target_fields, &targets->rdf[0].parameters);
        return;
    }
    for (size_t pair = 0; pair < targets->pairs; pair++) {
        char name[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(&targets->composition, (int)pair, name);
        mf_json_begin(writer, name);
        mf_json_put_fields(writer, mf_target_fields, &targets->rdf[pair].parameters);
        mf_json_end(writer);
    }
}

void mf_targets_write(const struct targets *targets, struct json_writer *writer) {
    const struct {
        const struct field *fields;
        const void *parameters;
    } parts[GOALS] = {
        [GOAL_ETD] = {mf_target_etd_fields, &targets->etd.parameters},
        [GOAL_VACF] = {mf_targets_curve_fields, &targets->vacf.parameters},
        [GOAL_MSD] = {mf_targets_curve_fields, &targets->msd.parameters},
        [GOAL_DIFFUSION] = {mf_targets_number_fields, &targets->diffusion},
        [GOAL_PRESSURE] = {mf_targets_number_fields, &targets->pressure},
    };
    mf_json_begin(writer, "target");
    for (int kind = 0; kind < GOALS; kind++) {
        if (!targets->given[kind])
            continue;
        mf_json_begin(writer, mf_goals_names[kind]);
        if (kind == GOAL_RDF)
            write_rdf(targets, writer);
        else
            mf_json_put_fields(writer, parts[kind].fields, parts[kind].parameters);
        if (kind == GOAL_DIFFUSION)
            mf_json_put_fields(writer, mf_targets_diffusion_fields, &targets->diffusion);
        mf_json_put_fields(writer, mf_targets_goal_fields, &targets->goal[kind]);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

static void digest(const double *values, size_t count, uint64_t *digest) {
    if (values)
        mf_checkpoint_digest_add(digest, values, count * sizeof *values);
}

void mf_targets_digest(const struct targets *targets, uint64_t *into) {
    const size_t cells = (size_t)(targets->etd.grid.times * targets->etd.grid.bins);
    digest(targets->rdf_g, targets->pairs * targets->rdf[0].bins.count, into);
    digest(targets->rdf_error, targets->pairs * targets->rdf[0].bins.count, into);
    digest(targets->etd.survival, cells, into);
    digest(targets->etd.error, cells, into);
    digest(targets->vacf.value, targets->vacf.times, into);
    digest(targets->vacf.error, targets->vacf.times, into);
    digest(targets->msd.value, targets->msd.times, into);
    digest(targets->msd.error, targets->msd.times, into);
}

/// Window and interval in which motion is measured, by the first target that defines them: D's own
/// comes last, since a curve fixes the times at which it is compared.
static void set_motion(const struct targets *targets, struct goals *goals) {
    const struct target_curve *curve = targets->vacf.times > 0 ? &targets->vacf : &targets->msd;
    goals->motion_lags = DEFAULT_LAGS;
    goals->motion_interval = default_window / DEFAULT_LAGS;
    if (curve->times > 0) {
        goals->motion_lags = curve->times - 1;
        goals->motion_interval = curve->interval;
    } else if (targets->given[GOAL_ETD]) {
        goals->motion_lags = (size_t)targets->etd.grid.times - 1;
        goals->motion_interval = targets->etd.interval;
    } else if (targets->diffusion.window > 0) {
        goals->motion_interval = targets->diffusion.window / DEFAULT_LAGS;
    }
}

/// Divide g of a kind of pairs.
static void divide(struct targets *targets, size_t pair, double factor) {
    const size_t bins = targets->rdf[0].bins.count;
    for (size_t n = pair * bins; n < (pair + 1) * bins; n++) {
        targets->rdf_g[n] /= factor;
        targets->rdf_error[n] /= factor;
    }
}

enum status mf_targets_normalise(struct targets *targets, const struct box *box) {
    size_t given = 0;
    double width = 0;
    targets->normalisation = (struct normalisation){.factor = 1};
    if (!targets->given[GOAL_RDF])
        return STATUS_OK;
    for (size_t pair = 0; pair < targets->pairs; pair++) {
        const struct target_parameters *p = &targets->rdf[pair].parameters;
        if (p->normalisation > 0)
            divide(targets, pair, p->normalisation);
        given += p->normalisation > 0;
        width = fmax(width, p->normalisation_error);
    }
    // What all together say tells nothing of a part of them.
    if (given > 0)
        return STATUS_OK;
    TRY(mf_normalisation_find(&targets->rdf[0].bins, box, &targets->composition, targets->rdf_g,
                              targets->rdf_error, width, &targets->normalisation));
    for (size_t pair = 0; pair < targets->pairs; pair++)
        divide(targets, pair, targets->normalisation.factor);
    return STATUS_OK;
}

void mf_targets_goals(struct targets *targets, bool moves, struct goals *fitted,
                      struct goals *compared) {
    static const double unknown = NAN;
    const struct target_etd *etd = &targets->etd;
    *compared = (struct goals){.bins = targets->rdf[0].bins,
                               .etd = etd->grid,
                               .etd_interval = etd->interval,
                               .etd_origins = origin_intervals * etd->interval};
    set_motion(targets, compared);
    const size_t cells = (size_t)(etd->grid.times * etd->grid.bins);
    const struct goal goals[GOALS] = {
        [GOAL_RDF] = {.count = targets->pairs * targets->rdf[0].bins.count,
                      .value = targets->rdf_g,
                      .error = targets->rdf_error},
        [GOAL_ETD] = {.count = cells, .value = etd->survival, .error = etd->error},
        [GOAL_VACF] = {.count = targets->vacf.times,
                       .value = targets->vacf.value,
                       .error = targets->vacf.error},
        [GOAL_MSD] = {.count = targets->msd.times,
                      .value = targets->msd.value,
                      .error = targets->msd.error},
        [GOAL_DIFFUSION] = {.count = 1,
                            .value = &targets->diffusion.value,
                            .error = &targets->diffusion.error},
        [GOAL_PRESSURE] = {.count = 1,
                           .value = &targets->pressure.value,
                           .error = &targets->pressure.error},
    };
    for (int kind = 0; kind < GOALS; kind++) {
        if (!targets->given[kind])
            continue;
        compared->goal[kind] = goals[kind];
        compared->goal[kind].weight = targets->goal[kind].weight;
    }
    *fitted = *compared;
    for (int kind = 0; kind < GOALS; kind++)
        if (!targets->goal[kind].fitted)
            fitted->goal[kind] = (struct goal){0};
    const bool has_window =
        targets->given[GOAL_ETD] || targets->given[GOAL_VACF] || targets->given[GOAL_MSD];
    if (moves && has_window && !targets->given[GOAL_DIFFUSION])
        compared->goal[GOAL_DIFFUSION] = (struct goal){1, &unknown, &unknown, 0};
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

enum status mf_targets_check_steps(const struct targets *targets, double time_step) {
    int64_t every;
    if (targets->given[GOAL_ETD])
        TRY(mf_target_etd_steps(&targets->etd, time_step, &every));
    TRY(check_interval(&targets->vacf, time_step));
    return check_interval(&targets->msd, time_step);
}
