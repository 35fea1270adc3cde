// SPDX-License-Identifier: GPL-3.0-or-later
#include "input/target_files.h"

#include "base/digest.h"
#include "base/memory.h"
#include "observe/kirkwood_buff_observable.h"
#include "observe/rdf_observable.h"

#include <math.h>
#include <string.h>

/// Origins of escape windows are this many sampling intervals apart in a fit's simulations.
static const double origin_intervals = 10;

/// Window of a D whose motion no other target defines, and its intervals [τ].
static const double default_window = 1.6;
enum { DEFAULT_LAGS = 50 };

#define USE(name) .offset = offsetof(struct target_use, name)
static const char *const no_or_yes[] = {"no", "yes", NULL};
const struct field mf_target_files_use_fields[] = {
    {"weight", FIELD_NUMBER, USE(weight), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "", .help = "weight of this target; 0: one over its statistical error"},
    {"fitted", FIELD_CHOICE, USE(fitted), .choices = no_or_yes, .initial = 1, .unit = "",
     .help = "no: only compared with the result"},
    FIELD_END,
};

/// Settings that stand beside the values. Two targets of one observable must say the same.
static enum status read_settings(struct target_files *files, const struct observable_kind *kind,
                                 struct json_object *object) {
    const struct observable *observable = kind->observable;
    void *settings = mf_memory_zeroed(1, observable->settings_size);
    if (settings == NULL)
        return STATUS_NO_MEMORY;
    mf_json_fields(object, observable->fields, settings);
    void **kept = &files->settings[kind->place];
    if (*kept && memcmp(*kept, settings, observable->settings_size) != 0)
        mf_json_fault(object, kind->target->name, "must have the settings of the previous target");
    mf_memory_free(*kept);
    *kept = settings;
    return STATUS_OK;
}

/// p of each group, and what is to be measured for them.
static enum status read_groups(struct target_files *files, const struct observable_kind *kind,
                               int order, struct json_object *object, const struct box *box,
                               const struct molecules *molecules, const struct units *units) {
    struct bonded_settings *settings = mf_memory_zeroed(1, sizeof *settings);
    if (settings == NULL)
        return STATUS_NO_MEMORY;
    files->settings[kind->place] = settings;
    if (files->composition.types == 0)
        return STATUS_OK; // a fault of the molecules is told, those of their groups would mislead
    TRY(mf_target_groups_read(&files->groups[order], order, object, molecules, units,
                              box->dimensions));
    *settings = mf_target_groups_settings(&files->groups[order]);
    return STATUS_OK;
}

enum status mf_target_files_widen(struct target_files *files, int order, size_t group,
                                  const struct bonded_bins *bins) {
    const int place = mf_observable_kind(mf_bonded_distribution_kind(order)).place;
    struct bonded_settings *settings = files->settings[place];
    TRY(mf_target_groups_widen(&files->groups[order], group, bins));
    *settings = mf_target_groups_settings(&files->groups[order]);
    return STATUS_OK;
}

/// g of different molecules, and the bins in which it is measured.
static enum status read_apart(struct target_files *files, size_t place, struct json_object *object,
                              const struct finite_size_fluid *fluid, const struct units *units) {
    struct rdf_settings *settings = mf_memory_zeroed(1, sizeof *settings);
    if (settings == NULL)
        return STATUS_NO_MEMORY;
    files->settings[place] = settings;
    TRY(mf_target_pairs_read(&files->apart, object, fluid, units));
    *settings = (struct rdf_settings){.of_target = true,
                                      .estimator = RDF_FORCE_NOT_USED,
                                      .target = *target_pairs_bins(&files->apart)};
    return STATUS_OK;
}

