/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file Optimisers for noisy errors in a box, by ask and tell: the caller owns the loop. */
#ifndef MESOFIT_OPTIMISER_H
#define MESOFIT_OPTIMISER_H

#include "mesofit/status.h"

#include <stddef.h>
#include <stdint.h>

struct mesofit_optimiser;

/** @param name        "genetic", "cma-es" or "nlopt"
 *  @param settings    a JSON object as in a run file's "method", or NULL
 *  @param dimensions  numbers of a candidate, each from `minimum` to `maximum`
 *  @param start       shape [dimensions], or NULL
 *  NULL on failure: BAD_INPUT, NO_MEMORY. */
MESOFIT_API struct mesofit_optimiser *
mesofit_optimiser_create(const char *name, const char *settings, size_t dimensions, double minimum,
                         double maximum, const double *start, uint64_t seed);
MESOFIT_API void mesofit_optimiser_free(struct mesofit_optimiser *optimiser);

/** The candidates to be measured next, shape [*count, dimensions], which belong to the optimiser;
 *  *count is 0 when it has finished. Fails: NO_MEMORY. */
MESOFIT_API enum mesofit_status mesofit_optimiser_ask(struct mesofit_optimiser *optimiser,
                                                      const double **population, size_t *count);

/** Their errors, shape [count], and the variances of these by noise, or NULL if they are exact.
 *  What could not be measured is infinite. Fails: NO_MEMORY. */
MESOFIT_API enum mesofit_status mesofit_optimiser_tell(struct mesofit_optimiser *optimiser,
                                                       const double *errors,
                                                       const double *variances);

/** What it believes best, shape [dimensions]; 0, and nothing written, before the first tell. */
MESOFIT_API int mesofit_optimiser_best(const struct mesofit_optimiser *optimiser, double *best);

#endif
