// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/twins.h"

#include "shared/run_program.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>

/// Scenes that were simulated, by their texts; of each the results stand in a folder of that
/// number.
enum { MAX = 16 };
static struct temporary_folder *kept;
static char *text[MAX];
static int count;

static void forget(void) {
    void *state = kept;
    temporary_folder_remove(&state);
    for (int k = 0; k < count; k++)
        free(text[k]);
}

/// By its path: a test may have no PATH.
static void copy(const char *from, const char *to) {
    char line[3300];
    assert_in_range(
        snprintf(line, sizeof line, "/bin/rm -rf '%s' && /bin/cp -r '%s' '%s'", to, from, to), 1,
        sizeof line - 1);
    assert_int_equal(system(line), 0);
}

void twins_simulate(const char *file, const char *out) {
    static struct run_program_result result;
    char *scene = temporary_folder_read(file), number[16];
    int at = 0;
    if (kept == NULL) {
        void *state;
        temporary_folder_create(&state);
        kept = state;
        atexit(forget);
    }
    while (at < count && strcmp(text[at], scene) != 0)
        at++;
    snprintf(number, sizeof number, "%d", at);
    if (at < count) {
        copy(temporary_folder_file(kept, number), out);
        free(scene);
        return;
    }
    assert_in_range(count, 0, MAX - 1);
    RUN_PROGRAM(&result, "simulate", file, "-o", out, "--quiet");
    run_program_assert_code(&result, 0);
    copy(out, temporary_folder_file(kept, number));
    text[count++] = scene;
}
