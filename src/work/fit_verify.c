// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/fit_verify.h"

#include "problem/unknowns.h"
#include "report/fit_output.h"
#include "report/fit_verdict.h"

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
    return status;
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
