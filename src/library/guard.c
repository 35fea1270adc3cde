// SPDX-License-Identifier: GPL-3.0-or-later
#include "library/guard.h"

#include "base/process_lock.h"
#include "base/version.h"
#include "mesofit.h"

#include <assert.h>
#include <gsl/gsl_errno.h>
#include <locale.h>
#include <string.h>

static_assert((int)MESOFIT_BAD_INPUT == (int)STATUS_BAD_INPUT &&
                  (int)MESOFIT_INTERRUPTED == (int)STATUS_INTERRUPTED,
              "both enumerations are the same");

/// Of all threads, by the lock of the process.
static unsigned inside;
static gsl_error_handler_t *handler_outside;

/// Of this thread, which may call from a function of the caller's that is called.
static _Thread_local unsigned depth;
static _Thread_local locale_t locale_outside;

void mf_guard_enter(void) {
    static locale_t plain; // lives as long as the process
    mf_process_lock();
    if (plain == (locale_t)0)
        plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (inside++ == 0)
        handler_outside = gsl_set_error_handler_off();
    mf_process_unlock();
    if (depth++ == 0)
        locale_outside = uselocale(plain);
}

void mf_guard_leave(void) {
    if (--depth == 0)
        uselocale(locale_outside);
    mf_process_lock();
    if (--inside == 0)
        gsl_set_error_handler(handler_outside);
    mf_process_unlock();
}

enum mesofit_status mf_guard_return(enum status status) {
    mf_guard_leave();
    return (enum mesofit_status)status;
}

const char *mesofit_message(void) {
    return mf_status_message();
}

const char *mesofit_version(void) {
    return mf_version;
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
                 SIZE(mesofit_piece),
                 SIZE(mesofit_rdf_plan),
                 SIZE(mesofit_run_progress),
                 SIZE(mesofit_samples),
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
