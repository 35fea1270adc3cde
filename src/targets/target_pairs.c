// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_files.h"

#include "base/memory.h"
#include "scene/scene_law.h"

#include <math.h>
#include <string.h>

/// All end with the shortest; where they would have ended is kept.
static void cut_to_shortest(struct target_pairs *target) {
    size_t shortest = SIZE_MAX;
    for (size_t pair = 0; pair < target->pairs; pair++) {
        const size_t count = target->member[pair].bins.count;
        shortest = count > 0 && count < shortest ? count : shortest;
    }
    for (size_t pair = 0; pair < target->pairs; pair++) {
        struct rdf_bins *bins = &target->member[pair].bins;
        target->ends[pair] = mf_rdf_bins_edge(bins, bins->count);
        if (bins->count > shortest)
            bins->count = shortest;
    }
}

/// Pair types that are not given have the bins of the others, and no g.
static void fill_bins(struct target_pairs *target) {
    struct rdf_bins bins = {.count = 0};
    for (size_t pair = 0; pair < target->pairs && bins.count == 0; pair++)
        if (target->has_g[pair])
            bins = target->member[pair].bins;
    for (size_t pair = 0; pair < target->pairs; pair++)
        if (!target->has_g[pair])
            target->member[pair].bins = bins;
}

/// All pair types must have the bins of the first that is given.
static void check_bins(const struct target_pairs *target, const struct composition *composition,
                       struct json_object *object) {
    const struct rdf_bins *first = target_pairs_bins(target);
    size_t of = 0;
    while (of + 1 < target->pairs && !target->has_g[of])
        of++;
    for (size_t pair = of + 1; pair < target->pairs; pair++) {
        const struct rdf_bins *bins = &target->member[pair].bins;
        char name[COMPOSITION_PAIR_NAME_SIZE], first_name[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(composition, (int)pair, name);
        mf_composition_pair_name(composition, (int)of, first_name);
        // A file that could not be read has its own fault.
        if (first->count > 0 && bins->count > 0 &&
            (bins->count != first->count || fabs(bins->width / first->width - 1) > 1e-6 ||
             fabs(bins->low - first->low) > 1e-6 * first->width))
            mf_json_fault(object, name, "must have the bins of \"%s\"", first_name);
    }
}

static void clear_values(struct target_pairs *target) {
    double **const values[] = {&target->g, &target->error, &target->given, &target->factor_error};
    for (size_t k = 0; k < sizeof values / sizeof *values; k++) {
        mf_memory_free(*values[k]);
        *values[k] = NULL;
    }
}

/// g and errors of all pair types in the numbers of the scene, one after the other, if all
/// could be read.
static enum status collect(struct target_pairs *target, const struct finite_size_fluid *fluid) {
    const size_t bins = target_pairs_bins(target)->count;
    clear_values(target);
    for (size_t pair = 0; pair < target->pairs; pair++)
        if (target->member[pair].bins.count != bins)
            return STATUS_OK;
    TRY_ARRAY(target->g, target->pairs * bins);
    TRY_ARRAY(target->error, target->pairs * bins);
    TRY_ARRAY(target->given, target->pairs * bins);
    TRY_ARRAY(target->factor_error, target->pairs);
    for (size_t pair = 0; pair < target->pairs; pair++)
        if (target->has_g[pair])
            mf_target_rdf_convert(&target->member[pair], fluid, (int)pair, target->g + pair * bins,
                                  target->error + pair * bins);
        else
            for (size_t k = pair * bins; k < (pair + 1) * bins; k++)
                target->g[k] = target->error[k] = NAN;
    memcpy(target->given, target->g, target->pairs * bins * sizeof(double));
    return STATUS_OK;
}

/// Of a mixture all pair types end with the shortest.
static enum status compare_and_collect(struct target_pairs *target, struct json_object *object,
                                       const struct finite_size_fluid *fluid) {
    if (composition_is_mixed(fluid->composition)) {
        cut_to_shortest(target);
        fill_bins(target);
        check_bins(target, fluid->composition, object);
    }
    return collect(target, fluid);
}

/// Faults go to the document.
static enum status read_pairs(struct target_pairs *target, struct json_object *object,
                              const struct finite_size_fluid *fluid, const struct units *units) {
    const struct composition *composition = fluid->composition;
    if (composition->types == 0)
        return STATUS_OK; // a fault of the types is told, those of their pairs would mislead
    target->pairs = (size_t)mf_composition_pairs(composition);
    if (!composition_is_mixed(composition)) {
        if (mf_scene_pair_names_refuse(object, composition, "{\"file\": …}"))
            return STATUS_OK;
        target->has_g[0] = true;
        TRY(mf_target_rdf_read(&target->member[0], object, units, fluid->box->dimensions));
        return compare_and_collect(target, object, fluid);
    }
    // The object remembers what it was asked for until it is finished.
    char name[COMPOSITION_MAX_PAIRS][COMPOSITION_PAIR_NAME_SIZE];
    const char *key[COMPOSITION_MAX_PAIRS];
    const bool known = mf_scene_pair_names_find(object, composition, key);
    bool some = false;
    for (size_t pair = 0; pair < target->pairs && !fluid->intermolecular; pair++)
        some = some || key[pair];
    for (size_t pair = 0; pair < target->pairs; pair++) {
        mf_composition_pair_name(composition, (int)pair, name[pair]);
        if (!mf_composition_has_pairs(composition, (int)pair)) {
            if (key[pair] && mf_json_has(object, key[pair]))
                mf_json_fault(object, key[pair],
                              "a single bead is of that type, and there is no such pair; leave it "
                              "out");
            continue;
        }
        // Of some pairs alone: whether the others are known is seen later (defaults/fit_check).
        // What is missing may be what a wrong name was to be.
        struct json_object child =
            mf_json_child(object, key[pair] ? key[pair] : name[pair], known && !some);
        target->has_g[pair] = child.item != NULL;
        if (child.item)
            TRY(mf_target_rdf_read(&target->member[pair], &child, units, fluid->box->dimensions));
    }
    mf_json_finish(object);
    return compare_and_collect(target, object, fluid);
}

/// Divide g and errors of a pair type.
static void divide(struct target_pairs *target, size_t pair, double factor) {
    const size_t bins = target_pairs_bins(target)->count;
    for (size_t n = pair * bins; n < (pair + 1) * bins; n++) {
        target->g[n] /= factor;
        target->error[n] /= factor;
    }
}

/// Whether g of all pairs that there are is given.
static bool is_whole(const struct target_pairs *target, const struct composition *composition) {
    bool whole = true;
    for (size_t pair = 0; pair < target->pairs; pair++)
        whole = whole && (target->has_g[pair] || !mf_composition_has_pairs(composition, (int)pair));
    return whole;
}

/// Divide by what the file says, which is 1 where it says nothing. Returns how many pair types it
/// says it of.
static size_t normalise(struct target_pairs *target) {
    size_t given = 0;
    for (size_t pair = 0; pair < target->pairs; pair++) {
        const double factor = target->member[pair].parameters.normalisation;
        if (factor > 0)
            divide(target, pair, factor);
        given += factor > 0;
    }
    return given;
}

/// What is not known of the factor of a pair type: nothing where the file says it, or of how many
/// particles g is, by whose pairs it is normalised then; the error of one that was found; else that
/// of one particle more or less, as by N for N − 1.
static double find_factor_error(const struct target_files *files, int pair) {
    const struct target_rdf_parameters *p = &target_files_rdf(files)->member[pair].parameters;
    int type[2];
    if (p->normalisation > 0 || p->particles > 0 || !target_files_rdf(files)->has_g[pair])
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
    struct target_pairs *rdf = files->own[TARGET_RDF];
    double width = 0;
    files->normalisation = (struct normalisation){.factor = 1};
    normalise(files->own[mf_rdf_intermolecular_kind()]);
    const size_t given = normalise(rdf);
    if (!files->given[TARGET_RDF])
        return STATUS_OK;
    for (size_t pair = 0; pair < rdf->pairs; pair++)
        width = fmax(width, rdf->member[pair].parameters.normalisation_error);
    // What all together say tells nothing of a part of them.
    if (given == 0 && !joined && is_whole(rdf, &files->composition))
        TRY(mf_normalisation_find(target_pairs_bins(rdf), box, &files->composition, rdf->g,
                                  rdf->error, width, &files->normalisation));
    for (size_t pair = 0; pair < rdf->pairs; pair++) {
        divide(rdf, pair, files->normalisation.factor);
        rdf->factor_error[pair] = find_factor_error(files, (int)pair);
    }
    return STATUS_OK;
}

/// Of beads of different molecules: also the bins in which they are measured.
static enum status set_bins_of_intermolecular(struct target_files *files, int kind) {
    const size_t place = mf_observable_kind(kind).place;
    struct rdf_settings *settings = mf_memory_zeroed(1, sizeof *settings);
    if (settings == NULL)
        return STATUS_NO_MEMORY;
    mf_memory_free(files->settings[place]);
    *settings = (struct rdf_settings){.of_target = true,
                                      .estimator = RDF_FORCE_NOT_USED,
                                      .target = *target_pairs_bins(files->own[kind])};
    files->settings[place] = settings;
    return STATUS_OK;
}

static struct finite_size_fluid fluid_of(const struct target_files *files, int kind,
                                         const struct target_scene *scene) {
    return (struct finite_size_fluid){.box = scene->box,
                                      .composition = &files->composition,
                                      .topology =
                                          scene->molecules ? &scene->molecules->topology : NULL,
                                      .intermolecular = kind != TARGET_RDF};
}

static enum status read(struct target_files *files, int kind, struct json_object *object,
                        const struct target_scene *scene) {
    const struct finite_size_fluid fluid = fluid_of(files, kind, scene);
    TRY(read_pairs(files->own[kind], object, &fluid, scene->units));
    return fluid.intermolecular ? set_bins_of_intermolecular(files, kind) : STATUS_OK;
}

static enum status complete(struct target_files *files, int kind, struct json_object *object,
                            const struct target_scene *scene) {
    struct target_pairs *target = files->own[kind];
    const struct finite_size_fluid fluid = fluid_of(files, kind, scene);
    for (size_t pair = 0; pair < target->pairs; pair++)
        if (target->has_g[pair])
            TRY(mf_target_rows_fault(object, NULL, mf_target_rdf_cut(&target->member[pair])));
    TRY(compare_and_collect(target, object, &fluid));
    return fluid.intermolecular ? set_bins_of_intermolecular(files, kind) : STATUS_OK;
}

static void clear(void *own) {
    struct target_pairs *target = own;
    for (size_t pair = 0; pair < target->pairs; pair++)
        mf_target_rdf_clear(&target->member[pair]);
    clear_values(target);
}

static void write(const struct target_files *files, int kind, struct json_writer *writer) {
    const struct target_pairs *target = files->own[kind];
    const struct composition *composition = &files->composition;
    if (!composition_is_mixed(composition)) {
        mf_json_write_fields(writer, mf_target_rdf_fields, &target->member[0].parameters);
        return;
    }
    for (size_t pair = 0; pair < target->pairs; pair++) {
        char name[COMPOSITION_PAIR_NAME_SIZE];
        if (!target->has_g[pair])
            continue;
        mf_composition_pair_name(composition, (int)pair, name);
        mf_json_begin(writer, name);
        mf_json_write_fields(writer, mf_target_rdf_fields, &target->member[pair].parameters);
        mf_json_end(writer);
    }
}

/// What the errors of all pair types are of: of bins if a file has none and does not say.
static enum target_errors errors_of(const struct target_pairs *target) {
    bool samples = true;
    for (size_t pair = 0; pair < target->pairs; pair++) {
        const struct target_rdf *rdf = &target->member[pair];
        if (rdf->bins.count == 0)
            continue;
        const bool says = rdf->parameters.errors_of == TARGET_ERRORS_OF_SAMPLES;
        if ((rdf->estimated_error > 0 && !says) || rdf->resampling.error > 0 ||
            rdf->parameters.errors_of == TARGET_ERRORS_OF_BINS)
            return TARGET_ERRORS_OF_BINS;
        samples = samples && says;
    }
    return samples ? TARGET_ERRORS_OF_SAMPLES : TARGET_ERRORS_UNKNOWN;
}

static struct target values(const struct target_files *files, int kind) {
    const struct target_pairs *target = files->own[kind];
    return (struct target){.count = target_pairs_values(target),
                           .value = target->g,
                           .error = target->error,
                           .errors_of = errors_of(target),
                           .factor_error = target->factor_error,
                           .pairs = target->pairs};
}

/// rdf_A-B.tsv. Beside g what it was before it was divided by its normalisation, if that changed
/// it.
static bool find_table(const struct target_files *files, int kind, size_t pair,
                       struct target_table *table) {
    const struct target_pairs *target = files->own[kind];
    const size_t bins = target_pairs_bins(target)->count;
    char name[COMPOSITION_PAIR_NAME_SIZE];
    if (pair >= target->pairs)
        return false;
    *table = (struct target_table){.part = pair,
                                   .first = pair * bins,
                                   .count = target->has_g[pair] ? bins : 0,
                                   .places = 1,
                                   .place = {"r[lambda]"},
                                   .beside = true};
    if (memcmp(target->given + table->first, target->g + table->first, bins * sizeof(double)) != 0)
        table->given = target->given + table->first;
    mf_composition_pair_name(&files->composition, (int)pair, name);
    snprintf(table->name, sizeof table->name, "%s%s%s", mf_targets_name(kind), name[0] ? "_" : "",
             name);
    return true;
}

static void find_place(const struct target_files *files, int kind, const struct target_table *table,
                       size_t k, double at[2]) {
    (void)table;
    at[0] = mf_rdf_bins_centre(target_pairs_bins(files->own[kind]), k);
}

const struct target_record mf_target_pairs = {
    .topic = "rdf-target",
    .summary = "\"rdf\" of a run file's \"target\": g(r)",
    .chief = "file",
    .fields = {mf_target_rdf_fields, mf_target_files_use_fields},
    .form = OBSERVABLE_OWN_FORM,
    .kinds = {"rdf", "intermolecular_rdf"},
    .size = sizeof(struct target_pairs),
    .read = read,
    .complete = complete,
    .clear = clear,
    .write = write,
    .values = values,
    .table = find_table,
    .place = find_place,
};
