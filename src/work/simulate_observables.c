// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/simulate_observables.h"

#include "base/digest.h"
#include "io/checkpoint.h"
#include "observe/rdf_observable.h"

#include <stdio.h>
#include <string.h>

/// Whether what is always measured can be: g(r) without a word of it as far as forces reach.
static bool is_usual(const struct observable *observable, const struct simulation_setup *setup) {
    return observable->always && setup->placement.count >= 2 &&
           (observable != &mf_rdf_observable || mf_simulation_range(setup) > 0);
}

/// What files of earlier versions may say.
static void refuse_removed(struct json_object *object) {
    mf_json_retired(object, "fit_from", "0.5",
                    "the line always starts at half of the window; leave it out");
    mf_json_retired(object, "speed_maximum", "5", "always 5; leave it out");
}

/// Monte Carlo goes through configurations in no time.
static void check_time(const struct observable *observable, const struct integrator *integrator,
                       struct json_object *root) {
    if (observable->of_time && integrator && integrator->samples)
        mf_json_fault(root, observable->name,
                      "\"%s\" has neither time nor velocities; leave it out, or use dynamics",
                      integrator->name);
}

enum status mf_simulate_observables_read(struct simulate_observables *observables,
                                         struct json_object *root,
                                         const struct simulation_setup *setup) {
    const bool too_few_particles =
        setup->placement.count < 2 && mf_json_fault_count(root->document) == 0;
    *observables = (struct simulate_observables){0};
    struct observable_use *use = observables->use;
    for (size_t k = 0; mf_observables[k]; k++) {
        const struct observable *observable = mf_observables[k];
        struct json_object object = {0};
        if (observable->fields)
            object = mf_json_child(root, observable->name, false);
        if (object.item == NULL && !is_usual(observable, setup))
            continue;
        check_time(observable, setup->integrator, root);
        if (too_few_particles && !observable->of_solvent)
            mf_json_fault(root, observable->name, "there are fewer than two particles to measure");
        use->observable = observable;
        if (observable->fields) {
            use->settings = mf_memory_zeroed(1, observable->settings_size);
            if (use->settings == NULL)
                return STATUS_NO_MEMORY;
            mf_json_fields(&object, observable->fields, use->settings);
        }
        refuse_removed(&object);
        if (object.item)
            mf_json_finish(&object);
        use++;
    }
    return STATUS_OK;
}

bool mf_simulate_observables_has(const struct simulate_observables *observables,
                                 const struct observable *observable) {
    const struct observable_use *use = observables->use;
    while (use->observable && use->observable != observable)
        use++;
    return use->observable != NULL;
}

enum status mf_simulate_observables_add(struct simulate_observables *observables,
                                        const struct caller_observables *callers) {
    struct observable_use *use = observables->use;
    TRY(mf_caller_observables_check(callers));
    while (use->observable)
        use++;
    for (size_t k = 0; k < callers->count; k++, use++) {
        struct caller_observable *own;
        TRY_ARRAY(own, 1);
        *own = callers->item[k];
        *use = (struct observable_use){.observable = &mf_caller_observable, .settings = own};
    }
    return STATUS_OK;
}

/// The caller's function behind a use, or NULL.
static const struct caller_observable *callers_own(const struct observable_use *use) {
    return use->observable == &mf_caller_observable ? use->settings : NULL;
}

void mf_simulate_observables_digest(const struct simulate_observables *observables,
                                    uint64_t *digest) {
    for (const struct observable_use *use = observables->use; use->observable; use++)
        if (callers_own(use))
            mf_digest_add(digest, callers_own(use)->name, strlen(callers_own(use)->name) + 1);
}

void mf_simulate_observables_clear(struct simulate_observables *observables) {
    for (struct observable_use *use = observables->use; use->observable; use++) {
        mf_observable_end(use);
        mf_memory_free(use->settings);
    }
    *observables = (struct simulate_observables){0};
}

