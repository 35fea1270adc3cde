// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/other_engine.h"

#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool other_engine_runs(const char *program) {
    char command[128];
    snprintf(command, sizeof command, "command -v %s >/dev/null", program);
    const char *const engines = getenv("ENGINES");
    const bool wanted = engines && strcmp(engines, "1") == 0, runs = wanted && system(command) == 0;
    if (!wanted)
        print_message("skipped: ENGINES=1 runs it, by %s\n", program);
    else if (!runs)
        print_message("skipped: %s is not installed\n", program);
    return runs;
}

void other_engine_skip_without(const char *program) {
    if (!other_engine_runs(program))
        skip();
}