static enum status read_kind(struct target_files *files, int number, struct json_object *object,
                             const struct box *box, const struct molecules *molecules,
                             const struct units *units) {
    const struct observable_kind kind = mf_observable_kind(number);
    const enum observable_form form = kind.target->form;
    const int order = mf_bonded_distribution_order(number);
    if (order < BONDED_KINDS)
        return read_groups(files, &kind, order, object, box, molecules, units);
    if (kind.target->has_settings)
        TRY(read_settings(files, &kind, object));
    const struct finite_size_fluid fluid = {.box = box,
                                            .composition = &files->composition,
                                            .topology = molecules ? &molecules->topology : NULL,
                                            .apart = number == mf_rdf_intermolecular_kind()};
    if (number == TARGET_RDF)
        return mf_target_pairs_read(&files->rdf, object, &fluid, units);
    if (fluid.apart)
        return read_apart(files, kind.place, object, &fluid, units);
    if (number == TARGET_ETD)
        return mf_target_etd_read(&files->etd, object);
    if (number == mf_kirkwood_buff_kind()) {
        mf_target_kirkwood_buff_read(&files->kirkwood_buff, object, &files->composition,
                                     molecules ? &molecules->topology : NULL);
        return STATUS_OK;
    }
    if (form != OBSERVABLE_NUMBER)
        return mf_target_curve_read(&files->curve[number], kind.target, object);
    if (number == TARGET_DIFFUSION)
        mf_json_fields(object, mf_target_curve_diffusion_fields, &files->number[number]);
    struct field fields[TARGET_NUMBER_FIELDS];
    mf_target_curve_number_fields_of(kind.target->unit, fields);
    mf_json_fields(object, fields, &files->number[number]);
    mf_json_finish(object);
    return STATUS_OK;
}

/// A window of D's own beside a curve that has another.
static void check_window(const struct target_files *files, struct json_object *object) {
    if (files->number[TARGET_DIFFUSION].window > 0 &&
        (files->curve[TARGET_VACF].points > 0 || files->curve[TARGET_MSD].points > 0 ||
         files->given[TARGET_ETD]))
        mf_json_fault(object, "diffusion",
                      "\"window\" is set by \"vacf\", \"msd\" or \"etd\"; leave it out");
}

/// VACF and MSD come from the same samples.
static void check_motion(const struct target_files *files, struct json_object *object) {
    const struct target_curve *vacf = &files->curve[TARGET_VACF], *msd = &files->curve[TARGET_MSD];
    if (vacf->points > 0 && msd->points > 0 &&
        (vacf->points != msd->points || fabs(vacf->interval / msd->interval - 1) > 1e-3))
        mf_json_fault(object, "msd", "must have the times of \"vacf\"");
}

enum status mf_target_files_read(struct target_files *files, struct json_object *root,
                                 const struct box *box, const struct composition *composition,
                                 const struct molecules *molecules, const struct units *units) {
    *files = (struct target_files){.composition = *composition,
                                   .pairs = (size_t)mf_composition_pairs(composition)};
    struct json_object object = mf_json_child(root, "target", true);
    if (object.item == NULL)
        return STATUS_OK;
    for (int kind = 0; mf_targets_name(kind); kind++) {
        const bool is_number = mf_observable_kind(kind).target->form == OBSERVABLE_NUMBER ||
                               kind == mf_kirkwood_buff_kind();
        struct json_object child =
            mf_json_child_of(&object, mf_targets_name(kind), false, is_number ? "value" : "file");
        files->given[kind] = child.item != NULL;
        mf_json_fields(&child, mf_target_files_use_fields, &files->use[kind]);
        if (!files->given[kind])
            continue;
        TRY(read_kind(files, kind, &child, box, molecules, units));
    }
    mf_json_finish(&object);
    check_motion(files, &object);
    check_window(files, &object);
    return STATUS_OK;
}

void mf_target_files_clear(struct target_files *files) {
    mf_target_pairs_clear(&files->rdf);
    mf_target_pairs_clear(&files->apart);
    mf_target_etd_clear(&files->etd);
    for (int order = 0; order < BONDED_KINDS; order++)
        mf_target_groups_clear(&files->groups[order]);
    for (int kind = 0; kind < TARGETS; kind++)
        mf_target_curve_clear(&files->curve[kind]);
    for (size_t place = 0; place < OBSERVABLES_MOST; place++)
        mf_memory_free(files->settings[place]);
    *files = (struct target_files){0};
}

static void write_number(const struct target_number *number, const char *unit,
                         struct json_writer *writer) {
    struct field fields[TARGET_NUMBER_FIELDS];
    mf_target_curve_number_fields_of(unit, fields);
    mf_json_put_fields(writer, fields, number);
}

