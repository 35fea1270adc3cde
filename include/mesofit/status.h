/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file How a call says that it failed, and why.
 *
 * A call that can fail returns enum mesofit_status, or NULL where it would return an object. One
 * line for a person then stands in mesofit_message(). The library prints nothing, ends no program
 * and calls no error handler of the user's.
 */
#ifndef MESOFIT_STATUS_H
#define MESOFIT_STATUS_H

#include "mesofit/export.h"

#include <stddef.h>

enum mesofit_status {
    MESOFIT_OK = 0,
    MESOFIT_BAD_INPUT,   /**< a number, a text or a file is wrong */
    MESOFIT_IO,          /**< a file cannot be read */
    MESOFIT_NO_MEMORY,   /**< an allocation failed */
    MESOFIT_UNSTABLE,    /**< a simulation blew up */
    MESOFIT_UNCONVERGED, /**< a fit ended before its criterion was met */
    MESOFIT_INTERRUPTED  /**< the caller asked to stop */
};

/** Why the last call of this thread failed: one line or more, never NULL. It stays valid until the
 *  next call of this thread. */
MESOFIT_API const char *mesofit_message(void);

/** The version of the library that is linked, such as "0.2.0". */
MESOFIT_API const char *mesofit_version(void);

/** Bytes of a public struct, such as "mesofit_scene", in the library that is linked; 0: it has none
 *  of this name. Who was built with other headers, or speaks through declarations of its own, finds
 *  out by this that the library is older or newer, before it reads beyond an end. */
MESOFIT_API size_t mesofit_size_of(const char *name);

#endif
