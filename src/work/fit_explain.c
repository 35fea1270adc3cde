// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"
#include "problem/unknowns.h"
#include "work/explain.h"
#include "input/target_sanity.h"
#include "work/fit.h"
#include "input/fit_file.h"

/// What is measured of targets in simulations with some time step.
struct measured {
    struct motion_plan motion;
    struct etd_plan etd;
    struct explain_measured explain;
};

static struct measured measured_of(const struct targets *targets,
                                   const struct simulation_setup *setup, int64_t every) {
    const struct pair_law law = {.potential = setup->potential, .omega = setup->omega};
    struct measured measured;
    mf_measurement_plans(targets, setup->time_step, &measured.etd, &measured.motion);
    measured.explain = (struct explain_measured){
        .has_potential = setup->potential != NULL,
        .cutoff = mf_pair_cutoff(&law),
        .rdf_range = targets_ask(targets, TARGET_RDF) ? mf_rdf_bins_range(&targets->bins) : 0,
        .every = every,
        .sums = targets_ask(targets, TARGET_PRESSURE)};
    return measured;
}

static void print_simulation(const struct measured *measured, const struct targets *targets,
                             const struct simulation_setup *setup) {
    struct explain_measured explain = measured->explain;
    explain.etd_plan = &measured->etd;
    explain.etd_grid = targets_ask(targets, TARGET_ETD) ? &targets->etd : NULL;
    explain.motion = mf_measurement_moves(targets) ? &measured->motion : NULL;
    mf_explain_scene(stdout, setup, &explain);
}

/// Simulations with the curves that the fit begins with.
static void print_simulations(const struct fit_file *fit, const struct unknowns_laws *laws) {
    const struct inverse_problem *problem = &fit->problem;
    struct simulation_setup setup = laws->problem.scene;
    setup.potential = laws->table[UNKNOWN_POTENTIAL];
    setup.omega = laws->table[UNKNOWN_OMEGA];
    if (fit->method->kind == INVERSE_MATCHING) {
        const struct inverse_sampling sampling = fit->method->sampling(fit->method_parameters);
        struct measured measured = measured_of(&problem->targets, &setup, sampling.every);
        measured.explain.rdf_force = measured.explain.rdf_force_alone =
            sampling.rdf_force && targets_ask(&problem->targets, TARGET_RDF) &&
            !composition_is_mixed(&setup.composition);
        printf("An evaluation of the method \"%s\", one a thread:\n", fit->method->name);
        print_simulation(&measured, &problem->targets, &setup);
    } else {
        printf("The method \"%s\" samples by a Monte Carlo of its own, not by the dynamics of the "
               "scene.\n",
               fit->method->name);
    }
    if (fit->verification.time_step > 0)
        setup.time_step = fit->verification.time_step;
    struct measured measured =
        measured_of(&problem->compared, &setup, fit->verification.plan.every);
    measured.explain.sums = true;
    printf("A replica of the verification, one a thread:\n");
    print_simulation(&measured, &problem->compared, &setup);
}

static void print_numbers(const struct fit_file *fit) {
    for (size_t n = 0; n < fit->numbers; n++) {
        const struct inverse_number *number = &fit->number[n];
        printf("%s is to be found from %g to %g%s%s, beginning with %g.\n", number->name,
               number->minimum, number->maximum, number->unit[0] ? " " : "", number->unit,
               number->start);
    }
}

static void print_line(void *stream, const char *line) {
    fprintf(stream, "%s\n", line);
}

/// The method refuses what it cannot fit when it is created.
static enum status try_method(const struct fit_file *fit) {
    void *state = mf_memory_zeroed(1, fit->method->state_size);
    if (state == NULL)
        return STATUS_NO_MEMORY;
    const enum status status =
        fit->method->create(state, fit->method, &fit->problem, fit->method_parameters);
    fit->method->destroy(state);
    mf_memory_free(state);
    return status;
}

/// In the order of the run (fit.c), so that it begins with the same curves.
enum status mf_fit_explain(const char *file, const struct run_options *options) {
    enum status status = STATUS_OK;
    struct fit_file fit;
    struct unknowns unknowns = {0};
    struct unknowns_laws laws = {0};
    CHECK(mf_fit_file_read(&fit, file, options));
    CHECK(mf_target_files_normalise(&fit.files, &fit.scene.setup.box));
    status = mf_unknowns_init(&unknowns, &fit.problem);
    if (status == STATUS_OK)
        status = try_method(&fit);
    CHECK(status != STATUS_OK ? mf_status_prefix(status, "%s", file) : STATUS_OK);
    CHECK(mf_unknowns_laws_start(&unknowns, &laws));
    CHECK(mf_target_sanity_tell(&fit.files, &fit.scene,
                                &(struct target_sanity_listener){print_line, stdout}));
    print_numbers(&fit);
    print_simulations(&fit, &laws);
done:
    mf_unknowns_laws_clear(&laws);
    mf_unknowns_clear(&unknowns);
    mf_fit_file_clear(&fit);
    return status;
}