static void write_kind(const struct target_files *files, int number, struct json_writer *writer) {
    const struct observable_kind kind = mf_observable_kind(number);
    const enum observable_form form = kind.target->form;
    if (kind.target->has_settings)
        mf_json_put_fields(writer, kind.observable->fields, files->settings[kind.place]);
    const int order = mf_bonded_distribution_order(number);
    if (order < BONDED_KINDS)
        mf_target_groups_write(&files->groups[order], writer);
    else if (number == TARGET_RDF)
        mf_target_pairs_write(&files->rdf, &files->composition, writer);
    else if (number == mf_rdf_intermolecular_kind())
        mf_target_pairs_write(&files->apart, &files->composition, writer);
    else if (number == TARGET_ETD)
        mf_json_put_fields(writer, mf_target_etd_fields, &files->etd.parameters);
    else if (number == mf_kirkwood_buff_kind())
        mf_target_kirkwood_buff_write(&files->kirkwood_buff, writer);
    else if (form == OBSERVABLE_NUMBER)
        write_number(&files->number[number], kind.target->unit, writer);
    else
        mf_json_put_fields(writer, mf_target_curve_fields_of(form),
                           &files->curve[number].parameters);
    if (number == TARGET_DIFFUSION)
        mf_json_put_fields(writer, mf_target_curve_diffusion_fields, &files->number[number]);
}

