// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/fit_verify.h"

#include "input/fit_states.h"
#include "problem/unknowns.h"
#include "report/fit_output.h"
#include "report/fit_verdict.h"

enum status mf_fit_verify_folders(const struct fit_file *fit, const struct run_folder *folder) {
    for (size_t s = 0; s < fit->others; s++)
        TRY(mf_run_folder_open_state(folder, fit->other[s].name, &fit->inputs));
    return STATUS_OK;
}

enum status mf_fit_verify_begin(const struct fit_file *fit, const struct run_folder *folder,
                                bool resume) {
    for (size_t s = 0; s < fit->others; s++)
        TRY(mf_run_folder_begin_state(folder, fit->other[s].name, resume));
    return STATUS_OK;
}

enum status mf_fit_verify_state(const struct fit_file *state, double *const *curve,
                                const struct inverse_parameter *number,
                                const struct inverse_listener *listener,
                                struct verification *verification) {
    struct unknowns unknowns = {0};
    struct unknowns_laws laws = {0};
    double value[INVERSE_MOST_NUMBERS];
    enum status status = STATUS_OK;
    for (int n = 0; n < INVERSE_MOST_NUMBERS; n++)
        value[n] = number[n].value;
    CHECK(mf_unknowns_init(&unknowns, &state->problem));
    CHECK(mf_unknowns_laws_make(&unknowns, (const double *const *)curve, value, &laws));
    CHECK(mf_verify(&laws.problem, laws.table[UNKNOWN_POTENTIAL], laws.table[UNKNOWN_OMEGA],
                    &state->verification, listener, verification));
    mf_fit_verdict_mark(&state->scene.units, verification);
done:
    mf_unknowns_laws_clear(&laws);
    mf_unknowns_clear(&unknowns);
    return mf_fit_states_mark(state, status);
}

/// Begin a reason with the name of the state that it is about.
static void name_state(const struct fit_file *state, char reason[INVERSE_REASON_SIZE]) {
    char text[INVERSE_REASON_SIZE];
    snprintf(text, sizeof text, "%s", reason);
    snprintf(reason, INVERSE_REASON_SIZE, "state \"%s\": %.*s", state->name,
             INVERSE_REASON_SIZE - FIT_STATE_NAME_SIZE - 12, text);
}

static bool is_contradicted(const struct fit_file *state, const struct inverse_method *method,
                            const struct verification *verification, double error, double variance,
                            char reason[INVERSE_REASON_SIZE]) {
    static const double noise_margin = 3;
    const struct targets *targets = &state->problem.targets;
    return method->kind == INVERSE_INVERSION && !method->restricted
               ? mf_fit_verdict_contradicts(verification, targets_ask(targets, TARGET_PRESSURE),
                                            state->problem.scene.temperature, noise_margin,
                                            &state->scene.units, reason)
               : mf_fit_verdict_is_worse(verification, targets, error, variance, reason);
}

bool mf_fit_verify_contradicts(const struct fit_file *fit, const struct verification *verification,
                               double error, double variance, char reason[INVERSE_REASON_SIZE]) {
    for (size_t s = 0; s <= fit->others; s++) {
        const struct fit_file *state = s == 0 ? fit : &fit->other[s - 1];
        if (!is_contradicted(state, fit->method, &verification[s], error, variance, reason))
            continue;
        if (state->name[0])
            name_state(state, reason);
        return true;
    }
    return false;
}

enum status mf_fit_verify_write(const struct fit_file *fit, size_t s,
                                const struct verification *verification,
                                const struct run_folder *folder) {
    struct run_folder own;
    if (s == 0)
        return mf_fit_output_observables(fit, verification, folder);
    const struct fit_file *state = &fit->other[s - 1];
    TRY(mf_run_folder_state(folder, state->name, &own));
    TRY(mf_fit_output_observables(state, verification, &own));
    mf_run_folder_draw(&own);
    return STATUS_OK;
}
