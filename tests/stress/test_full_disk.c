// SPDX-License-Identifier: GPL-3.0-or-later
//
// Every command that writes a folder, on a disk that is full at once, soon or late, and with limits
// of the system on files and memory: one line says what is missing, nothing is half-written or
// lost, and once there is room it ends as if there had always been.
#include "shared/replaced_folders.h"
#include "shared/small_disk.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

/// Pages of a disk that has room for all.
enum { ENOUGH = 4096 };

static void assert_one_line(const char *what, int pages) {
    const char *said = replaced_folders_message();
    if (run_program_lines(said) != 1 || strncmp(said, "mesofit: ", 9) != 0 ||
        (!strstr(said, "No space left on device") && !strstr(said, "File too large")))
        fail_msg("%s with %d pages: %s", what, pages, said);
}

static int leave_disk(void **state) {
    small_disk_unmount("disk"); // if the test has failed
    return small_inputs_leave(state);
}

/// From a disk that holds nothing to one that holds all.
static int check_new(struct temporary_folder *folder, const struct replaced_folder *one) {
    int failures = 0;
    for (int pages = 1, code = 2; code == 2; pages += 1 + pages / 8) {
        assert_in_range(pages, 1, ENOUGH);
        if (!small_disk_mount("disk", pages))
            skip();
        code = replaced_folders_run(one->second, "disk/out", NULL);
        if (code == 2) {
            assert_one_line(one->second[0], pages);
            run_program_assert_no_partial("disk");
            assert_false(temporary_folder_exists("disk/out/summary.json"));
            failures++;
        }
        small_disk_grow("disk", ENOUGH);
        if (code == 2)
            replaced_folders_finish(one, "disk/out");
        temporary_folder_write(folder, "disk/out/mine.tsv", "mine", 4);
        replaced_folders_assert_whole(one, "disk/out");
        small_disk_unmount("disk");
    }
    return failures;
}

/// The disk holds an earlier result, and so many pages are free.
static int check_replaced(struct temporary_folder *folder, const struct replaced_folder *one) {
    int failures = 0;
    for (int free = 0, code = 2; code == 2; free += 1 + free / 8) {
        if (!small_disk_mount("disk", ENOUGH))
            skip();
        replaced_folders_begin(folder, one, "disk/out");
        small_disk_fill("disk", free);
        code = replaced_folders_run(one->second, "disk/out", NULL);
        replaced_folders_assert_mine("disk/out");
        if (code == 2) {
            assert_one_line(one->second[0], free);
            run_program_assert_no_partial("disk");
            failures++;
            assert_int_equal(unlink("disk/filler"), 0);
            replaced_folders_finish(one, "disk/out");
        }
        replaced_folders_assert_whole(one, "disk/out");
        small_disk_unmount("disk");
    }
    return failures;
}

static void test_full_disk_loses_nothing(void **state) {
    int all = 0;
    replaced_folders_write_inputs(*state);
    assert_int_equal(mkdir("disk", 0777), 0);
    for (const struct replaced_folder *one = replaced_folders; one->second[0]; one++) {
        replaced_folders_make_whole(*state, one);
        const int made = check_new(*state, one), replaced = check_replaced(*state, one);
        print_message("%s: %d disks too small for it, %d too full to replace another\n",
                      one->second[0], made, replaced);
        assert_true(made >= 2);
        all += replaced; // what goes first may make room enough
    }
    assert_true(all >= 10);
}

/// Files grow to so many bytes and no more.
static void test_limit_on_files_loses_nothing(void **state) {
    static struct run_program_result result;
    replaced_folders_write_inputs(*state);
    for (const struct replaced_folder *one = replaced_folders; one->second[0]; one++) {
        int failures = 0;
        replaced_folders_make_whole(*state, one);
        for (long limit = 64, code = 2; code == 2; limit += limit / 4) {
            const struct run_program_how how = {.largest_file = limit};
            const char *words[REPLACED_FOLDERS_WORDS + 4] = {NULL};
            int count = 0;
            for (; one->second[count]; count++)
                words[count] = one->second[count];
            words[count++] = "-o";
            words[count++] = "out";
            words[count] = "--quiet";
            run_program(&result, &how, words);
            code = result.code;
            if (code == 2) {
                assert_int_equal(run_program_lines(result.err), 1);
                assert_contains(result.err, "File too large");
                run_program_assert_no_partial(".");
                failures++;
                replaced_folders_finish(one, "out");
            }
            temporary_folder_write(*state, "out/mine.tsv", "mine", 4);
            replaced_folders_assert_whole(one, "out");
            replaced_folders_remove("out");
        }
        print_message("%s: %d limits on the size of files\n", one->second[0], failures);
        assert_true(failures >= 1);
    }
}

