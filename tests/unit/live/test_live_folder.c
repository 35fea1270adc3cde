// SPDX-License-Identifier: GPL-3.0-or-later
//
// No path leaves the folder: names, links, pipes. The zip is opened by Python's zipfile.
#include "live/live_folder.h"
#include "live/live_routes.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static int root;

/// inside/ is the folder that is served; secret.json lies beside it.
static int enter(void **state) {
    if (temporary_folder_create(state) != 0)
        return -1;
    struct temporary_folder *folder = *state;
    temporary_folder_write(folder, "secret.json", "{}", 2);
    if (mkdir(temporary_folder_file(folder, "inside"), 0700) != 0 ||
        mkdir(temporary_folder_file(folder, "inside/deep"), 0700) != 0)
        return -1;
    temporary_folder_write(folder, "inside/run.json", "{\"a\": 1}", 8);
    temporary_folder_write(folder, "inside/deep/table.tsv", "# x\n1\n", 6);
    temporary_folder_write(folder, "inside/.hidden.json", "{}", 2);
    root = open(temporary_folder_file(folder, "inside"), O_RDONLY | O_DIRECTORY);
    return root < 0 ? -1 : 0;
}

static int leave(void **state) {
    close(root);
    return temporary_folder_remove(state);
}

static const char *const outside[] = {"../secret.json",
                                      "deep/../../secret.json",
                                      "/etc/passwd",
                                      "./run.json",
                                      "deep//table.tsv",
                                      "deep/",
                                      ".hidden.json",
                                      "deep/..",
                                      "..",
                                      ".",
                                      "deep\\..\\..\\secret.json",
                                      "run.json\n",
                                      "\x01.json",
                                      "caf\xe9.json"};

static void test_paths_outside_are_refused_by_name(void **state) {
    size_t size;
    (void)state;
    for (size_t k = 0; k < sizeof outside / sizeof *outside; k++) {
        assert_false(mf_live_folder_is_plain(outside[k]));
        assert_int_equal(mf_live_folder_read(root, outside[k], &size), -1);
        assert_int_equal(mf_live_folder_enter(root, outside[k]), -1);
        assert_int_not_equal(mf_live_folder_write(root, outside[k], "x", 1, true), STATUS_OK);
    }
    assert_true(mf_live_folder_is_plain("deep/table.tsv"));
}

static void test_links_are_not_followed(void **state) {
    struct temporary_folder *folder = *state;
    size_t size;
    assert_int_equal(symlinkat("../secret.json", root, "link.json"), 0);
    assert_int_equal(symlinkat("..", root, "up"), 0);
    assert_int_equal(mf_live_folder_read(root, "link.json", &size), -1);
    assert_int_equal(mf_live_folder_read(root, "up/secret.json", &size), -1);
    assert_int_equal(mf_live_folder_enter(root, "up"), -1);
    assert_int_not_equal(mf_live_folder_write(root, "up/new.json", "x", 1, true), STATUS_OK);
    // Nor is one replaced: it is somebody's way to what it points to, which stays.
    assert_fails(mf_live_folder_write(root, "link.json", "[]", 2, true), STATUS_BAD_INPUT,
                 "link.json is no plain file");
    struct stat about;
    assert_int_equal(fstatat(root, "link.json", &about, AT_SYMLINK_NOFOLLOW), 0);
    assert_true(S_ISLNK(about.st_mode));
    char *secret = temporary_folder_read(temporary_folder_file(folder, "secret.json"));
    assert_string_equal(secret, "{}");
    free(secret);
}

static void test_folder_of_results_may_be_new_but_not_through_a_link(void **state) {
    (void)state;
    assert_int_equal(symlinkat("..", root, "up"), 0);
    assert_ok(mf_live_folder_check_new(root, "deep"));
    assert_ok(mf_live_folder_check_new(root, "deep/new/out"));
    assert_fails(mf_live_folder_check_new(root, "up"), STATUS_BAD_INPUT, "links");
    assert_fails(mf_live_folder_check_new(root, "up/out"), STATUS_BAD_INPUT, "links");
    assert_fails(mf_live_folder_check_new(root, "run.json/out"), STATUS_BAD_INPUT, "a file");
    assert_fails(mf_live_folder_check_new(root, "../out"), STATUS_BAD_INPUT, "not a folder");
}

