// SPDX-License-Identifier: GPL-3.0-or-later
//
// A command that replaces what an earlier one left, and is killed before or after any of its steps
// on the disk (hooks/kill_at.c), leaves nothing of the earlier one once it has been done again, and
// never loses a file of a person.
#include "shared/kill_hook.h"
#include "shared/replaced_folders.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <signal.h>
#include <stdio.h>

/// Kill before (sign 1) or after (−1) each step; returns how many there are.
static int check_steps(struct temporary_folder *folder, const struct replaced_folder *one,
                       int sign) {
    for (int at = 1;; at++) {
        char out[32];
        snprintf(out, sizeof out, "%s-%d", sign > 0 ? "before" : "after", at);
        replaced_folders_begin(folder, one, out);
        kill_hook_set(sign * at);
        const int code = replaced_folders_run(one->second, out, NULL);
        kill_hook_set(0);
        replaced_folders_assert_mine(out);
        if (code == -SIGKILL)
            replaced_folders_finish(one, out);
        replaced_folders_assert_whole(one, out);
        replaced_folders_remove(out);
        if (code != -SIGKILL)
            return at - 1;
    }
}

static void test_replacing_that_is_killed_at_any_step_mixes_and_loses_nothing(void **state) {
    replaced_folders_write_inputs(*state);
    for (const struct replaced_folder *one = replaced_folders; one->second[0]; one++) {
        replaced_folders_make_whole(*state, one);
        const int before = check_steps(*state, one, 1);
        const int after = check_steps(*state, one, -1);
        print_message("%s: killed before %d and after %d steps\n", one->second[0], before, after);
        assert_int_equal(before, after);
        assert_true(before >= 10);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(
            test_replacing_that_is_killed_at_any_step_mixes_and_loses_nothing,
            small_inputs_enter_without_gnuplot, small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
