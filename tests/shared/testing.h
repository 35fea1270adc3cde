// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What every test program includes: cmocka with the headers it wants first, and checks of
/// `enum status` results.
#pragma once

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/status.h"

#include <string.h>

/// The call succeeds; its message is shown if it does not.
#define assert_ok(call)                                                                            \
    do {                                                                                           \
        if ((call) != STATUS_OK)                                                                   \
            fail_msg("%s: %s", #call, mf_status_message());                                        \
    } while (0)

/// The call fails with `status` and a message that contains `part`.
#define assert_fails(call, status, part)                                                           \
    do {                                                                                           \
        assert_int_equal((call), (status));                                                        \
        assert_contains(mf_status_message(), (part));                                              \
    } while (0)

#define assert_contains(text, part)                                                                \
    do {                                                                                           \
        if (strstr((text), (part)) == NULL)                                                        \
            fail_msg("\"%s\" does not contain \"%s\"", (text), (part));                            \
    } while (0)
