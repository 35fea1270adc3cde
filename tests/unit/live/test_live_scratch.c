// SPDX-License-Identifier: GPL-3.0-or-later
//
// Folders for a while, with processes that are killed and others that make theirs meanwhile.
#include "live/live_folder.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static int enter(void **state) {
    if (temporary_folder_create(state) != 0)
        return -1;
    return setenv("TMPDIR", ((struct temporary_folder *)*state)->path, 1);
}

static int leave(void **state) {
    unsetenv("TMPDIR");
    return temporary_folder_remove(state);
}

static bool exists(const char *path) {
    return access(path, F_OK) == 0;
}

static bool write_file(const char *folder) {
    char path[OUTPUT_PATH_SIZE + 16];
    snprintf(path, sizeof path, "%.4000s/rdf.tsv", folder);
    FILE *file = fopen(path, "w");
    return file && fclose(file) == 0;
}

/// A table of the program, in a folder that it has made.
static bool write_table(const char *folder) {
    char path[OUTPUT_PATH_SIZE];
    struct output output;
    snprintf(path, sizeof path, "%.4000s/rdf.tsv", folder);
    return mf_output_open(&output, path) == STATUS_OK && mf_output_commit(&output) == STATUS_OK;
}

/// Another process makes one, puts a file into it, says its path and waits to be killed.
static pid_t begin_other(char *path) {
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        struct live_scratch scratch;
        prctl(PR_SET_PDEATHSIG, SIGKILL); // should the test have ended without killing it
        mf_live_scratch_make(&scratch);
        if (write_table(scratch.path) && write(ends[1], scratch.path, sizeof scratch.path) > 0)
            pause();
        _exit(0);
    }
    close(ends[1]);
    assert_int_equal(read(ends[0], path, OUTPUT_PATH_SIZE), OUTPUT_PATH_SIZE);
    close(ends[0]);
    return child;
}

static void end_other(pid_t child) {
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
}

static void test_scratch_goes_with_its_files(void **state) {
    struct live_scratch scratch;
    char path[OUTPUT_PATH_SIZE];
    struct stat about;
    (void)state;
    mf_live_scratch_make(&scratch);
    snprintf(path, sizeof path, "%s", scratch.path);
    assert_int_equal(stat(path, &about), 0);
    assert_int_equal(about.st_mode & 0777, 0700);
    assert_true(write_table(path));
    mf_live_scratch_remove(&scratch);
    assert_false(exists(path));
    assert_string_equal(scratch.path, "");
    mf_live_scratch_remove(&scratch); // there is none
}

static void test_what_a_killed_process_leaves_goes_and_that_of_a_living_one_stays(void **state) {
    char killed[OUTPUT_PATH_SIZE], living[OUTPUT_PATH_SIZE];
    struct live_scratch scratch;
    (void)state;
    const pid_t first = begin_other(killed);
    const pid_t second = begin_other(living);
    assert_true(exists(killed));
    end_other(first);
    assert_true(exists(killed));
    mf_live_scratch_make(&scratch);
    assert_false(exists(killed));
    assert_true(exists(living));
    assert_true(exists(scratch.path));
    mf_live_scratch_remove(&scratch);
    end_other(second);
}

/// Folders of no scratch, whatever they are called, links, files, and folders of other users.
static void test_what_is_of_others_stays(void **state) {
    const char *place = ((struct temporary_folder *)*state)->path;
    static const char *const names[] = {"mesofit-live", "mesofit-live-backup", "elsewhere"};
    char path[4][OUTPUT_PATH_SIZE];
    struct live_scratch scratch;
    for (size_t k = 0; k < 3; k++) {
        snprintf(path[k], sizeof path[k], "%s/%s", place, names[k]);
        assert_int_equal(mkdir(path[k], 0700), 0);
        assert_true(write_file(path[k]));
    }
    snprintf(path[3], sizeof path[3], "%s/mesofit-live-linked", place);
    assert_int_equal(symlink(path[2], path[3]), 0);
    char foreign[OUTPUT_PATH_SIZE];
    end_other(begin_other(foreign));
    const bool is_foreign = geteuid() == 0 && chown(foreign, 54321, 54321) == 0;
    mf_live_scratch_make(&scratch);
    for (size_t k = 0; k < 3; k++) {
        char file[OUTPUT_PATH_SIZE + 16];
        snprintf(file, sizeof file, "%.4000s/rdf.tsv", path[k]);
        assert_true(exists(file));
    }
    assert_true(exists(path[3]));
    assert_int_equal(exists(foreign), is_foreign);
    mf_live_scratch_remove(&scratch);
}

/// What a person has put into the folder of a process that was killed stays, and the folder with
/// it.
static void test_files_of_others_in_a_scratch_stay(void **state) {
    char killed[OUTPUT_PATH_SIZE], table[OUTPUT_PATH_SIZE + 16], mine[OUTPUT_PATH_SIZE + 16];
    struct live_scratch scratch;
    (void)state;
    end_other(begin_other(killed));
    snprintf(table, sizeof table, "%s/rdf.tsv", killed);
    snprintf(mine, sizeof mine, "%s/thesis.txt", killed);
    FILE *file = fopen(mine, "w");
    assert_true(file && fclose(file) == 0);
    mf_live_scratch_make(&scratch);
    assert_false(exists(table));
    assert_true(exists(mine));
    mf_live_scratch_remove(&scratch);
}

/// Processes that make and remove theirs as fast as they can never lose one that they have.
static void test_many_processes_at_once_keep_theirs(void **state) {
    enum { PROCESSES = 4, ROUNDS = 300 };
    pid_t child[PROCESSES];
    (void)state;
    for (int p = 0; p < PROCESSES; p++) {
        child[p] = fork();
        for (int k = 0; child[p] == 0 && k < ROUNDS; k++) {
            struct live_scratch scratch;
            mf_live_scratch_make(&scratch);
            if (scratch.path[0] == '\0' || !exists(scratch.path))
                _exit(1);
            nanosleep(&(struct timespec){.tv_nsec = 200000}, NULL);
            if (!exists(scratch.path))
                _exit(2);
            mf_live_scratch_remove(&scratch);
        }
        if (child[p] == 0)
            _exit(0);
    }
    for (int p = 0; p < PROCESSES; p++) {
        int ended;
        assert_int_equal(waitpid(child[p], &ended, 0), child[p]);
        assert_true(WIFEXITED(ended));
        assert_int_equal(WEXITSTATUS(ended), 0);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_scratch_goes_with_its_files, enter, leave),
        cmocka_unit_test_setup_teardown(
            test_what_a_killed_process_leaves_goes_and_that_of_a_living_one_stays, enter, leave),
        cmocka_unit_test_setup_teardown(test_what_is_of_others_stays, enter, leave),
        cmocka_unit_test_setup_teardown(test_files_of_others_in_a_scratch_stay, enter, leave),
        cmocka_unit_test_setup_teardown(test_many_processes_at_once_keep_theirs, enter, leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
