// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "defaults/fit_engine.h"
#include "defaults/fit_scales.h"
#include "inversion/inversion.h"
#include "io/units_scale.h"
#include "observe/stages.h"
#include "problem/unknowns.h"
#include "work/explain.h"
#include "work/fit.h"
#include "defaults/fit_states.h"
#include "work/fit_tasks.h"
#include "work/fit_print.h"

#include <math.h>
#include <string.h>

enum { TIME_SIZE = 32 };

static enum status print_simulation(const struct measurement_setup *measured,
                                    const struct simulation_setup *setup,
                                    const struct units *units) {
    struct observable_use uses[OBSERVABLES_MAX + 1] = {0};
    const enum status status = mf_measurement_list(measured, setup->time_step, uses);
    if (status == STATUS_OK)
        mf_explain_scene(stdout, setup, units, uses, measured->plan.every);
    mf_measurement_list_clear(uses);
    return status;
}

/// Simulations of a state with the curves that the fit begins with.
static enum status print_state(const struct fit_file *fit, const struct unknowns_laws *laws) {
    const struct inverse_problem *problem = &fit->problem;
    struct simulation_setup setup = laws->problem.scene;
    setup.potential = laws->table[UNKNOWN_POTENTIAL];
    setup.omega = laws->table[UNKNOWN_OMEGA];
    if (fit->method->kind == INVERSE_MATCHING) {
        const struct inverse_sampling sampling = fit->method->sampling(fit->method_parameters);
        const struct measurement_setup evaluation = {.targets = &problem->targets,
                                                     .plan.every = sampling.every,
                                                     .force_estimator = sampling.rdf_force};
        printf("An evaluation of the method \"%s\", one a thread:\n", fit->method->name);
        TRY(print_simulation(&evaluation, &setup, &fit->scene.units));
    }
    if (fit->verification.time_step > 0)
        setup.time_step = fit->verification.time_step;
    const struct measurement_setup replica = {
        .targets = &problem->compared, .plan = fit->verification.plan, .thermodynamics = true};
    printf("A replica of the verification%s%s%s, one a thread:\n",
           fit->name[0] ? " of state \"" : "", fit->name, fit->name[0] ? "\"" : "");
    return print_simulation(&replica, &setup, &fit->scene.units);
}

/// "40 s", "3 min", "1.5 h".
static void print_time(double seconds, char text[TIME_SIZE]) {
    if (seconds < 90)
        snprintf(text, TIME_SIZE, "%.2g s", seconds);
    else if (seconds < 5400)
        snprintf(text, TIME_SIZE, "%.2g min", seconds / 60);
    else
        snprintf(text, TIME_SIZE, "%.2g h", seconds / 3600);
}

/// What another engine is asked for.
static void print_engine(const struct fit_file *fit) {
    const struct inversion_parameters *p = fit->method_parameters;
    const int64_t steps = fit->engine.steps;
    printf(
        "The method \"%s\" samples by another engine (--engine): %lld replicas, of each at first "
        "%lld time steps and then %lld frames, %lld steps apart; twice as many as often as they "
        "are not exact enough.\n",
        fit->method->name, (long long)p->replicas, (long long)(2 * p->equilibration * steps),
        (long long)p->samples, (long long)(p->every * steps));
}

/// What an inversion looks at, and about how long: an iteration whose samples are as exact as is
/// asked for. Of seven liquids such iterations took 0.6 to 1 times as many sweeps, with a pressure
/// as a target 2.2 times, and fits had 4 to 17 iterations.
static enum status print_sampling(const struct fit_file *fit) {
    static const double inefficiency = 2;
    const struct inversion_parameters *p = fit->method_parameters;
    const struct simulation_setup *setup = &fit->scene.setup;
    const double count = (double)(p->particles > 0 ? p->particles : setup->placement.count);
    const double replicas = (double)p->replicas;
    // Without a g(r) the potential is known, and has a cutoff.
    const double range =
        fmax(mf_rdf_bins_range(&fit->problem.targets.bins), mf_stages_cutoff(setup));
    struct fit_scales_rdf rdf;
    char time[TIME_SIZE];
    if (fit->engine.kind != ENGINE_NONE) {
        print_engine(fit);
        return STATUS_OK;
    }
    printf("The method \"%s\" samples by a Monte Carlo of its own, not by the dynamics of the "
           "scene: %.0f particles, %.0f others within range of each.\n",
           fit->method->name, count, 2 * mf_stages_pairs_within(setup, range));
    const bool molecules = scene_has_molecules(&fit->scene.molecules);
    if (molecules && p->sampler == SAMPLER_MONTE_CARLO)
        return STATUS_OK; // nobody has looked how independent its samples are
    TRY(mf_fit_scales_rdf_init(&rdf, &fit->files, &fit->scene));
    const double noise = mf_fit_scales_noise_of_sample(&rdf, &setup->box, count, range);
    const double samples =
        fmax(replicas * (double)p->samples, inefficiency * pow(noise / p->precision, 2));
    const double sweeps = replicas * (double)p->equilibration + samples * (double)p->every;
    mf_fit_scales_rdf_clear(&rdf);
    const double sweep = molecules ? mf_explain_trajectory(setup, count, range)
                                   : mf_explain_sweep(setup, count, range);
    print_time(sweeps * sweep / fit->problem.threads, time);
    printf(
        "Each of the last iterations, exact within %.2g, takes about %.2g sweeps, "
        "those of its %lld replicas together, and %s with %d thread%s of a processor of 2024, if "
        "samples are as independent as usual; %sa pressure as a target takes more. A fit has some "
        "four to twenty iterations, and most of the first ones are shorter.\n",
        p->precision, sweeps, (long long)p->replicas, time, fit->problem.threads,
        fit->problem.threads == 1 ? "" : "s",
        molecules ? "long molecules take up to ten times as many; " : "");
    return STATUS_OK;
}

