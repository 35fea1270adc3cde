// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/length.h"

#include <stdlib.h>

bool length_is_long(void) {
    return getenv("LONG") != NULL;
}

/// cmocka leaves out what has no function.
struct CMUnitTest length_only_long(struct CMUnitTest test) {
    return length_is_long() ? test : (struct CMUnitTest){0};
}
