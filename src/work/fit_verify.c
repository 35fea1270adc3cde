// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/fit_verify.h"

#include "base/clock.h"
#include "base/spent.h"
#include "defaults/fit_engine.h"
#include "defaults/fit_states.h"
#include "defaults/methods.h"
#include "problem/unknowns.h"
#include "report/fit_output.h"
#include "report/fit_verification.h"

#include <string.h>

enum status mf_fit_verify_folders(const struct fit_file *fit, struct run_folder *folder) {
    for (size_t s = 0; s <= fit->others; s++) {
        if (s > 0)
            TRY(mf_run_folder_check_state(folder, fit->other[s - 1].name));
        char inside[OUTPUT_PATH_SIZE] = "";
        if (s > 0)
            snprintf(inside, sizeof inside, STATES_FOLDER "/%.3000s/", fit->other[s - 1].name);
        TRY(mf_fit_reserve_observables(s == 0 ? fit : &fit->other[s - 1], inside, folder));
    }
    return STATUS_OK;
}

/// Samples of a state, reported among those of all: more are taken with a shorter time step.
struct sharing {
    uint64_t before, after; ///< of other states
    uint64_t here;          ///< of this one, so far
    const struct inverse_listener *listener;
};

static void report_of_state(void *context, const struct inverse_progress *own) {
    struct sharing *sharing = context;
    struct inverse_progress reported = *own;
    reported.done += sharing->before;
    reported.total += sharing->before + sharing->after;
    sharing->here = own->total;
    sharing->listener->report(sharing->listener->context, &reported);
}

/// The engine advises a shorter "time_step", which here is the verification's own.
static enum status advise(const struct fit_file *state, const struct verify_step *step,
                          enum status status) {
    const struct units *units = &state->scene.units;
    const double time = mf_units_factor(units, "tau");
    char unit[UNITS_NAME_SIZE], message[STATUS_MESSAGE_SIZE];
    if (mf_units_convert_message(units, status) != STATUS_UNSTABLE || mf_fit_engine_verifies(state))
        return status;
    snprintf(message, sizeof message, "%s", mf_status_message());
    mf_units_suffix(units, "tau", unit);
    if (step->shortens)
        return mf_status_fail(status,
                              "%s; the verification had a time step of %.4g%s, a sixteenth of the "
                              "one chosen, and no shorter one is tried: the potential is too "
                              "rough; wider bins of g(r) (\"bin_width\") make it smooth",
                              message, time * step->used, unit);
    return mf_status_fail(status,
                          "%s; the verification had a time step of %.4g%s, and a shorter "
                          "\"verification.time_step\" may help, as %.2g%s by the curvature of the "
                          "potential that was found",
                          message, time * step->used, unit, time * step->would_hold, unit);
}

/// Equilibrations of so many times the steps of a whole verification before.
enum { AGAIN = 4 };

/// The steps of a verification of a state, in the first round or the next.
static struct verify_parameters plan_of(const struct fit_file *state, int round) {
    struct verify_parameters parameters = state->verification;
    if (round > 0)
        parameters.plan.equilibration = AGAIN * (parameters.plan.equilibration +
                                                 parameters.plan.samples * parameters.plan.every);
    return parameters;
}

static enum status verify_state(const struct fit_file *state, int round, double *const *curve,
                                const struct inverse_parameter *number,
                                const struct inverse_listener *listener,
                                struct verification *verification) {
    struct unknowns unknowns = {0};
    struct unknowns_laws laws = {0};
    const struct verify_parameters parameters = plan_of(state, round);
    struct inverse_problem problem = state->problem;
    double value[INVERSE_MAX_NUMBERS];
    enum status status = STATUS_OK;
    problem.engine = mf_fit_engine_verifies(state) ? problem.engine : NULL;
    problem.knows_elsewhere = problem.knows_elsewhere && problem.engine;
    for (int n = 0; n < INVERSE_MAX_NUMBERS; n++)
        value[n] = number[n].value;
    CHECK(mf_unknowns_init(&unknowns, &problem));
    CHECK(mf_unknowns_laws_make(&unknowns, (const double *const *)curve, value, &laws));
    status = mf_verify(&laws.problem, laws.table[UNKNOWN_POTENTIAL], laws.table[UNKNOWN_OMEGA],
                       &parameters, listener, verification);
    CHECK(advise(state, &verification->step, status));
    mf_fit_step_add_dynamics(state, verification);
    verification->sampled = mf_methods_sampled_particles(state);
    mf_fit_verification_add_units(&state->scene.units, verification);
done:
    mf_unknowns_laws_clear(&laws);
    mf_unknowns_clear(&unknowns);
    return mf_fit_states_mark(state, status);
}

static uint64_t samples_of(const struct fit_file *state) {
    const struct verify_parameters *verification = &state->verification;
    return (uint64_t)(verification->replicas * verification->plan.samples);
}

