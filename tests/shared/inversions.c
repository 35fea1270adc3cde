// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/inversions.h"

#include "shared/testing.h"

#include <stdlib.h>

static void ignore(void *context, const struct inverse_progress *progress) {
    (void)context, (void)progress;
}

void inversions_run(const struct inverse_method *method, const struct inverse_problem *problem,
                    double precision, double *phi, double *phi_error, struct inverse_step *step) {
    const struct inverse_listener listener = {ignore, NULL};
    const size_t pairs = (size_t)mf_composition_pairs(&problem->scene.composition);
    const size_t points = pairs * (problem->targets.bins.count + 1);
    void *state = calloc(1, method->state_size);
    struct inversion_parameters *settings = calloc(1, method->parameters_size);
    assert_non_null(state);
    assert_non_null(settings);
    for (const struct inverse_table *table = method->tables; table->fields; table++)
        mf_fields_set_defaults(table->fields, (char *)settings + table->offset);
    settings->replicas = 4;
    settings->samples = 250;
    settings->equilibration = 100;
    settings->iterations = 40;
    if (precision > 0)
        settings->precision = precision;
    assert_ok(method->create(state, method, problem, settings));
    do {
        assert_ok(method->iterate(state, step, &listener));
        print_message("%s, iteration %u: rms of g %.5f, noise %.5f\n", method->name,
                      step->iteration, step->error, step->noise);
    } while (!step->finished);
    memcpy(phi, step->curve[UNKNOWN_POTENTIAL], points * sizeof *phi);
    if (phi_error)
        memcpy(phi_error, step->curve_error[UNKNOWN_POTENTIAL], points * sizeof *phi_error);
    method->destroy(state);
    free(state);
    free(settings);
}
