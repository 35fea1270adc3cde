// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_state.h"

#include "observe/kirkwood_buff.h"

#include <math.h>

static const struct target *target_of(const struct inversion_state *state) {
    return &state->problem->targets.target[mf_kirkwood_buff_kind()];
}

enum status mf_inversion_kirkwood_buff_init(struct inversion_state *state) {
    enum status status = STATUS_OK;
    struct inversion_kirkwood_buff *kb = &state->kirkwood_buff;
    const struct targets *targets = &state->problem->targets;
    const struct kirkwood_buff_settings *settings =
        targets->settings[mf_observable_kind(mf_kirkwood_buff_kind()).place];
    kb->pairs = target_of(state)->count;
    if (kb->pairs == 0)
        return STATUS_OK;
    kb->q_maximum = settings->q_maximum;
    NEW_ARRAY(kb->slope, kb->pairs * state->grid.known);
done:
    return status;
}

void mf_inversion_kirkwood_buff_clear(struct inversion_kirkwood_buff *kb) {
    mf_memory_free(kb->slope);
    *kb = (struct inversion_kirkwood_buff){0};
}

void mf_inversion_kirkwood_buff_measure(struct inversion_state *state) {
    struct inversion_kirkwood_buff *kb = &state->kirkwood_buff;
    for (size_t pair = 0; pair < kb->pairs; pair++) {
        const struct replicas_mean mean =
            mf_replicas_mean(&state->replicas, SAMPLER_SUMS + pair, state->inefficiency);
        kb->value[pair] = mean.mean;
        kb->error[pair] = mean.error;
    }
    if (kb->pairs > 0)
        state->assessment.distance[mf_kirkwood_buff_kind()] =
            mf_targets_worst(target_of(state), kb->value, kb->error);
}

void mf_inversion_kirkwood_buff_respond(struct inversion_state *state, double share) {
    const struct inversion_kirkwood_buff *kb = &state->kirkwood_buff;
    const struct potential_grid *grid = &state->grid;
    const double temperature = state->problem->scene.temperature;
    for (size_t pair = 0; pair < kb->pairs; pair++)
        for (size_t b = 0; b < grid->known; b++) {
            double *slope = &kb->slope[pair * grid->known + b];
            const double now =
                -mf_comoments_covariance(&state->replicas.counts, state->bins + SAMPLER_SUMS + pair,
                                         grid->known_bin[b]) /
                temperature;
            *slope = (1 - share) * *slope + share * now;
        }
}

struct inverse_doubling mf_inversion_kirkwood_buff_noise(const struct inversion_state *state) {
    static const double noise_share = 0.5;
    const struct inversion_kirkwood_buff *kb = &state->kirkwood_buff;
    const struct target *target = target_of(state);
    struct inverse_doubling noisiest = {.wanted = 1, .unit = ""};
    if (!mf_inversion_state_is_near(state))
        return noisiest;
    for (size_t pair = 0; pair < kb->pairs; pair++) {
        const double off = fabs(kb->value[pair] - target->value[pair]);
        const double wanted = fmax(target->error[pair], noise_share * off);
        if (kb->error[pair] * noisiest.wanted > noisiest.noise * wanted)
            noisiest = (struct inverse_doubling){
                .noise = kb->error[pair],
                .wanted = wanted,
                .unit = mf_observable_kind(mf_kirkwood_buff_kind()).target->unit};
    }
    return noisiest;
}
