// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // syncfs

#include "io/output.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

/// Instead of the C library's: how often what is asked to come to the disk.
static int files_synced, systems_synced;

int fsync(int file) {
    (void)file;
    files_synced++;
    return 0;
}

int syncfs(int file) {
    (void)file;
    systems_synced++;
    return 0;
}

static void assert_file_holds(const char *path, const char *expected) {
    char *text = temporary_folder_read(path);
    assert_string_equal(text, expected);
    free(text);
}

static void assert_no_partial(const struct output *output) {
    assert_false(temporary_folder_exists(output->temporary));
}

static void test_output_commit_replaces_the_file_when_all_was_written(void **state) {
    const char *path = temporary_folder_write(*state, "a.txt", "old", 3);
    struct output output;
    assert_ok(mf_output_open(&output, path));
    fputs("new\n", output.stream);
    assert_file_holds(path, "old");
    assert_ok(mf_output_commit(&output));
    assert_file_holds(path, "new\n");
    assert_no_partial(&output);
    mf_output_abandon(&output);
    assert_file_holds(path, "new\n");
}

/// Many files, and one that says that they are there: none waits for the disk but the last.
static void test_output_open_later_leaves_the_disk_to_the_next_file(void **state) {
    const char *folder = *state;
    char path[512];
    struct output output;
    files_synced = systems_synced = 0;
    for (int k = 0; k < 5; k++) {
        snprintf(path, sizeof path, "%s/%d.txt", folder, k);
        assert_ok(mf_output_open_later(&output, path));
        fputs("a snapshot\n", output.stream);
        assert_ok(mf_output_commit(&output));
        assert_file_holds(path, "a snapshot\n");
    }
    assert_int_equal(files_synced + systems_synced, 0);
    for (int k = 0; k < 2; k++) {
        snprintf(path, sizeof path, "%s/checkpoint", folder);
        assert_ok(mf_output_open(&output, path));
        assert_ok(mf_output_commit(&output));
        assert_int_equal(systems_synced, 1);
        assert_int_equal(files_synced, 1 + 2 * k); // its folder; then the file as well
    }
}

static void test_output_abandon_keeps_the_old_file_when_called_before_commit(void **state) {
    const char *path = temporary_folder_write(*state, "a.txt", "old", 3);
    struct output output;
    assert_ok(mf_output_open(&output, path));
    fputs("new\n", output.stream);
    mf_output_abandon(&output);
    assert_file_holds(path, "old");
    assert_no_partial(&output);
}

/// /dev/full takes no byte: the disk is full. The stream's buffer hides it until commit; of many
/// bytes the first write fails long before, and the reason is still that of the first.
static void test_output_commit_reports_and_cleans_up_when_the_disk_is_full(void **state) {
    const char *path = temporary_folder_write(*state, "a.txt", "old", 3);
    struct output output;
    for (int bytes = 1; bytes < 2000000; bytes *= 1000) {
        assert_ok(mf_output_open(&output, path));
        const int full = open("/dev/full", O_WRONLY);
        assert_true(full >= 0 && dup2(full, output.file) == output.file);
        close(full);
        for (int k = 0; k < bytes; k++)
            fputc('x', output.stream);
        if (bytes > 100000) { // the disk has room again, but bytes are lost
            const int zero = open("/dev/zero", O_WRONLY);
            assert_true(zero >= 0 && dup2(zero, output.file) == output.file);
            close(zero);
        }
        errno = 0;
        assert_fails(mf_output_commit(&output), STATUS_IO, "a.txt: No space left on device");
        assert_no_partial(&output);
        mf_output_abandon(&output);
        assert_file_holds(path, "old");
    }
}

/// A link where the partial file comes, to a file of somebody: its bytes stay. So does a pipe not
/// make the program wait.
static void test_output_open_makes_a_file_of_its_own_when_something_is_in_the_way(void **state) {
    const char *victim = strdup(temporary_folder_write(*state, "victim", "precious", 8));
    const char *path = temporary_folder_file(*state, "a.txt");
    struct output output;
    assert_ok(mf_output_open(&output, path));
    mf_output_abandon(&output);
    for (int kind = 0; kind < 2; kind++) {
        assert_int_equal(kind ? mkfifo(output.temporary, 0666) : symlink(victim, output.temporary),
                         0);
        assert_ok(mf_output_open(&output, path));
        fputs("new\n", output.stream);
        assert_ok(mf_output_commit(&output));
        assert_file_holds(victim, "precious");
        assert_file_holds(path, "new\n");
        struct stat about;
        assert_int_equal(lstat(path, &about), 0);
        assert_true(S_ISREG(about.st_mode));
    }
    free((char *)victim);
}

