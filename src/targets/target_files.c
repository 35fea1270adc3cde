// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_files.h"

#include "base/digest.h"
#include "base/memory.h"

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

/// The records; each file defines its own, and only the list below names them.
extern const struct target_record mf_target_pairs, mf_target_etd, mf_target_groups;
extern const struct target_record mf_target_curve_of_time, mf_target_curve, mf_target_number;
extern const struct target_record mf_target_kirkwood_buff, mf_target_diffusion;

/// In the order of `mesofit describe`.
const struct target_record *const mf_target_records[] = {
    &mf_target_pairs,         &mf_target_etd,       &mf_target_groups,
    &mf_target_curve_of_time, &mf_target_curve,     &mf_target_number,
    &mf_target_kirkwood_buff, &mf_target_diffusion, NULL,
};

// Forces ------------------------------------------------------------------------------------------

#define MEMBER(name) .offset = offsetof(struct target_forces_files, name)
const struct field mf_target_forces_fields[] = {
    {"file", FIELD_FILE, MEMBER(file), .required = true, .unit = "", .help = "forces.tsv"},
    {"gram_file", FIELD_FILE, MEMBER(gram_file), .required = true, .unit = "",
     .help = "forces_gram.tsv"},
    FIELD_END,
};

/// Read the object "forces", if there is one. Faults go to the document.
static enum status read_forces(struct target_forces *forces, struct json_object *target,
                               const struct units *units) {
    static const double joules = 1e-3 * UNITS_BOLTZMANN * UNITS_AVOGADRO; // kJ/mol of a kelvin
    struct json_object object = mf_json_child_of(target, "forces", false, "file");
    const size_t faults = mf_json_fault_count(target->document);
    if (object.item == NULL)
        return STATUS_OK;
    forces->given = true;
    mf_json_fields(&object, mf_target_forces_fields, &forces->files);
    mf_json_finish(&object);
    if (!mf_units_known(units))
        mf_json_fault(&object, NULL, "forces are in nm and kJ/mol: the file needs \"units\"");
    if (mf_json_fault_count(target->document) > faults)
        return STATUS_OK;
    const enum status status =
        mf_force_equations_read(&forces->equations, forces->files.file, forces->files.gram_file);
    if (status == STATUS_NO_MEMORY)
        return status;
    if (status != STATUS_OK)
        mf_json_fault(&object, NULL, "%s", mf_status_marked());
    else
        mf_force_equations_scale(&forces->equations, units->length, joules * units->temperature);
    return STATUS_OK;
}

static void write_forces(const struct target_forces *forces, struct json_writer *writer) {
    if (!forces->given)
        return;
    mf_json_begin(writer, "forces");
    mf_json_write_fields(writer, mf_target_forces_fields, &forces->files);
    mf_json_end(writer);
}

// Records -----------------------------------------------------------------------------------------

/// Whether a record has a kind among those that it names, as "rdf".
static bool lists_kind(const struct target_record *record, const char *kind) {
    size_t k = 0;
    while (record->kinds[k] && strcmp(record->kinds[k], kind) != 0)
        k++;
    return record->kinds[k] != NULL;
}

const struct target_record *mf_target_record(int kind) {
    const struct observable_target *about = mf_observable_kind(kind).target;
    const struct target_record *of_form = NULL;
    for (size_t k = 0; mf_target_records[k]; k++) {
        if (lists_kind(mf_target_records[k], about->name))
            return mf_target_records[k];
        if (mf_target_records[k]->form == about->form && mf_target_records[k]->kinds[0] == NULL)
            of_form = mf_target_records[k];
    }
    return of_form;
}

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

/// A window of D's own beside a curve that has another.
static void check_window(const struct target_files *files, struct json_object *object) {
    const struct target_number *diffusion = files->own[TARGET_DIFFUSION];
    if (diffusion->window > 0 &&
        (target_files_curve(files, TARGET_VACF)->points > 0 ||
         target_files_curve(files, TARGET_MSD)->points > 0 || files->given[TARGET_ETD]))
        mf_json_fault(object, "diffusion",
                      "\"window\" is set by \"vacf\", \"msd\" or \"etd\"; leave it out");
}

/// VACF and MSD come from the same samples.
static void check_motion(const struct target_files *files, struct json_object *object) {
    const struct target_curve *vacf = target_files_curve(files, TARGET_VACF);
    const struct target_curve *msd = target_files_curve(files, TARGET_MSD);
    if (vacf->points > 0 && msd->points > 0 &&
        (vacf->points != msd->points || fabs(vacf->interval / msd->interval - 1) > 1e-3))
        mf_json_fault(object, "msd", "must have the times of \"vacf\"");
}

static enum status allocate(struct target_files *files) {
    for (int kind = 0; mf_targets_name(kind); kind++)
        if ((files->own[kind] = mf_memory_zeroed(1, mf_target_record(kind)->size)) == NULL)
            return STATUS_NO_MEMORY;
    return STATUS_OK;
}

enum status mf_target_files_read(struct target_files *files, struct json_object *root,
                                 const struct target_scene *scene) {
    *files = (struct target_files){.composition = *scene->composition};
    TRY(allocate(files));
    struct json_object object = mf_json_child(root, "target", true);
    if (object.item == NULL)
        return STATUS_OK;
    for (int kind = 0; mf_targets_name(kind); kind++) {
        const struct observable_kind about = mf_observable_kind(kind);
        const struct target_record *record = mf_target_record(kind);
        struct json_object child =
            mf_json_child_of(&object, about.target->name, false, record->chief);
        files->given[kind] = child.item != NULL;
        mf_json_fields(&child, mf_target_files_use_fields, &files->use[kind]);
        if (!files->given[kind])
            continue;
        if (about.target->has_settings)
            TRY(read_settings(files, &about, &child));
        TRY(record->read(files, kind, &child, scene));
    }
    TRY(read_forces(&files->forces, &object, scene->units));
    mf_json_finish(&object);
    check_motion(files, &object);
    check_window(files, &object);
    return STATUS_OK;
}