static enum status verify_round(struct fit_file *fit, int round, double *const *curve,
                                const struct inverse_parameter *number,
                                const struct inverse_listener *listener,
                                struct verification *verification) {
    const size_t states = mf_fit_states_count(fit);
    struct sharing sharing = {.listener = listener};
    const struct inverse_listener of_state = {report_of_state, &sharing};
    for (size_t s = 0; s < states; s++)
        sharing.after += samples_of(mf_fit_states_at(fit, s));
    for (size_t s = 0; s < states; s++) {
        const struct fit_file *state = mf_fit_states_at(fit, s);
        sharing.after -= samples_of(state);
        TRY(verify_state(state, round, curve, number, &of_state, &verification[s]));
        sharing.before += sharing.here;
    }
    return STATUS_OK;
}

/// Begin a reason with the name of the state that it is about.
static void name_state(const struct fit_file *state, char reason[INVERSE_REASON_SIZE]) {
    char text[INVERSE_REASON_SIZE];
    snprintf(text, sizeof text, "%s", reason);
    snprintf(reason, INVERSE_REASON_SIZE, "state \"%s\": %.*s", state->name,
             INVERSE_REASON_SIZE - FIT_STATE_NAME_SIZE - 12, text);
}

static bool is_contradicted(const struct fit_file *state, const struct inverse_method *method,
                            const struct verification *verification,
                            const struct inverse_step *of_fit, char reason[INVERSE_REASON_SIZE]) {
    const struct targets *targets = &state->problem.targets;
    const struct units *units = &state->scene.units;
    const double temperature = state->problem.scene.temperature;
    if (method->kind == INVERSE_DIRECT)
        return false; // it promises nothing of its targets
    if (method->kind == INVERSE_MATCHING)
        return mf_fit_verification_is_worse(verification, targets, of_fit->error, of_fit->variance,
                                            reason);
    if (method->restricted)
        return mf_fit_verification_is_worse_than_samples(
            verification, targets, of_fit->error, of_fit->variance, temperature, units, reason);
    return mf_fit_verification_contradicts(verification, targets, temperature, units, reason);
}

/// Whether a target is of what friction makes where that does no more than hold the temperature.
static bool is_of_thermostat(const struct fit_file *state, int kind) {
    const struct observable *of = mf_observable_kind(kind).observable;
    return state->choices.thermostat && of && of->of_time;
}

/// What the fitted targets leave open of each that is only compared (mf_verify_compare): where a
/// potential is found, of the pressure, or the density, what g(r) alone does.
static void find_open(const struct fit_file *fit, const struct fit_file *state,
                      const struct inverse_ramp *ramp, double open[TARGETS]) {
    const struct inverse_problem *problem = &state->problem;
    for (int kind = 0; kind < TARGETS; kind++)
        open[kind] =
            targets_ask(&problem->targets, kind) || is_of_thermostat(state, kind) ? INFINITY : 0;
    if (!problem->unknown[UNKNOWN_POTENTIAL].wanted)
        return;
    const enum target_kind bulk = inverse_problem_bulk(problem);
    open[TARGET_PRESSURE] = open[TARGET_DENSITY] = INFINITY;
    // Of several states that of the first is known, and together they leave less open.
    if (!targets_ask(&problem->targets, bulk) && fit->others == 0 && ramp->bulk_open > 0)
        open[bulk] = ramp->bulk_open;
}

bool mf_fit_verify_any_contradicts(const struct fit_file *fit, struct verification *verification,
                                   const struct inverse_step *of_fit,
                                   char reason[INVERSE_REASON_SIZE]) {
    for (size_t s = 0; s <= fit->others; s++) {
        const struct fit_file *state = s == 0 ? fit : &fit->other[s - 1];
        struct verification *const own = &verification[s];
        double open[TARGETS];
        own->share = mf_verify_agree(&state->problem.targets, &own->sections, &own->observed,
                                     of_fit->noise_of_state[s], own->agreement);
        find_open(fit, state, &of_fit->ramp, open);
        mf_verify_compare(&state->problem.compared, &own->sections, &own->observed, own->share,
                          open, own->compared);
    }
    for (size_t s = 0; s <= fit->others; s++) {
        const struct fit_file *state = s == 0 ? fit : &fit->other[s - 1];
        if (!is_contradicted(state, fit->method, &verification[s], of_fit, reason))
            continue;
        if (state->name[0])
            name_state(state, reason);
        return true;
    }
    return false;
}

enum status mf_fit_verify_states(struct fit_file *fit, double *const *curve,
                                 const struct inverse_parameter *number,
                                 const struct inverse_step *of_fit, struct progress *progress,
                                 const struct inverse_listener *listener,
                                 struct verification *verification) {
    const double begun = clock_process_seconds();
    char reason[INVERSE_REASON_SIZE];
    TRY(verify_round(fit, 0, curve, number, listener, verification));
    if (of_fit && mf_fit_verify_any_contradicts(fit, verification, of_fit, reason)) {
        mf_progress_print(progress,
                          "the verification contradicts the fit, and begins "
                          "again with %d times as many steps before its samples",
                          AGAIN);
        for (size_t s = 0; s < mf_fit_states_count(fit); s++)
            mf_verify_clear(&verification[s]);
        TRY(verify_round(fit, 1, curve, number, listener, verification));
    }
    mf_spent_add(SPENT_VERIFICATION, clock_process_seconds() - begun);
    return STATUS_OK;
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