/// `ulimit` of a shell: descriptors, or kB of memory.
static int run_limited(const struct replaced_folder *one, char what, long limit) {
    char command[1024];
    int length =
        snprintf(command, sizeof command, "ulimit -%c %ld && exec \"$MESOFIT\"", what, limit);
    for (int k = 0; one->second[k]; k++)
        length +=
            snprintf(command + length, sizeof command - (size_t)length, " %s", one->second[k]);
    snprintf(command + length, sizeof command - (size_t)length,
             " -o out --quiet --threads 1 2>said");
    const int status = system(command);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

static void check_limits(struct temporary_folder *folder, const struct replaced_folder *one,
                         char what, long min, long max, double factor) {
    enum { LOADER = 127 };
    int failures = 0, runs = 0;
    for (double limit = (double)min; limit < (double)max; limit = limit * factor + 1) {
        const int code = run_limited(one, what, (long)limit);
        if (code < 0 || (code > 3 && code != LOADER))
            fail_msg("%s, ulimit -%c %.0f: exit code %d", one->second[0], what, limit, code);
        runs++;
        if (temporary_folder_exists("out"))
            run_program_assert_no_partial("out");
        if (code > 1) {
            failures++;
            replaced_folders_finish(one, "out");
        }
        temporary_folder_write(folder, "out/mine.tsv", "mine", 4);
        replaced_folders_assert_whole(one, "out");
        replaced_folders_remove("out");
    }
    print_message("%s: %d of %d limits by ulimit -%c end it\n", one->second[0], failures, runs,
                  what);
}

static void test_limits_of_the_system_lose_nothing(void **state) {
    replaced_folders_write_inputs(*state);
    for (const struct replaced_folder *one = replaced_folders; one->second[0]; one++) {
        replaced_folders_make_whole(*state, one);
        check_limits(*state, one, 'n', 3, 20, 1);
        check_limits(*state, one, 'v', 20000, 400000, 1.3);
    }
}

/// Processes that begin at once in one folder: one goes on, the others say why they do not.
static void test_many_runs_in_one_folder_are_one(void **state) {
    enum { PROCESSES = 5, ROUNDS = 20 };
    replaced_folders_write_inputs(*state);
    for (const struct replaced_folder *one = replaced_folders; one->second[0]; one++) {
        int refused = 0;
        replaced_folders_make_whole(*state, one);
        for (int round = 0; round < ROUNDS; round++) {
            pid_t child[PROCESSES];
            for (int p = 0; p < PROCESSES; p++) {
                child[p] = fork();
                if (child[p] == 0) {
                    const int code = replaced_folders_run(one->second, "out", NULL);
                    const char *said = replaced_folders_message();
                    const bool taken =
                        strstr(said, "another process is running") || strstr(said, " holds a");
                    _exit(code == 2 && taken ? 10 : code);
                }
            }
            for (int p = 0; p < PROCESSES; p++) {
                int ended;
                assert_int_equal(waitpid(child[p], &ended, 0), child[p]);
                assert_true(WIFEXITED(ended));
                const int code = WEXITSTATUS(ended);
                if (code != 0 && code != 1 && code != 10)
                    fail_msg("%s: exit code %d", one->second[0], code);
                refused += code == 10;
            }
            temporary_folder_write(*state, "out/mine.tsv", "mine", 4);
            replaced_folders_assert_whole(one, "out");
            run_program_assert_no_partial("out");
            replaced_folders_remove("out");
        }
        print_message("%s: %d of %d were refused\n", one->second[0], refused, PROCESSES * ROUNDS);
    }
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, small_inputs_enter_without_gnuplot, leave_disk)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_full_disk_loses_nothing),
        TEST(test_limit_on_files_loses_nothing),
        TEST(test_limits_of_the_system_lose_nothing),
        TEST(test_many_runs_in_one_folder_are_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
