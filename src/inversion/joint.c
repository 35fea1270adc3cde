// SPDX-License-Identifier: GPL-3.0-or-later
//
// The iterations of several states together.
#include "inversion/joint.h"

#include <stdio.h>
#include <string.h>

static void tell_worst(const struct joint *joint, const struct joint_worst *worst, const char *why,
                       char reason[INVERSE_REASON_SIZE]) {
    const struct inversion *state = &joint->state[worst->state];
    snprintf(reason, INVERSE_REASON_SIZE, "%s%s of \"%s\" is off by %.1f times its noise", why,
             mf_targets_name(worst->kind), state->problem->name, worst->noises);
}

/// Where the states want different potentials the steps end in a compromise, about which they go
/// on: the equations of a state that is far off carry the noise of C into the step.
static void end_at_standstill(struct joint *joint, double distance, const struct joint_worst *worst,
                              struct inverse_step *step) {
    static const double progress = 0.95;
    static const uint32_t patience = 5;
    const bool better = step->iteration == 0 || distance < progress * joint->least;
    const bool met = worst->noises <= mf_inverse_noise_margin;
    joint->least = better ? distance : joint->least;
    joint->standstill = better ? 0 : joint->standstill + 1;
    if (met || step->converged)
        return;
    if (!step->finished && joint->standstill >= patience) {
        step->finished = true;
        tell_worst(joint, worst,
                   "no step makes all states better together; they seem to have no potential in "
                   "common: ",
                   step->reason);
    } else if (step->finished) {
        tell_worst(joint, worst, "", step->reason);
    }
}

/// Let the other states sample what the first one does.
static void follow(struct joint *joint) {
    const struct inversion *leader = joint_leader(joint);
    for (size_t s = 1; s < joint->states; s++) {
        struct inversion *state = &joint->state[s];
        memcpy(state->phi, leader->phi, leader->grid.points * sizeof *leader->phi);
        state->progress.iteration = leader->progress.iteration;
        state->progress.anew = leader->progress.anew;
        state->progress.stretch = leader->progress.stretch;
    }
}

static void add_work(struct joint *joint, struct inverse_step *step) {
    for (size_t s = 1; s < joint->states; s++) {
        step->evaluations += joint->state[s].progress.evaluations;
        step->engine_steps += joint->state[s].progress.sweeps;
    }
}

/// Progress of one state, told as a part of that of all.
struct sharing {
    const struct joint *joint;
    size_t state;
    const struct inverse_listener *listener;
};

static void tell_of_state(void *context, const struct inverse_progress *own) {
    const struct sharing *sharing = context;
    const struct inversion *leader = joint_leader(sharing->joint);
    struct inverse_progress all = *own;
    all.done += sharing->state * own->total;
    all.total *= sharing->joint->states;
    all.best = mf_targets_error(&leader->problem->targets, leader->progress.best);
    sharing->listener->tell(sharing->listener->context, &all);
}

static enum status observe(struct joint *joint, const struct inverse_listener *listener) {
    for (size_t s = 0; s < joint->states; s++) {
        struct sharing sharing = {joint, s, listener};
        const struct inverse_listener of_state = {tell_of_state, &sharing};
        TRY(mf_inversion_observe(&joint->state[s], &of_state));
    }
    return STATUS_OK;
}

/// What the states say together. Their coarse steps go by how near each one is itself.
static enum status join(struct joint *joint) {
    const struct inversion *leader = joint_leader(joint);
    const bool groups = leader->coarse.count > 0;
    if (groups)
        TRY(mf_joint_coarse_step(joint, joint->coarse));
    mf_joint_targets_join(joint);
    TRY(mf_inversion_rows_reduce(&joint->rows, joint->state, joint->states, false));
    if (groups)
        TRY(mf_inversion_rows_reduce(&joint->doubted, joint->state, joint->states, true));
    joint->together = (struct inversion_joint){joint->state, joint->states, joint->rows.system,
                                               joint->doubted.system, joint->coarse};
    return STATUS_OK;
}

enum status mf_joint_iterate(void *memory, struct inverse_step *step,
                             const struct inverse_listener *listener) {
    struct joint *joint = memory;
    struct inversion *leader = joint_leader(joint);
    enum status status;
    if (joint->states == 1)
        return mf_inversion_iterate(leader, step, listener);
    follow(joint);
    TRY(observe(joint, listener));
    const struct joint_worst worst = mf_joint_targets_worst(joint);
    const double distance = mf_joint_targets_distance(joint);
    TRY(join(joint));
    leader->joint = &joint->together;
    status = mf_inversion_advance(leader, step);
    leader->joint = NULL;
    TRY(status); // else there is no step
    add_work(joint, step);
    end_at_standstill(joint, distance, &worst, step);
    return STATUS_OK;
}

static enum status allocate(struct joint *joint) {
    enum status status = STATUS_OK;
    const struct inversion *leader = joint_leader(joint);
    if (joint->states == 1)
        return STATUS_OK;
    CHECK(mf_inversion_rows_init(&joint->rows, leader));
    if (leader->coarse.count == 0)
        return STATUS_OK;
    CHECK(mf_inversion_rows_init(&joint->doubted, leader));
    NEW_ARRAY(joint->coarse, leader->grid.points);
done:
    return status;
}

enum status mf_joint_create(void *memory, const struct inverse_method *method,
                            const struct inverse_problem *problem, const void *parameters) {
    enum status status = STATUS_OK;
    struct joint *joint = memory;
    const size_t states = problem->states > 0 ? problem->states : 1;
    NEW_ARRAY(joint->state, states);
    for (; joint->states < states; joint->states++) {
        const struct inverse_problem *own = states > 1 ? problem->state[joint->states] : problem;
        status = mf_inversion_create(&joint->state[joint->states], method, own, parameters);
        CHECK(status == STATUS_OK || states == 1
                  ? status
                  : mf_status_prefix(status, "states.%s", own->name));
    }
    CHECK(allocate(joint));
done:
    if (status != STATUS_OK && joint->state && joint->states < states)
        joint->states++; // the one that failed has memory, too
    return status;
}

void mf_joint_destroy(void *memory) {
    struct joint *joint = memory;
    for (size_t s = 0; s < joint->states; s++)
        mf_inversion_destroy(&joint->state[s]);
    mf_memory_free(joint->state);
    mf_inversion_rows_clear(&joint->rows);
    mf_inversion_rows_clear(&joint->doubted);
    mf_memory_free(joint->coarse);
}

size_t mf_joint_spans(void *memory, struct memory_span *span) {
    struct joint *joint = memory;
    size_t n = 0;
    span[n++] = (struct memory_span){&joint->least, sizeof joint->least};
    span[n++] = (struct memory_span){&joint->standstill, sizeof joint->standstill};
    for (size_t s = 0; s < joint->states; s++)
        n += mf_inversion_spans(&joint->state[s], span + n);
    return n;
}

enum status mf_joint_write(const void *memory, const struct inverse_folder *folder) {
    return mf_inversion_write(joint_leader(memory), folder);
}
