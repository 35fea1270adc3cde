// SPDX-License-Identifier: GPL-3.0-or-later
#include "inversion/inversion_states.h"

#include "inversion/inversion.h"

#include <stdio.h>

static void report_worst(const struct inversion *inversion, const struct inversion_worst *worst,
                         const char *why, char reason[INVERSE_REASON_SIZE]) {
    snprintf(reason, INVERSE_REASON_SIZE, "%s%s of \"%s\" is off by %.1f times its noise", why,
             mf_targets_name(worst->kind), inversion->state[worst->state].problem->name,
             worst->noises);
}

size_t mf_inversion_states_widest(const struct inversion_state *state, size_t states) {
    size_t widest = 0, most = 0;
    for (size_t s = 0; s < states; s++) {
        size_t seen = 0;
        for (size_t a = 0; a < state[s].grid.known; a++)
            seen += state[s].grid.seen[a];
        if (seen > most) {
            most = seen;
            widest = s;
        }
    }
    return widest;
}

void mf_inversion_states_end(struct inversion *inversion, struct inverse_step *step) {
    static const double progress = 0.95;
    static const uint32_t patience = 5;
    struct inversion_stagnation *still = &inversion->stagnation;
    const struct inversion_worst worst =
        mf_inversion_states_worst(inversion->state, inversion->states);
    const double distance = mf_inversion_states_distance(inversion->state, inversion->states);
    const bool better = step->iteration == 0 || distance < progress * still->min;
    const bool met = worst.noises <= mf_inverse_noise_margin;
    still->min = better ? distance : still->min;
    still->iterations = better ? 0 : still->iterations + 1;
    if (met || step->converged)
        return;
    if (!step->finished && still->iterations >= patience) {
        step->finished = true;
        report_worst(
            inversion, &worst,
            "no step improves all states together; they seem to have no common potential: ",
            step->reason);
    } else if (step->finished) {
        report_worst(inversion, &worst, "", step->reason);
    }
}