void mf_target_files_write(const struct target_files *files, struct json_writer *writer) {
    mf_json_begin(writer, "target");
    for (int kind = 0; mf_targets_name(kind); kind++) {
        if (!files->given[kind])
            continue;
        mf_json_begin(writer, mf_targets_name(kind));
        write_kind(files, kind, writer);
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
    digest(files->rdf.g, target_pairs_values(&files->rdf), into);
    digest(files->rdf.error, target_pairs_values(&files->rdf), into);
    digest(files->apart.g, target_pairs_values(&files->apart), into);
    digest(files->apart.error, target_pairs_values(&files->apart), into);
    digest(files->etd.survival, cells, into);
    digest(files->etd.error, cells, into);
    for (int order = 0; order < BONDED_KINDS; order++) {
        const struct target_groups *groups = &files->groups[order];
        digest(groups->value, groups->first[groups->groups], into);
        digest(groups->error, groups->first[groups->groups], into);
    }
    for (int kind = 0; kind < TARGETS; kind++) {
        const struct target_curve *curve = &files->curve[kind];
        digest(curve->x, curve->points, into);
        digest(curve->value, curve->points, into);
        digest(curve->error, curve->points, into);
    }
}

/// Window and interval in which motion is measured, by the first target that defines them: D's own
/// comes last, since a curve fixes the times at which it is compared.
static void set_motion(const struct target_files *files, struct targets *targets) {
    const struct target_curve *vacf = &files->curve[TARGET_VACF];
    const struct target_curve *curve = vacf->points > 0 ? vacf : &files->curve[TARGET_MSD];
    const double window = files->number[TARGET_DIFFUSION].window;
    targets->motion_lags = DEFAULT_LAGS;
    targets->motion_interval = default_window / DEFAULT_LAGS;
    if (curve->points > 0) {
        targets->motion_lags = curve->points - 1;
        targets->motion_interval = curve->interval;
    } else if (files->given[TARGET_ETD]) {
        targets->motion_lags = (size_t)files->etd.grid.times - 1;
        targets->motion_interval = files->etd.interval;
    } else if (window > 0) {
        targets->motion_interval = window / DEFAULT_LAGS;
    }
}

/// What is not known of the factor of a pair type: nothing where the file says it, or of how many
/// particles g is, by whose pairs it is normalised then; the error of one that was found; else that
/// of one particle more or less, as by N for N − 1.
static double find_factor_error(const struct target_files *files, int pair) {
    const struct target_rdf_parameters *p = &files->rdf.member[pair].parameters;
    int type[2];
    if (p->normalisation > 0 || p->particles > 0 ||
        !mf_composition_has_pairs(&files->composition, pair))
        return 0;
    if (files->normalisation.found)
        return files->normalisation.error;
    mf_composition_pair_types(&files->composition, pair, type);
    return 1 / (double)(files->composition.count[type[0]] > files->composition.count[type[1]]
                            ? files->composition.count[type[0]]
                            : files->composition.count[type[1]]);
}

enum status mf_target_files_normalise(struct target_files *files, const struct box *box,
                                      bool joined) {
    struct target_pairs *rdf = &files->rdf;
    double width = 0;
    files->normalisation = (struct normalisation){.factor = 1};
    mf_target_pairs_normalise(&files->apart);
    const size_t given = mf_target_pairs_normalise(rdf);
    if (!files->given[TARGET_RDF])
        return STATUS_OK;
    for (size_t pair = 0; pair < rdf->pairs; pair++)
        width = fmax(width, rdf->member[pair].parameters.normalisation_error);
    // What all together say tells nothing of a part of them.
    if (given == 0 && !joined)
        TRY(mf_normalisation_find(target_pairs_bins(rdf), box, &files->composition, rdf->g,
                                  rdf->error, width, &files->normalisation));
    for (size_t pair = 0; pair < rdf->pairs; pair++) {
        mf_target_pairs_divide(rdf, pair, files->normalisation.factor);
        rdf->factor_error[pair] = find_factor_error(files, (int)pair);
    }
    return STATUS_OK;
}

static struct target target_of_pairs(const struct target_pairs *pairs) {
    return (struct target){.count = target_pairs_values(pairs),
                           .value = pairs->g,
                           .error = pairs->error,
                           .factor_error = pairs->factor_error};
}

static struct target target_of(const struct target_files *files, int kind) {
    const struct target_curve *curve = &files->curve[kind];
    const struct target_number *number = &files->number[kind];
    const enum observable_form form = mf_observable_kind(kind).target->form;
    const int order = mf_bonded_distribution_order(kind);
    if (order < BONDED_KINDS)
        return (struct target){.count = files->groups[order].first[files->groups[order].groups],
                               .value = files->groups[order].value,
                               .error = files->groups[order].error,
                               .block = files->groups[order].block,
                               .blocks = files->groups[order].blocks};
    if (kind == TARGET_RDF)
        return target_of_pairs(&files->rdf);
    if (kind == mf_rdf_intermolecular_kind())
        return target_of_pairs(&files->apart);
    if (kind == TARGET_ETD)
        return (struct target){.count = (size_t)(files->etd.grid.times * files->etd.grid.bins),
                               .value = files->etd.survival,
                               .error = files->etd.error,
                               .columns = (size_t)files->etd.grid.bins};
    if (kind == mf_kirkwood_buff_kind())
        return (struct target){.count = files->kirkwood_buff.pairs,
                               .value = files->kirkwood_buff.value,
                               .error = files->kirkwood_buff.error};
    if (form == OBSERVABLE_NUMBER)
        return (struct target){.count = 1, .value = &number->value, .error = &number->error};
    return (struct target){.count = curve->points,
                           .value = curve->value,
                           .error = curve->error,
                           .x = form == OBSERVABLE_CURVE ? curve->x : NULL};
}

void mf_target_files_targets(struct target_files *files, bool moves, struct targets *fitted,
                             struct targets *compared) {
    static const double unknown = NAN;
    const struct target_etd *etd = &files->etd;
    *compared = (struct targets){.bins = *target_pairs_bins(&files->rdf),
                                 .etd = etd->grid,
                                 .etd_interval = etd->interval,
                                 .etd_origins = origin_intervals * etd->interval};
    set_motion(files, compared);
    memcpy(compared->settings, files->settings, sizeof files->settings);
    for (int kind = 0; mf_targets_name(kind); kind++) {
        if (!files->given[kind])
            continue;
        compared->target[kind] = target_of(files, kind);
        compared->target[kind].weight = files->use[kind].weight;
    }
    *fitted = *compared;
    for (int kind = 0; kind < TARGETS; kind++)
        if (!files->use[kind].fitted)
            fitted->target[kind] = (struct target){0};
    const bool has_window =
        files->given[TARGET_ETD] || files->given[TARGET_VACF] || files->given[TARGET_MSD];
    if (moves && has_window && !files->given[TARGET_DIFFUSION])
        compared->target[TARGET_DIFFUSION] =
            (struct target){.count = 1, .value = &unknown, .error = &unknown};
}

enum status mf_target_files_check_steps(const struct target_files *files, double time_step) {
    int64_t every;
    if (files->given[TARGET_ETD])
        TRY(mf_target_etd_steps(&files->etd, time_step, &every));
    for (int kind = 0; kind < TARGETS; kind++)
        TRY(mf_target_curve_check_steps(&files->curve[kind], time_step));
    return STATUS_OK;
}
