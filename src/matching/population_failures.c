// SPDX-License-Identifier: GPL-3.0-or-later
//
// What candidates have failed of, as a line for a person.
#include "matching/population.h"

#include <math.h>
#include <stdio.h>

enum { CAUSE_SIZE = 160 };

void mf_population_add_failure(struct population_failures *failures,
                               const struct evaluate_result *result) {
    if (result->error < OPTIMISER_FAILED)
        return;
    const bool first = failures->count[EVALUATE_TEMPERATURE] == 0;
    failures->count[result->failure]++;
    if (result->failure != EVALUATE_TEMPERATURE)
        return;
    failures->coldest = first ? result->temperature : fmin(failures->coldest, result->temperature);
    failures->hottest = first ? result->temperature : fmax(failures->hottest, result->temperature);
}

static void describe(const struct population_failures *failures, enum evaluate_failure cause,
                     char text[CAUSE_SIZE]) {
    static const char *const others[EVALUATE_FAILURES] = {
        [EVALUATE_BLEW_UP] = "blew up: a shorter \"time_step\" or a narrower range of the curves "
                             "may help",
        [EVALUATE_COLLAPSED] = "collapsed into a drop: curves that attract less may help",
        [EVALUATE_UNMEASURED] = "did not measure all targets: more \"samples\" may help",
    };
    if (cause != EVALUATE_TEMPERATURE)
        snprintf(text, CAUSE_SIZE, "%s", others[cause]);
    else
        snprintf(text, CAUSE_SIZE,
                 "had %.3g to %.3g times their temperature after \"equilibration\": a longer one "
                 "or a shorter \"time_step\" may help",
                 failures->coldest, failures->hottest);
}

void mf_population_report_failure(const struct population *population, const char *why,
                                  char reason[INVERSE_REASON_SIZE]) {
    const struct population_failures *failures = &population->totals.failures;
    const unsigned long long all = population->totals.evaluations;
    unsigned long long failed = 0;
    enum evaluate_failure cause = EVALUATE_BLEW_UP;
    char text[CAUSE_SIZE], which[64];
    for (enum evaluate_failure k = 0; k < EVALUATE_FAILURES; k++) {
        failed += failures->count[k];
        cause = failures->count[k] > failures->count[cause] ? k : cause;
    }
    describe(failures, cause, text);
    if (failed == failures->count[cause])
        snprintf(which, sizeof which, "all %llu", failed);
    else
        snprintf(which, sizeof which, "%llu of %llu", (unsigned long long)failures->count[cause],
                 failed);
    if (failed == 0)
        snprintf(reason, INVERSE_REASON_SIZE, "all %llu simulations succeeded, %s", all, why);
    else if (failed < all)
        snprintf(reason, INVERSE_REASON_SIZE,
                 "%llu of %llu simulations succeeded, %s; %s that failed %s", all - failed, all,
                 why, which, text);
    else
        snprintf(reason, INVERSE_REASON_SIZE, "not one simulation of the fit succeeded; %s %s",
                 which, text);
}
