// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A fit of the caller's, written as the text of a run file with tables in memory.
#pragma once

#include "base/status.h"
#include "mesofit/fit.h"

enum { FIT_TEXT_TABLES = 3 };

struct fit_text {
    char *text;
    struct mesofit_table table[FIT_TEXT_TABLES];
    size_t tables;
    double *values[FIT_TEXT_TABLES]; ///< of the tables
};

/// Fails: BAD_INPUT if a pointer is missing or `settings` is no object; NO_MEMORY.
enum status mf_fit_text_write(struct fit_text *run,
                              const struct mesofit_fit_options *options) MUST_USE;
void mf_fit_text_clear(struct fit_text *run);
