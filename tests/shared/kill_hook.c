// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/kill_hook.h"

#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>

void kill_hook_set(int at) {
    const char *hook = getenv("KILL_HOOK");
    char number[16];
    if (hook == NULL)
        fail_msg("the environment variable KILL_HOOK does not say where the library is");
    snprintf(number, sizeof number, "%d", at);
    assert_int_equal(at ? setenv("LD_PRELOAD", hook, 1) : unsetenv("LD_PRELOAD"), 0);
    assert_int_equal(setenv("KILL_AT", number, 1), 0);
}