void mf_simulate_observables_write_used(const struct simulate_observables *observables,
                                        struct json_writer *writer) {
    for (const struct observable_use *use = observables->use; use->observable; use++) {
        if (use->observable->fields == NULL)
            continue;
        mf_json_begin(writer, use->observable->name);
        mf_json_write_fields(writer, use->observable->fields, use->settings);
        mf_json_end(writer);
    }
}

enum status mf_simulate_observables_begin(struct simulate_observables *observables,
                                          struct simulation *simulation,
                                          const struct measure_plan *plan) {
    const struct configuration configuration = mf_configuration_of(simulation);
    for (struct observable_use *use = observables->use; use->observable; use++)
        TRY(mf_observable_begin(use, &configuration, plan));
    return STATUS_OK;
}

enum status mf_simulate_observables_restart(struct simulate_observables *observables,
                                            struct simulation *simulation,
                                            const struct measure_plan *plan) {
    for (struct observable_use *use = observables->use; use->observable; use++)
        mf_observable_end(use);
    return mf_simulate_observables_begin(observables, simulation, plan);
}

void mf_simulate_observables_open(const struct simulate_observables *observables,
                                  const struct observable_results *results) {
    for (const struct observable_use *use = observables->use; use->observable; use++)
        if (use->observable->open)
            use->observable->open(use->state, results);
}

/// A table of each pair type, "rdf_*-*.tsv", if there are several.
static enum status reserve_pairs(const char *file, const struct composition *composition,
                                 struct run_folder *folder) {
    const char *stars = strstr(file, "*-*");
    for (int pair = 0;
         stars && composition_is_mixed(composition) && pair < mf_composition_pairs(composition);
         pair++) {
        char of[COMPOSITION_PAIR_NAME_SIZE], name[COMPOSITION_PAIR_NAME_SIZE + 128];
        mf_composition_pair_name(composition, pair, of);
        snprintf(name, sizeof name, "%.*s%s%.60s", (int)(stars - file), file, of, stars + 3);
        if (mf_composition_has_pairs(composition, pair))
            TRY(mf_run_folder_reserve(folder, name));
    }
    return STATUS_OK;
}

enum status mf_simulate_observables_reserve(const struct simulate_observables *observables,
                                            const struct composition *composition,
                                            struct run_folder *folder) {
    for (const struct observable_use *use = observables->use; use->observable; use++) {
        char own[OUTPUT_PATH_SIZE];
        if (callers_own(use)) {
            snprintf(own, sizeof own, "%s.tsv", callers_own(use)->name);
            TRY(mf_run_folder_reserve(folder, own));
        }
        for (const char *const *file = use->observable->files; file && *file; file++)
            if (strchr(*file, '*'))
                TRY(reserve_pairs(*file, composition, folder));
            else
                TRY(mf_run_folder_reserve(folder, *file));
    }
    return STATUS_OK;
}

size_t mf_simulate_observables_spans(struct simulate_observables *observables,
                                     struct simulation *simulation, struct memory_span *spans) {
    size_t n = mf_simulation_spans(simulation, spans);
    for (const struct observable_use *use = observables->use; use->observable; use++)
        n += use->observable->spans(use->state, spans + n);
    return n;
}

enum status mf_simulate_observables_load(struct simulate_observables *observables,
                                         struct simulation *simulation, const char *file,
                                         uint64_t digest, const struct memory_span *first) {
    struct memory_span spans[1 + SIMULATE_MAX_SPANS] = {*first};
    size_t n = 1 + mf_simulation_spans(simulation, spans + 1);
    if (simulation_wants_capacity(simulation)) {
        TRY(mf_checkpoint_load_span(file, digest, 1, &spans[1]));
        TRY(mf_simulation_reserve(simulation));
        n = 1 + mf_simulation_spans(simulation, spans + 1);
    }
    for (const struct observable_use *use = observables->use; use->observable; use++) {
        size_t own = use->observable->spans(use->state, spans + n);
        if (use->observable->reserve) {
            TRY(mf_checkpoint_load_span(file, digest, n, &spans[n]));
            TRY(use->observable->reserve(use->state));
            own = use->observable->spans(use->state, spans + n);
        }
        n += own;
    }
    TRY(mf_checkpoint_load(file, digest, spans, n));
    return mf_simulation_restore(simulation);
}