static enum status print_simulations(struct fit_file *fit) {
    if (fit->method->kind == INVERSE_INVERSION)
        TRY(print_sampling(fit));
    for (size_t s = 0; s < mf_fit_states_count(fit); s++) {
        const struct fit_file *state = mf_fit_states_at(fit, s);
        if (mf_fit_engine_verifies(state))
            continue;
        struct unknowns unknowns = {0};
        struct unknowns_laws laws = {0};
        enum status status = mf_unknowns_init(&unknowns, &state->problem);
        if (status == STATUS_OK)
            status = mf_unknowns_laws_start(&unknowns, &laws);
        if (status == STATUS_OK)
            status = print_state(state, &laws);
        mf_unknowns_laws_clear(&laws);
        mf_unknowns_clear(&unknowns);
        TRY(status);
    }
    return STATUS_OK;
}

static void print_numbers(const struct fit_file *fit) {
    for (size_t n = 0; n < fit->numbers; n++) {
        const struct inverse_number *number = &fit->number[n];
        const double factor = mf_units_factor(&fit->scene.units, number->unit);
        char unit[UNITS_NAME_SIZE];
        mf_units_name(&fit->scene.units, number->unit, unit);
        printf("%s is to be found from %g to %g%s%s, beginning with %g.\n", number->name,
               factor * number->minimum, factor * number->maximum, unit[0] ? " " : "", unit,
               factor * number->start);
    }
}

static void print_line(void *stream, const char *line) {
    fprintf(stream, "%s\n", line);
}

static enum status print_targets(const struct fit_file *state) {
    if (state->name[0])
        printf("State \"%s\":\n", state->name);
    for (size_t k = 0; k < state->choices.count; k++)
        printf("chosen: %s\n", state->choices.line[k]);
    if (state->choices.doubt[0])
        printf("mesofit: warning: %s\n", state->choices.doubt);
    return mf_fit_print_state(state, &(struct target_sanity_listener){print_line, stdout});
}

static void end_nothing(void *frames) {
    (void)frames;
}

/// In the place of another engine, whose command is not run: nothing is asked of it.
static const struct sampling_engine unasked = {.end = end_nothing};

/// The method refuses what it cannot fit when it is created.
static enum status try_method(struct fit_file *fit) {
    for (size_t s = 0; s < mf_fit_states_count(fit); s++)
        mf_fit_states_at(fit, s)->problem.trial = true;
    if (fit->engine.kind != ENGINE_NONE)
        fit->problem.engine = &unasked;
    void *state = mf_memory_zeroed(1, fit->method->state_size);
    if (state == NULL)
        return STATUS_NO_MEMORY;
    const enum status status =
        fit->method->create(state, fit->method, &fit->problem, fit->method_parameters);
    fit->method->destroy(state);
    mf_memory_free(state);
    return mf_units_convert_message(&fit->scene.units, status);
}

/// The field that says how many simulations a round hands out at once; NULL if the method has none.
static const struct field *find_handed_out(const struct fit_file *fit, int64_t *count) {
    for (const struct inverse_table *table = fit->method->tables; table->fields; table++)
        for (const struct field *field = table->fields; field->name; field++)
            if (strcmp(field->name, "population") == 0 || strcmp(field->name, "replicas") == 0) {
                const char *parameters = fit->method_parameters;
                memcpy(count, parameters + table->offset + field->offset, sizeof *count);
                return field;
            }
    return NULL;
}

/// What would keep all workers busy. A default that did so by itself would make results depend on
/// the machine.
static void print_advice(const struct fit_file *fit, int workers) {
    static const double little = 0.1;
    int64_t count = 0;
    const struct field *field = find_handed_out(fit, &count);
    if (field == NULL || count <= 0)
        return; // none, or chosen by the method
    const int64_t rounds = (count + workers - 1) / workers;
    const double idle = 1 - (double)count / (double)(rounds * workers);
    if (idle > little)
        printf(
            "\"%s\" %lld leaves %.0f %% of %d workers idle; a multiple of %d, such as %lld, leaves "
            "none\n",
            field->name, (long long)count, 100 * idle, workers, workers,
            (long long)(rounds * workers));
}

/// In the order of the run (fit.c), so that it begins with the same curves.
enum status mf_fit_explain(const char *file, const struct run_options *options, int ranks) {
    enum status status = STATUS_OK;
    struct fit_file fit;
    CHECK(mf_fit_file_read(&fit, file, options));
    CHECK(mf_fit_states_normalise(&fit));
    CHECK(mf_fit_engine_expect(&fit, options->engine));
    status = try_method(&fit);
    CHECK(status != STATUS_OK ? mf_status_prefix(status, "%s", file) : STATUS_OK);
    mf_explain_scale(stdout, &fit.scene.units);
    for (size_t s = 0; s < mf_fit_states_count(&fit); s++)
        CHECK(print_targets(mf_fit_states_at(&fit, s)));
    print_numbers(&fit);
    CHECK(print_simulations(&fit));
    if (ranks > 0) {
        print_advice(&fit, ranks * options->threads);
        CHECK(mf_fit_tasks_explain(stdout, file, options, ranks));
    }
done:
    mf_fit_file_clear(&fit);
    return status;
}
