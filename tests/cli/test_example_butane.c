// SPDX-License-Identifier: GPL-3.0-or-later
//
// examples/butane/README.md, command by command: a trajectory gives Φ(r) and ω(r). In short the fit
// only says what it would do.
#include "shared/length.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/// The page as page.md, in the working folder.
static void write_page(const char *sources) {
    char line[4096];
    snprintf(line, sizeof line, "cp '%s/examples/butane/README.md' page.md", sources);
    assert_int_equal(system(line), 0);
    if (!length_is_long())
        assert_int_equal(
            system("sed -i '/mesofit export/d; s/mesofit fit .*/& --explain/' page.md"), 0);
}

static void test_the_trajectory_gives_both(void **state) {
    char command[4096];
    const char *sources = run_program_sources();
    (void)state;
    assert_int_equal(symlink(getenv("MESOFIT"), "mesofit"), 0);
    snprintf(command, sizeof command, "%s/examples", sources);
    assert_int_equal(symlink(command, "examples"), 0);
    write_page(sources);
    snprintf(command, sizeof command, "'%s/tests/tools/run_page.sh' page.md >page.txt 2>&1",
             sources);
    const int code = system(command);
    char *page = temporary_folder_read("page.txt");
    if (code != 0)
        fail_msg("%s", page);
    assert_contains(page, "BUT: 200 beads of 4 atoms, the first of 58.124 u");
    assert_contains(page, "escape times of pairs");
    assert_contains(page, "\"successive\": it finds omega");
    if (length_is_long()) {
        results_assert_text("butane/fit/summary.json", "status", "converged");
        assert_contains(page, "result: success");
        const double error =
            results_number("butane/fit/summary.json", "parameters.omega.sigma.error");
        assert_true(error > 0 && error < 0.1 * results_number("butane/fit/summary.json",
                                                              "parameters.omega.sigma.value"));
    }
    free(page);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_the_trajectory_gives_both, small_inputs_enter,
                                        small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
