// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/other_engine.h"

#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>

void other_engine_skip_without(const char *program) {
    char command[128];
    if (getenv("ENGINES") == NULL) {
        print_message("skipped: ENGINES=1 runs it, by %s\n", program);
        skip();
    }
    snprintf(command, sizeof command, "command -v %s >/dev/null", program);
    if (system(command) == 0)
        return;
    print_message("skipped: %s is not installed\n", program);
    skip();
}
