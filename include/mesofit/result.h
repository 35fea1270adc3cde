/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file What is in a folder of results, whoever wrote it, the program or the library. */
#ifndef MESOFIT_RESULT_H
#define MESOFIT_RESULT_H

#include "mesofit/status.h"

#include <stddef.h>

struct mesofit_result;

/** Open a folder, whose tables are read once they are asked for. One thread at a time. NULL on
 *  failure: IO; BAD_INPUT if it holds no results; NO_MEMORY. */
MESOFIT_API struct mesofit_result *mesofit_result_open(const char *folder);
MESOFIT_API void mesofit_result_free(struct mesofit_result *result);

/** Name of table `number`, from 0 on, in the order of the alphabet: "rdf", "rdf_A-B", "potential",
 *  …; NULL behind the last. */
MESOFIT_API const char *mesofit_result_name(const struct mesofit_result *result, size_t number);

/** Numbers in columns. What an array of the result has stays until the result is freed. */
struct mesofit_columns {
    size_t rows, columns;
    const double *values;     /**< shape [rows, columns], row-major; NaN: not known */
    const char *const *names; /**< shape [columns]: "r" */
    const char *const *units; /**< shape [columns]: "nm"; "" of pure numbers */
    const char *comment;      /**< lines above the heading, or "" */
};

/** Fails: BAD_INPUT if there is no table of this name; IO; NO_MEMORY. */
MESOFIT_API enum mesofit_status mesofit_result_table(struct mesofit_result *result,
                                                     const char *name,
                                                     struct mesofit_columns *columns);

/** The text of a file of the folder, such as "summary.json", "used.json" or "target.json"; it stays
 *  until the result is freed. NULL on failure: IO, BAD_INPUT, NO_MEMORY. */
MESOFIT_API const char *mesofit_result_text(struct mesofit_result *result, const char *file);

#endif
