// SPDX-License-Identifier: GPL-3.0-or-later
#include "library/guard.h"

#include "mesofit.h"

#include <assert.h>
#include <gsl/gsl_errno.h>
#include <pthread.h>
#include <string.h>

static_assert((int)MESOFIT_BAD_INPUT == (int)STATUS_BAD_INPUT &&
                  (int)MESOFIT_INTERRUPTED == (int)STATUS_INTERRUPTED,
              "both enumerations are the same");

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static unsigned inside;
static gsl_error_handler_t *handler_outside;

void mf_guard_enter(void) {
    pthread_mutex_lock(&lock);
    if (inside++ == 0)
        handler_outside = gsl_set_error_handler_off();
    pthread_mutex_unlock(&lock);
}

void mf_guard_leave(void) {
    pthread_mutex_lock(&lock);
    if (--inside == 0)
        gsl_set_error_handler(handler_outside);
    pthread_mutex_unlock(&lock);
}

enum mesofit_status mf_guard_return(enum status status) {
    mf_guard_leave();
    return (enum mesofit_status)status;
}

const char *mesofit_message(void) {
    return mf_status_message();
}

const char *mesofit_version(void) {
    return MESOFIT_VERSION;
}

size_t mesofit_size_of(const char *name) {
#define SIZE(type)                                                                                 \
    { #type, sizeof(struct type) }
    static const struct {
        const char *name;
        size_t size;
    } sizes[] = {SIZE(mesofit_columns),
                 SIZE(mesofit_curve),
                 SIZE(mesofit_fit_options),
                 SIZE(mesofit_fit_state),
                 SIZE(mesofit_frame),
                 SIZE(mesofit_inputs),
                 SIZE(mesofit_named_observable),
                 SIZE(mesofit_law),
                 SIZE(mesofit_means),
                 SIZE(mesofit_rdf_plan),
                 SIZE(mesofit_run_progress),
                 SIZE(mesofit_scene),
                 SIZE(mesofit_table),
                 SIZE(mesofit_text),
                 SIZE(mesofit_trajectory),
                 SIZE(mesofit_verification)};
#undef SIZE
    for (size_t k = 0; name && k < sizeof sizes / sizeof *sizes; k++)
        if (strcmp(sizes[k].name, name) == 0)
            return sizes[k].size;
    return 0;
}
