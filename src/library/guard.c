// SPDX-License-Identifier: GPL-3.0-or-later
#include "library/guard.h"

#include "mesofit.h"

#include <assert.h>
#include <gsl/gsl_errno.h>
#include <pthread.h>

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