static void test_pipe_is_not_waited_for(void **state) {
    size_t size;
    (void)state;
    assert_int_equal(mkfifoat(root, "pipe.json", 0600), 0);
    assert_int_equal(mf_live_folder_read(root, "pipe.json", &size), -1);
    assert_contains(mf_status_message(), "not a regular file");
}

static void test_file_is_written_whole_and_kept_unless_it_may_be_replaced(void **state) {
    struct temporary_folder *folder = *state;
    assert_fails(mf_live_folder_write(root, "run.json", "new", 3, false), STATUS_BAD_INPUT,
                 "is there already");
    char *text = temporary_folder_read(temporary_folder_file(folder, "inside/run.json"));
    assert_string_equal(text, "{\"a\": 1}");
    free(text);
    assert_ok(mf_live_folder_write(root, "run.json", "new", 3, true));
    assert_ok(mf_live_folder_write(root, "deep/other.tsv", "other", 5, false));
    text = temporary_folder_read(temporary_folder_file(folder, "inside/run.json"));
    assert_string_equal(text, "new");
    free(text);
    assert_fails(mf_live_folder_write(root, "script.sh", "x", 1, true), STATUS_BAD_INPUT, "alone");
}

static void test_list_has_plain_names_alone(void **state) {
    char *text = NULL;
    size_t size;
    temporary_folder_write(*state, "inside/caf\xc3\xa9.json", "{}", 2);
    temporary_folder_write(*state, "inside/latin-\xe9.json", "{}", 2); // would be no JSON
    FILE *stream = open_memstream(&text, &size);
    assert_ok(mf_live_folder_list(root, "", stream));
    fclose(stream);
    assert_contains(text, "run.json");
    assert_contains(text, "deep");
    assert_contains(text, "caf\xc3\xa9.json");
    assert_null(strstr(text, "hidden"));
    assert_null(strstr(text, "latin"));
    free(text);
}

static void test_zip_holds_the_files(void **state) {
    struct temporary_folder *folder = *state;
    char command[2600];
    const char *zip = temporary_folder_file(folder, "all.zip");
    FILE *stream = fopen(zip, "wb");
    assert_ok(mf_live_zip_write(root, "", stream));
    fclose(stream);
    snprintf(command, sizeof command,
             "python3 -c \"import sys, zipfile; z = zipfile.ZipFile(sys.argv[1]); "
             "assert z.testzip() is None; assert sorted(z.namelist()) == "
             "['deep/table.tsv', 'run.json'], z.namelist(); "
             "assert z.read('deep/table.tsv') == b'# x\\n1\\n'\" '%s'",
             zip);
    if (system("python3 -c 0 2>/dev/null") != 0)
        skip();
    assert_int_equal(system(command), 0);
}

/// A first file at the limit of a zip must not make the limit wrap round for the second.
static void test_zip_that_is_too_large_is_refused(void **state) {
    const off_t limit = 256 << 20;
    FILE *nowhere = fopen("/dev/null", "wb");
    (void)state;
    for (int k = 0; k < 2; k++) {
        const int file = openat(root, k ? "b.dat" : "a.dat", O_WRONLY | O_CREAT, 0600);
        assert_int_equal(ftruncate(file, k ? 1 << 20 : limit), 0);
        close(file);
    }
    assert_fails(mf_live_zip_write(root, "", nowhere), STATUS_BAD_INPUT, "too large");
    fclose(nowhere);
}

int main(void) {
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, enter, leave)
    const struct CMUnitTest tests[] = {
        IN_FOLDER(test_paths_outside_are_refused_by_name),
        IN_FOLDER(test_links_are_not_followed),
        IN_FOLDER(test_folder_of_results_may_be_new_but_not_through_a_link),
        IN_FOLDER(test_pipe_is_not_waited_for),
        IN_FOLDER(test_file_is_written_whole_and_kept_unless_it_may_be_replaced),
        IN_FOLDER(test_list_has_plain_names_alone),
        IN_FOLDER(test_zip_holds_the_files),
        IN_FOLDER(test_zip_that_is_too_large_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