enum status mf_target_files_complete(struct target_files *files, struct json_object *root,
                                     const struct target_scene *scene) {
    struct json_object object = mf_json_child(root, "target", true);
    files->composition = *scene->composition;
    for (int kind = 0; mf_targets_name(kind); kind++) {
        const struct target_record *record = mf_target_record(kind);
        struct json_object child = mf_json_child(&object, mf_targets_name(kind), false);
        if (files->given[kind] && record->complete)
            TRY(record->complete(files, kind, &child, scene));
    }
    return STATUS_OK;
}

void mf_target_files_clear(struct target_files *files) {
    for (int kind = 0; mf_targets_name(kind); kind++) {
        if (files->own[kind] && mf_target_record(kind)->clear)
            mf_target_record(kind)->clear(files->own[kind]);
        mf_memory_free(files->own[kind]);
    }
    for (size_t place = 0; place < OBSERVABLES_MAX; place++)
        mf_memory_free(files->settings[place]);
    mf_force_equations_clear(&files->forces.equations);
    *files = (struct target_files){0};
}

void mf_target_files_write(const struct target_files *files, struct json_writer *writer) {
    mf_json_begin(writer, "target");
    for (int kind = 0; mf_targets_name(kind); kind++) {
        const struct observable_kind about = mf_observable_kind(kind);
        const struct target_record *record = mf_target_record(kind);
        if (!files->given[kind])
            continue;
        mf_json_begin(writer, about.target->name);
        if (about.target->has_settings)
            mf_json_write_fields(writer, about.observable->fields, files->settings[about.place]);
        if (record->write)
            record->write(files, kind, writer);
        else
            mf_json_write_fields(writer, record->fields[0], files->own[kind]);
        mf_json_write_fields(writer, mf_target_files_use_fields, &files->use[kind]);
        mf_json_end(writer);
    }
    write_forces(&files->forces, writer);
    mf_json_end(writer);
}

void mf_target_files_digest(const struct target_files *files, uint64_t *digest) {
    for (int kind = 0; mf_targets_name(kind); kind++) {
        if (!files->given[kind])
            continue;
        const struct target target = mf_target_record(kind)->values(files, kind);
        const size_t bytes = target.count * sizeof(double);
        const double *const arrays[] = {target.x, target.value, target.error};
        for (size_t k = 0; k < 3; k++)
            if (arrays[k])
                mf_digest_add(digest, arrays[k], bytes);
    }
    const struct force_equations *const forces = &files->forces.equations;
    if (files->forces.given)
        mf_digest_add(digest, forces->product,
                      force_equations_blocks(forces) * forces->size * sizeof(double));
}

/// Window and interval in which motion is measured, by the first target that defines them: D's own
/// comes last, since a curve fixes the times at which it is compared.
static void set_motion(const struct target_files *files, struct targets *targets) {
    const struct target_curve *vacf = target_files_curve(files, TARGET_VACF);
    const struct target_curve *curve =
        vacf->points > 0 ? vacf : target_files_curve(files, TARGET_MSD);
    const struct target_etd *etd = target_files_etd(files);
    const struct target_number *diffusion = files->own[TARGET_DIFFUSION];
    targets->motion_lags = DEFAULT_LAGS;
    targets->motion_interval = default_window / DEFAULT_LAGS;
    if (curve->points > 0) {
        targets->motion_lags = curve->points - 1;
        targets->motion_interval = curve->interval;
    } else if (files->given[TARGET_ETD]) {
        targets->motion_lags = (size_t)etd->grid.times - 1;
        targets->motion_interval = etd->interval;
    } else if (diffusion->window > 0) {
        targets->motion_interval = diffusion->window / DEFAULT_LAGS;
    }
}

void mf_target_files_targets(struct target_files *files, bool moves, struct targets *fitted,
                             struct targets *compared) {
    static const double unknown = NAN;
    const struct target_etd *etd = target_files_etd(files);
    *compared = (struct targets){.bins = *target_pairs_bins(target_files_rdf(files)),
                                 .etd = etd->grid,
                                 .etd_interval = etd->interval,
                                 .etd_origins = origin_intervals * etd->interval};
    set_motion(files, compared);
    memcpy(compared->settings, files->settings, sizeof files->settings);
    for (int kind = 0; mf_targets_name(kind); kind++) {
        if (!files->given[kind])
            continue;
        compared->target[kind] = mf_target_record(kind)->values(files, kind);
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
    const struct target_etd *etd = target_files_etd(files);
    if (files->given[TARGET_ETD])
        TRY(mf_target_curve_check_steps(etd->parameters.file, etd->interval, etd->time, time_step));
    for (int kind = 0; mf_targets_name(kind); kind++)
        if (files->given[kind] &&
            mf_observable_kind(kind).target->form == OBSERVABLE_CURVE_OF_TIME) {
            const struct target_curve *curve = target_files_curve(files, kind);
            TRY(mf_target_curve_check_steps(curve->parameters.file, curve->interval, curve->time,
                                            time_step));
        }
    return STATUS_OK;
}

bool mf_target_files_table(const struct target_files *files, int kind, size_t n,
                           struct target_table *table) {
    const struct target_record *record = mf_target_record(kind);
    return files->given[kind] && record->table && record->table(files, kind, n, table);
}