static void test_output_commit_reports_and_cleans_up_when_the_file_grows_too_large(void **state) {
    const char *path = temporary_folder_write(*state, "a.txt", "old", 3);
    struct rlimit before;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &(struct rlimit){1000, before.rlim_max}), 0);
    struct output output;
    const enum status opened = mf_output_open(&output, path);
    for (int k = 0; opened == STATUS_OK && k < 100000; k++)
        fputc('x', output.stream);
    const enum status status = opened == STATUS_OK ? mf_output_commit(&output) : opened;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_fails(status, STATUS_IO, "a.txt: File too large");
    assert_no_partial(&output);
    assert_file_holds(path, "old");
}

static void test_output_commit_reports_and_cleans_up_when_a_folder_is_in_the_way(void **state) {
    const char *path = temporary_folder_file(*state, "a.txt");
    assert_int_equal(mkdir(path, 0777), 0);
    struct output output;
    assert_ok(mf_output_open(&output, path));
    assert_fails(mf_output_commit(&output), STATUS_IO, "a.txt: Is a directory");
    assert_no_partial(&output);
}

static void test_output_open_names_the_file_when_the_folder_is_missing(void **state) {
    struct output output;
    const char *path = temporary_folder_file(*state, "no/a.txt");
    assert_fails(mf_output_open(&output, path), STATUS_IO, "no/a.txt: No such file or directory");
    mf_output_abandon(&output);
}

static void test_output_open_refuses_when_the_path_is_too_long(void **state) {
    (void)state;
    char path[OUTPUT_PATH_SIZE + 1];
    memset(path, 'x', sizeof path - 1);
    path[sizeof path - 1] = '\0';
    struct output output;
    assert_fails(mf_output_open(&output, path), STATUS_IO, "longer than 4095 bytes");
    mf_output_abandon(&output);
}

static void test_output_make_folder_makes_parents_when_they_are_missing(void **state) {
    const char *path = temporary_folder_file(*state, "a/b/c");
    assert_ok(mf_output_make_folder(path));
    assert_true(temporary_folder_exists(path));
    assert_ok(mf_output_make_folder(path));
    assert_ok(mf_output_make_folder(temporary_folder_file(*state, "a//d/")));
    assert_true(temporary_folder_exists(temporary_folder_file(*state, "a/d")));
    assert_ok(mf_output_make_folder("/"));
    assert_ok(mf_output_make_folder("."));
}

static void test_output_make_folder_names_the_path_when_a_file_is_in_the_way(void **state) {
    temporary_folder_write(*state, "a", "", 0);
    assert_fails(mf_output_make_folder(temporary_folder_file(*state, "a")), STATUS_IO,
                 "/a is not a folder");
    assert_fails(mf_output_make_folder(temporary_folder_file(*state, "a/b")), STATUS_IO,
                 "/a is not a folder");
    assert_fails(mf_output_make_folder("/proc/no/folder"), STATUS_IO, "/proc/no/folder");
    assert_fails(mf_output_make_folder(""), STATUS_IO, "cannot make folder \"\"");
}

#define IN_FOLDER(test)                                                                            \
    cmocka_unit_test_setup_teardown(test, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        IN_FOLDER(test_output_commit_replaces_the_file_when_all_was_written),
        IN_FOLDER(test_output_open_later_leaves_the_disk_to_the_next_file),
        IN_FOLDER(test_output_abandon_keeps_the_old_file_when_called_before_commit),
        IN_FOLDER(test_output_commit_reports_and_cleans_up_when_the_disk_is_full),
        IN_FOLDER(test_output_open_makes_a_file_of_its_own_when_something_is_in_the_way),
        IN_FOLDER(test_output_commit_reports_and_cleans_up_when_the_file_grows_too_large),
        IN_FOLDER(test_output_commit_reports_and_cleans_up_when_a_folder_is_in_the_way),
        IN_FOLDER(test_output_open_names_the_file_when_the_folder_is_missing),
        cmocka_unit_test(test_output_open_refuses_when_the_path_is_too_long),
        IN_FOLDER(test_output_make_folder_makes_parents_when_they_are_missing),
        IN_FOLDER(test_output_make_folder_names_the_path_when_a_file_is_in_the_way),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
