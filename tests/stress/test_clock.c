// SPDX-License-Identifier: GPL-3.0-or-later
//
// A clock of the day that is set back by a day whenever it has been read: nothing waits for it to
// catch up, and nothing is reckoned by it. CLOCK_HOOK is the library that does it.
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <signal.h>
#include <stdlib.h>

static struct run_program_result result;

enum { INTERRUPTED = 130 };

static void set_clock_back(bool back) {
    const char *hook = getenv("CLOCK_HOOK");
    if (hook == NULL)
        fail_msg("the environment variable CLOCK_HOOK does not say where the library is");
    if (back)
        assert_int_equal(setenv("LD_PRELOAD", hook, 1), 0);
    else
        assert_int_equal(unsetenv("LD_PRELOAD"), 0);
}

static void write_inputs(struct temporary_folder *folder) {
    small_inputs_write(folder, "scene.json", small_inputs_scene, NULL, NULL);
    small_inputs_write(folder, "run.json", small_inputs_run, NULL, NULL);
    small_inputs_write(folder, "target.tsv", small_inputs_target, NULL, NULL);
}

static void test_tables_and_times_are_those_of_any_clock(void **state) {
    static const char *const verbs[][2] = {{"simulate", "scene.json"}, {"fit", "run.json"}};
    write_inputs(*state);
    for (int k = 0; k < 2; k++) {
        set_clock_back(false);
        RUN_PROGRAM(&result, verbs[k][0], verbs[k][1], "-o", "plain", "--force", "--threads", "2");
        const int code = result.code;
        set_clock_back(true);
        RUN_PROGRAM(&result, verbs[k][0], verbs[k][1], "-o", "back", "--force", "--threads", "2");
        set_clock_back(false);
        run_program_assert_code(&result, code);
        results_assert_same("plain", "back", (const char *const[]){"rdf.tsv", "used.json", NULL});
        assert_true(results_number("back/summary.json", "seconds") >= 0);
        assert_true(results_number("back/summary.json", "seconds") < 3600);
        assert_int_equal(system("rm -r plain back"), 0);
    }
}

/// The page that waits for its first run, is in it, or has had it, ends with Ctrl-C without the
/// clock's leave: what does nothing for minutes fails the test.
static void test_ctrl_c_ends_the_live_view(void **state) {
    static const char *const lines[][6] = {{"live"}, {"live", "scene.json", "--start", "--stay"}};
    write_inputs(*state);
    RUN_PROGRAM(&result, "live", "missing.json");
    if (strstr(result.err, "was built without the live view"))
        skip();
    for (int k = 0; k < 4; k++) {
        const struct run_program_how how = {.interrupt_with = SIGINT,
                                            .interrupt_after = k > 1 ? 0.003 * k : 0};
        set_clock_back(true);
        run_program(&result, &how, lines[k > 0]);
        set_clock_back(false);
        if (result.code != 0 && result.code != INTERRUPTED)
            fail_msg("exit code %d: %s", result.code, result.err);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_tables_and_times_are_those_of_any_clock),
        TEST(test_ctrl_c_ends_the_live_view),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
