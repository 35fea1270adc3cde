// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How a function says that it failed.
///
/// Every function that can fail returns `enum status` and leaves one line for a person in a
/// buffer of its thread. Libraries never print or exit; `main` prints the line once.
#pragma once

#include <stdarg.h>

enum status {
    STATUS_OK = 0,
    STATUS_BAD_INPUT,   ///< the user's file or option is wrong
    STATUS_IO,          ///< a file cannot be read or written
    STATUS_NO_MEMORY,   ///< an allocation failed
    STATUS_UNSTABLE,    ///< a simulation blew up: a score for a fit, an error for `simulate`
    STATUS_UNCONVERGED, ///< an iteration ended before its criterion was met
    STATUS_INTERRUPTED, ///< the user asked to stop
};

/// Bytes of the longest message, with its end.
enum { STATUS_MESSAGE_SIZE = 8192 };

#define MUST_USE __attribute__((warn_unused_result))

/// After a number of a message that is in reduced units: "%g" STATUS_LENGTH. Whoever knows the
/// units of the file has it in these (mf_units_convert_message); all others read the number alone.
#define STATUS_MARK '\x1f'
#define STATUS_IN(unit) "\x1f" unit "\x1f"
#define STATUS_LENGTH STATUS_IN("lambda")
#define STATUS_AREA STATUS_IN("lambda^2")
#define STATUS_VOLUME STATUS_IN("lambda^d")
#define STATUS_DENSITY STATUS_IN("1/lambda^d")
#define STATUS_WAVE_NUMBER STATUS_IN("1/lambda")
#define STATUS_TIME STATUS_IN("tau")
#define STATUS_SPEED STATUS_IN("lambda/tau")
#define STATUS_ACCELERATION STATUS_IN("lambda/tau^2")
#define STATUS_DIFFUSION STATUS_IN("lambda^2/tau")
#define STATUS_TEMPERATURE STATUS_IN("T_0")
#define STATUS_ENERGY STATUS_IN("k_B T_0")
#define STATUS_FORCE STATUS_IN("k_B T_0/lambda")
#define STATUS_PRESSURE STATUS_IN("k_B T_0/lambda^d")
#define STATUS_VISCOSITY STATUS_IN("k_B T_0 tau/lambda^3")
#define STATUS_UNIT STATUS_IN("%s") ///< one of the arguments

/// Record a message for the calling thread and return `status`.
enum status mf_status_fail(enum status status, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/// Put "prefix: " before the message of the calling thread and return `status` unchanged.
enum status mf_status_prefix(enum status status, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/// Message of the last failure in the calling thread; never NULL.
const char *mf_status_message(void);

/// The same with the marks of reduced units, to be a part of another message.
const char *mf_status_marked(void);

/// Remove the marks of a text. Tested: test_units.
void mf_status_strip(char *text);

/// Name of a status as it stands in summary.json, such as "unstable".
const char *mf_status_name(enum status status);

/// Leave the function with the status of `call` unless it is STATUS_OK.
#define TRY(call)                                                                                  \
    do {                                                                                           \
        const enum status try_status_ = (call);                                                    \
        if (try_status_ != STATUS_OK)                                                              \
            return try_status_;                                                                    \
    } while (0)

/// In a function that owns things: store the status of `call` in the local variable `status` and
/// go to the label `done` unless it is STATUS_OK.
#define CHECK(call)                                                                                \
    do {                                                                                           \
        status = (call);                                                                           \
        if (status != STATUS_OK)                                                                   \
            goto done;                                                                             \
    } while (0)
