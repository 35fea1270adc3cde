// SPDX-License-Identifier: GPL-3.0-or-later
#include "library/run_observables.h"

static ptrdiff_t ask(void *context, const struct caller_sample *sample, size_t room,
                     double *values) {
    const struct mesofit_named_observable *const own = context;
    return own->function(own->context, sample->count, sample->dimensions, sample->position,
                         sample->velocity, sample->type, sample->edge, room, values);
}

enum status mf_run_observables_begin(struct caller_observables *callers,
                                     const struct mesofit_named_observable *given, size_t count) {
    if (count > CALLER_OBSERVABLES_MAX)
        return mf_status_fail(STATUS_BAD_INPUT, "%zu observables: at most %d can be measured",
                              count, CALLER_OBSERVABLES_MAX);
    for (size_t k = 0; k < count; k++) {
        if (given[k].function == NULL)
            return mf_status_fail(STATUS_BAD_INPUT, "observable \"%.60s\" has no function",
                                  given[k].name ? given[k].name : "");
        // What is lent is not changed: the context of all functions is of one type, no more.
        callers->item[k] = (struct caller_observable){
            .name = given[k].name, .function = ask, .context = (void *)&given[k]};
    }
    callers->count = count;
    return STATUS_OK;
}
