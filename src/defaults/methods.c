// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/methods.h"

#include "base/memory.h"
#include "base/names.h"
#include "inversion/inversions.h"

#include <stdio.h>
#include <string.h>

#define METHOD(name) &mf_##name,
#define METHOD_OPTIMISER(record, name, summary) &mf_matching_##record,
const struct inverse_method *const mf_methods[] = {INVERSIONS(METHOD) MATCHINGS(METHOD) NULL};

const char *mf_methods_list(bool (*can)(const struct inverse_method *method),
                            char text[METHODS_TEXT_SIZE]) {
    size_t count = 0, named = 0, length = 0;
    for (size_t k = 0; mf_methods[k]; k++)
        count += can(mf_methods[k]);
    text[0] = '\0';
    for (size_t k = 0; mf_methods[k] && length < METHODS_TEXT_SIZE; k++) {
        if (!can(mf_methods[k]))
            continue;
        const char *const before = named == 0 ? "" : named + 1 < count ? ", " : " and ";
        length += (size_t)snprintf(text + length, METHODS_TEXT_SIZE - length, "%s\"%s\"", before,
                                   mf_methods[k]->name);
        named++;
    }
    return text;
}

bool mf_methods_fits_any_target(const struct inverse_method *method) {
    return method->kind == INVERSE_MATCHING;
}

// The method of a run file ------------------------------------------------------------------------

NAMED_RECORD(struct inverse_method);

/// Where forces from outside act, g(r) does not follow from those of pairs; partial g(r) do not
/// follow from the force on a bead of either type.
static void check_estimator(const struct fit_file *fit, struct json_object *method) {
    if (fit->method->sampling == NULL || !fit->method->sampling(fit->method_parameters).rdf_force)
        return;
    if (composition_is_mixed(&fit->scene.setup.composition))
        mf_json_fault(method, "estimator",
                      "\"force\" is not for mixtures; \"histogram\" counts their partial g(r)");
    if (fit->scene.setup.interactions > 0)
        mf_json_fault(method, "estimator",
                      "\"force\" supports only pair forces, not \"interactions\"");
}

static bool knows(const struct inverse_method *method, const char *key) {
    for (const struct inverse_table *table = method->tables; table->fields; table++)
        for (const struct field *field = table->fields; field->name; field++)
            if (strcmp(field->name, key) == 0)
                return true;
    return false;
}

/// What files of earlier versions may say.
static void refuse_removed(const struct inverse_method *method, struct json_object *object) {
    static const char usual[] = "its default is always used; leave it out";
    static const struct {
        const char *key, *now, *reason; ///< what is always so now
    } removed[] = {
        {"asynchronous", "no", "candidates are always measured in rounds; leave it out"},
        {"regularisation", "noise",
         "the smoothness of the step follows from the noise; leave it out"},
        {"strength", "0", "it is chosen from the noise; leave it out"},
        {"islands", "1", "the population is not divided any more; leave it out"},
        {"migration", "5", "the population is not divided any more; leave it out"},
        {"common_noise", "no", "each candidate gets its own random numbers; leave it out"},
        {"restarts", "0", "leave it out, and begin again with another \"seed\""},
        {"remeasurements", "2", usual},
        {"mutated_genes", "0.1", usual},
        {"additive", "0.1", usual},
        {"crossover", "0.9", usual},
        {"crossover_exponent", "15", usual},
        {"mutation", "1", usual},
        {"remeasured", "0.25", usual},
        {"depth", "7", usual},
        {"damping", "1", usual},
        {"ridge", "0.35", usual},
    };
    for (size_t k = 0; k < sizeof removed / sizeof *removed; k++)
        if (!knows(method, removed[k].key))
            mf_json_retired(object, removed[k].key, removed[k].now, removed[k].reason);
}

/// Parameters of a method that the file leaves to be chosen: those of an inversion.
static enum status read_parameters(struct fit_file *fit, struct json_object *object) {
    const struct inverse_table *table = mf_automatic.tables;
    fit->method_parameters = mf_memory_zeroed(1, mf_automatic.parameters_size);
    if (fit->method_parameters == NULL)
        return STATUS_NO_MEMORY;
    fit->parameters_given = mf_json_fields(object, table->fields, fit->method_parameters);
    refuse_removed(&mf_automatic, object);
    mf_json_finish(object);
    return STATUS_OK;
}

size_t mf_methods_sampled_particles(const struct fit_file *fit) {
    static const char *const names[] = {"particles", "potential_particles"};
    int64_t count = 0;
    for (const struct inverse_table *table = fit->method->tables; table->fields; table++)
        for (const struct field *field = table->fields; field->name; field++)
            for (int k = 0; k < 2; k++)
                if (strcmp(field->name, names[k]) == 0)
                    memcpy(&count,
                           (const char *)fit->method_parameters + table->offset + field->offset,
                           sizeof count);
    return (size_t)count;
}

void mf_methods_check(const struct fit_file *fit, struct json_object *root) {
    if (fit->parameters_given && fit->method &&
        fit->method->tables->fields != mf_automatic.tables->fields)
        mf_json_fault(root, "method",
                      "without \"name\" it may have parameters of \"%s\" alone, and \"%s\" was "
                      "chosen: give the \"name\" of the method",
                      mf_automatic.name, fit->method->name);
}

enum status mf_methods_read(struct fit_file *fit, struct json_object *root) {
    const char **names;
    struct json_object object = mf_json_child_of(root, "method", false, "name");
    if (object.item == NULL)
        return STATUS_OK;
    if (!mf_json_is_member(&object, "name"))
        return read_parameters(fit, &object);
    TRY(mf_names_collect(mf_methods, NULL, &names));
    const char *name = mf_json_choice(&object, "name", names, NULL);
    mf_memory_free(names);
    if (name == NULL)
        return STATUS_OK;
    fit->method = mf_names_find(mf_methods, name);
    fit->method_parameters = mf_memory_zeroed(1, fit->method->parameters_size);
    if (fit->method_parameters == NULL)
        return STATUS_NO_MEMORY;
    for (const struct inverse_table *table = fit->method->tables; table->fields; table++)
        mf_json_fields(&object, table->fields, (char *)fit->method_parameters + table->offset);
    check_estimator(fit, &object);
    refuse_removed(fit->method, &object);
    mf_json_finish(&object);
    return STATUS_OK;
}