enum status mf_simulate_observables_write(const struct simulate_observables *observables,
                                          const struct observable_results *results) {
    for (const struct observable_use *use = observables->use; use->observable; use++)
        if (use->observable->write)
            TRY(use->observable->write(use->state, results));
    return STATUS_OK;
}

void mf_simulate_observables_write_summary(const struct simulate_observables *observables,
                                           const struct observable_results *results,
                                           struct json_writer *writer) {
    for (const struct observable_use *use = observables->use; use->observable; use++)
        if (use->observable->write_summary)
            use->observable->write_summary(use->state, results, writer);
}

void mf_simulate_observables_print(const struct simulate_observables *observables,
                                   const struct observable_results *results, struct progress *to) {
    for (const struct observable_use *use = observables->use; use->observable; use++) {
        char line[512];
        if (use->observable->print) {
            use->observable->print(use->state, results, line, sizeof line);
            mf_progress_print(to, "%s", line);
        }
        const enum status status = use->observable->assess
                                       ? use->observable->assess(use->state, results->setup)
                                       : STATUS_OK;
        // What is wrong ends the run, and is not a warning.
        if (mf_units_convert_message(results->units, status) != STATUS_OK &&
            status != STATUS_UNSTABLE)
            mf_progress_print(to, "mesofit: warning: %s", mf_status_message());
    }
}

enum status mf_simulate_observables_judge(const struct simulate_observables *observables,
                                          const struct observable_results *results) {
    for (const struct observable_use *use = observables->use; use->observable; use++) {
        const enum status status = use->observable->assess
                                       ? use->observable->assess(use->state, results->setup)
                                       : STATUS_OK;
        if (mf_units_convert_message(results->units, status) == STATUS_UNSTABLE)
            return mf_status_fail(STATUS_UNCONVERGED, "%s", mf_status_message());
    }
    return STATUS_OK;
}

// What a person changes while it runs -------------------------------------------------------------

bool mf_simulate_changes_add(struct simulate_changes *changes,
                             const struct simulation_change *change) {
    const struct simulation_change *last = mf_simulate_changes_last(changes);
    const size_t place = last && last->step == change->step ? changes->count - 1 : changes->count;
    if (place == SIMULATE_CHANGES_MAX)
        return false;
    changes->change[place] = *change;
    changes->count = place + 1;
    return true;
}

const struct simulation_change *mf_simulate_changes_last(const struct simulate_changes *changes) {
    return changes->count > 0 ? &changes->change[changes->count - 1] : NULL;
}

void mf_simulate_changes_write(const struct simulate_changes *changes, struct json_writer *writer) {
    if (changes->count == 0)
        return;
    mf_json_begin_list(writer, "changed");
    for (size_t k = 0; k < changes->count; k++) {
        const struct simulation_change *change = &changes->change[k];
        mf_json_begin(writer, NULL);
        mf_json_write_integer(writer, "step", (int64_t)change->step);
        mf_json_write_quantity(writer, "temperature", "T_0", change->temperature);
        mf_json_write_quantity(writer, "time_step", "tau", change->time_step);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

void mf_simulate_changes_print(const struct simulate_changes *changes, const struct units *units,
                               struct progress *to) {
    const struct simulation_change *last = mf_simulate_changes_last(changes);
    char of_temperature[UNITS_NAME_SIZE], of_time[UNITS_NAME_SIZE];
    mf_progress_print(
        to, "after step %llu: temperature %.6g%s, time step %.6g%s; samples are reset",
        (unsigned long long)last->step, last->temperature * mf_units_factor(units, "T_0"),
        mf_units_suffix(units, "T_0", of_temperature),
        last->time_step * mf_units_factor(units, "tau"), mf_units_suffix(units, "tau", of_time));
}
