// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimise/optimiser.h"

#include "base/names.h"

#define OPTIMISER_LIST(record, name, summary) &mf_##record##_optimiser,
const struct optimiser *const mf_optimisers[] = {OPTIMISERS(OPTIMISER_LIST) NULL};

NAMED_RECORD(struct optimiser);

const struct optimiser *mf_optimiser_find(const char *name) {
    return mf_names_find(mf_optimisers, name);
}

enum status mf_optimiser_check_space(const struct optimiser_space *space) {
    const double range = space->maximum - space->minimum;
    if (space->variables < 1)
        return mf_status_fail(STATUS_BAD_INPUT, "an optimiser needs at least one variable");
    if (!(range > 0 && range < HUGE_VAL))
        return mf_status_fail(STATUS_BAD_INPUT, "variables from %g to %g have no range to search",
                              space->minimum, space->maximum);
    for (size_t k = 0; space->start && k < space->variables; k++)
        if (!isfinite(space->start[k]))
            return mf_status_fail(STATUS_BAD_INPUT, "variable %zu of the start is %g", k,
                                  space->start[k]);
    return STATUS_OK;
}

enum status mf_optimiser_check_round(const struct optimiser_space *space, size_t count) {
    if (space->max == 0 || count <= space->max)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "\"population\" gives rounds of %zu candidates; the maximum is %zu",
                          count, space->max);
}

double mf_optimiser_reflect(double x) {
    if (!isfinite(x))
        return 0;
    const double within = fabs(fmod(x, 2));
    return within <= 1 ? within : 2 - within;
}

double mf_optimiser_start(const struct optimiser_space *space, size_t variable) {
    if (space->start == NULL)
        return 0.5;
    const double x = (space->start[variable] - space->minimum) / (space->maximum - space->minimum);
    return fmin(fmax(x, 0), 1);
}
