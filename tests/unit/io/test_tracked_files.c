// SPDX-License-Identifier: GPL-3.0-or-later
//
// Folders with a list of the files that were written there: from one run to the next, with files of
// others, links, processes that are killed, and lists that are damaged or made by somebody.
#include "io/tracked_files.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static struct tracked_files own;

/// The working folder is that of the test.
static int enter(void **state) {
    if (temporary_folder_create(state) != 0)
        return -1;
    return chdir(((struct temporary_folder *)*state)->path);
}

static int leave(void **state) {
    mf_tracked_files_close(&own);
    return chdir("/") != 0 || temporary_folder_remove(state) != 0;
}

static enum status open_out(bool force) {
    const enum status status = mf_tracked_files_make(&own, "out", TRACKED_FILES_OF_RUN);
    own.force = force;
    return status;
}

static enum status write_file(const char *path, const char *text) {
    struct output output;
    TRY(mf_output_open(&output, path));
    fputs(text, output.stream);
    return mf_output_commit(&output);
}

/// As a person does.
static void put(const char *path, const char *text) {
    FILE *stream = fopen(path, "w");
    assert_non_null(stream);
    assert_true(fputs(text, stream) >= 0 && fclose(stream) == 0);
}

static void assert_text(const char *path, const char *expected) {
    char *text = temporary_folder_read(path);
    assert_string_equal(text, expected);
    free(text);
}

#define assert_there(path) assert_true(temporary_folder_exists(path))
#define assert_gone(path) assert_false(temporary_folder_exists(path))

/// A run that leaves some files.
static void run_first(void) {
    assert_ok(open_out(false));
    assert_ok(mf_tracked_files_begin(&own, 1));
    assert_ok(mf_tracked_files_remove_earlier(&own));
    assert_ok(write_file("out/rdf.tsv", "first"));
    assert_ok(write_file("out/old.tsv", "first"));
    assert_ok(mf_output_make_folder("out/states/a"));
    assert_ok(write_file("out/states/a/rdf.tsv", "first"));
    mf_tracked_files_close(&own);
}

static void test_next_run_replaces_and_removes_what_is_its_own(void **state) {
    (void)state;
    run_first();
    put("out/notes.tsv", "mine");
    assert_int_equal(mkdir("out/figures", 0777), 0);
    assert_ok(open_out(false));
    assert_ok(mf_tracked_files_check(&own, NULL));
    assert_ok(mf_tracked_files_begin(&own, 2));
    assert_ok(write_file("out/rdf.tsv", "second"));
    assert_there("out/old.tsv");
    assert_ok(mf_tracked_files_remove_earlier(&own));
    mf_tracked_files_close(&own);
    assert_text("out/rdf.tsv", "second");
    assert_text("out/notes.tsv", "mine");
    assert_gone("out/old.tsv");
    assert_gone("out/states");
    assert_there("out/figures"); // nobody entered it
}

static void test_files_of_others_are_not_replaced(void **state) {
    (void)state;
    run_first();
    put("out/new.tsv", "mine");
    assert_ok(open_out(false));
    assert_fails(mf_tracked_files_reserve(&own, "new.tsv"), STATUS_BAD_INPUT,
                 "out/new.tsv is there, and mesofit did not write it: move it away");
    assert_ok(mf_tracked_files_begin(&own, 2));
    assert_fails(write_file("out/new.tsv", "second"), STATUS_BAD_INPUT, "did not write it");
    assert_text("out/new.tsv", "mine");
    own.force = true;
    assert_ok(write_file("out/new.tsv", "second"));
    assert_text("out/new.tsv", "second");
}

static void test_files_that_were_changed_are_not_replaced(void **state) {
    (void)state;
    run_first();
    put("out/rdf.tsv", "fIrst"); // as many bytes
    assert_ok(open_out(false));
    assert_fails(mf_tracked_files_check(&own, NULL), STATUS_BAD_INPUT,
                 "out/rdf.tsv was changed since mesofit wrote it");
    assert_ok(mf_tracked_files_check(&own, (const char *const[]){"rdf.tsv", NULL}));
    assert_ok(mf_tracked_files_begin(&own, 2));
    assert_fails(write_file("out/rdf.tsv", "second"), STATUS_BAD_INPUT, "was changed");
    assert_ok(mf_tracked_files_remove_earlier(&own));
    assert_gone("out/old.tsv");
    assert_text("out/rdf.tsv", "fIrst");
    mf_tracked_files_close(&own);
    assert_ok(open_out(false)); // nobody's now
    assert_fails(write_file("out/rdf.tsv", "third"), STATUS_BAD_INPUT, "did not write it");
    mf_tracked_files_close(&own);
    assert_ok(open_out(true));
    assert_ok(write_file("out/rdf.tsv", "third"));
}

static void test_inputs_are_not_replaced_by_force(void **state) {
    struct input_files inputs = {0};
    (void)state;
    run_first();
    assert_ok(mf_input_files_add(&inputs, "./out/../out/rdf.tsv"));
    assert_ok(open_out(true));
    own.inputs = &inputs;
    assert_fails(mf_tracked_files_protect_inputs(&own, NULL), STATUS_BAD_INPUT,
                 "reads it as ./out/..");
    assert_ok(mf_tracked_files_protect_inputs(&own, (const char *const[]){"rdf.tsv", NULL}));
    assert_fails(write_file("out/rdf.tsv", "second"), STATUS_BAD_INPUT, "reads it as");
    assert_text("out/rdf.tsv", "first");
    mf_tracked_files_close(&own);
    mf_input_files_clear(&inputs);
}

/// Killed before and after it has begun, with and without its first file.
static void test_killed_run_leaves_a_list_that_is_right(void **state) {
    (void)state;
    for (int step = 0; step < 4; step++) {
        run_first();
        const pid_t child = fork();
        if (child == 0) {
            if (open_out(false) != STATUS_OK || mf_tracked_files_begin(&own, 2) != STATUS_OK)
                _exit(1);
            if (step > 0 && write_file("out/rdf.tsv", "second") != STATUS_OK)
                _exit(2);
            if (step > 1 && mf_tracked_files_remove_earlier(&own) != STATUS_OK)
                _exit(3);
            if (step > 2 && write_file("out/new.tsv", "second") != STATUS_OK)
                _exit(4);
            _exit(0);
        }
        int ended;
        assert_int_equal(waitpid(child, &ended, 0), child);
        assert_true(WIFEXITED(ended) && WEXITSTATUS(ended) == 0);
        // Another run goes on: that which was killed had not begun, for all it knows.
        assert_ok(open_out(false));
        assert_ok(mf_tracked_files_check(&own, NULL));
        assert_true(mf_tracked_files_has(&own, "rdf.tsv"));
        assert_int_equal(mf_tracked_files_has(&own, "new.tsv"), step > 2);
        if (step < 2) {
            assert_ok(mf_tracked_files_resume(&own, 1));
            assert_there("out/old.tsv");
            mf_tracked_files_close(&own);
            assert_ok(open_out(false));
        }
        // The same one does: what was before goes, if it has not gone yet.
        assert_ok(mf_tracked_files_begin(&own, 3));
        assert_ok(mf_tracked_files_claim("out/rdf.tsv", false));
        mf_manifest_clear(&own.list);
        assert_ok(mf_manifest_read(&own.list));
        assert_ok(mf_tracked_files_resume(&own, 3));
        assert_gone("out/old.tsv");
        assert_gone("out/new.tsv");
        assert_gone("out/states");
        assert_there("out/rdf.tsv");
        mf_tracked_files_close(&own);
    }
}

/// A run that fails before it has begun leaves all as it was.
static void test_run_that_does_not_begin_takes_nothing_over(void **state) {
    (void)state;
    run_first();
    assert_ok(open_out(false));
    assert_ok(mf_tracked_files_begin(&own, 1));
    mf_tracked_files_close(&own);
    assert_ok(open_out(false));
    assert_ok(mf_tracked_files_resume(&own, 1));
    assert_there("out/old.tsv");
    assert_there("out/states/a/rdf.tsv");
}

static void test_folder_that_was_made_for_nothing_goes(void **state) {
    (void)state;
    assert_ok(open_out(false));
    assert_ok(mf_tracked_files_lock(&own));
    assert_there("out");
    mf_status_fail(STATUS_IO, "why");
    mf_tracked_files_close(&own);
    assert_gone("out");
    assert_string_equal(mf_status_message(), "why");
    assert_int_equal(mkdir("out", 0777), 0);
    assert_ok(open_out(false));
    assert_ok(mf_tracked_files_lock(&own));
    mf_tracked_files_close(&own);
    assert_there("out");
}

static void test_links_are_not_followed(void **state) {
    (void)state;
    assert_int_equal(mkdir("elsewhere", 0777), 0);
    put("elsewhere/rdf.tsv", "mine");
    assert_int_equal(symlink("elsewhere", "out"), 0);
    assert_fails(open_out(true), STATUS_BAD_INPUT, "out is a link");
    assert_fails(mf_tracked_files_make(&own, "out//", TRACKED_FILES_OF_RUN), STATUS_BAD_INPUT,
                 "is a link");
    assert_int_equal(unlink("out"), 0);
    run_first();
    // A folder of a run becomes a link.
    assert_int_equal(unlink("out/states/a/rdf.tsv"), 0);
    assert_int_equal(rmdir("out/states/a"), 0);
    assert_int_equal(symlink("../../elsewhere", "out/states/a"), 0);
    assert_int_equal(symlink("../elsewhere", "out/figures"), 0);
    assert_ok(open_out(true));
    assert_fails(mf_tracked_files_reserve(&own, "figures/"), STATUS_BAD_INPUT,
                 "out/figures is a link");
    assert_fails(mf_output_make_folder("out/figures"), STATUS_BAD_INPUT, "out/figures is a link");
    assert_fails(mf_output_make_folder("out/states/a"), STATUS_BAD_INPUT, "states/a is a link");
    assert_ok(mf_tracked_files_begin(&own, 2));
    assert_ok(mf_tracked_files_remove_earlier(&own));
    assert_text("elsewhere/rdf.tsv", "mine");
    // A file that is a link: somebody else's.
    own.force = false;
    assert_int_equal(symlink("../elsewhere/rdf.tsv", "out/new.tsv"), 0);
    assert_fails(write_file("out/new.tsv", "second"), STATUS_BAD_INPUT, "did not write it");
    assert_text("elsewhere/rdf.tsv", "mine");
}

static void test_folder_that_is_removed_meanwhile_is_not_made_anew(void **state) {
    (void)state;
    run_first();
    for (int again = 0; again < 2; again++) {
        assert_ok(open_out(false));
        assert_int_equal(system("rm -r out"), 0);
        if (again)
            assert_int_equal(mkdir("out", 0777), 0); // another one
        assert_fails(write_file("out/rdf.tsv", "x"), STATUS_IO, "out is gone: it was removed");
        assert_fails(mf_output_make_folder("out/snapshots"), STATUS_IO, "out is gone");
        mf_tracked_files_close(&own);
        assert_int_equal(temporary_folder_exists("out"), again);
    }
}

/// Lines that say nothing, or would lead elsewhere.
static void test_lists_of_others_lead_nowhere(void **state) {
    static const char list[] =
        "begin 1\n-\t-\t../mine\n-\t-\t/mine\n-\t-\ta/../../mine\n-\t-\t./mine\n"
        "-\t-\ta//mine\n-\t-\t\nnothing\n-\tmine\nkept\n-\t-\tgood.tsv\n"
        "gone\t-\tmine\n-\t-\tmine\ngone\t-\tmine\n-\t-\tmin";
    (void)state;
    put("mine", "mine");
    assert_int_equal(mkdir("out", 0777), 0);
    put("out/mine", "mine");
    put("out/min", "mine");
    put("out/good.tsv", "x");
    put("out/" TRACKED_FILES_OF_RUN, list);
    assert_ok(open_out(false));
    assert_non_null(mf_manifest_find(&own.list, "good.tsv"));
    assert_null(mf_manifest_find(&own.list, "mine"));
    assert_null(mf_manifest_find(&own.list, "min"));
    assert_int_equal(own.list.count, 2);
    assert_ok(mf_tracked_files_begin(&own, 2)); // after a line that is ended first
    assert_ok(mf_tracked_files_remove_earlier(&own));
    assert_gone("out/good.tsv");
    assert_there("out/mine");
    assert_there("out/min");
    assert_there("mine");
    mf_tracked_files_close(&own);
    assert_int_equal(unlink("out/" TRACKED_FILES_OF_RUN), 0);
    assert_int_equal(symlink("../mine", "out/" TRACKED_FILES_OF_RUN), 0);
    assert_fails(open_out(false), STATUS_BAD_INPUT, "is a link or not a regular file");
    assert_text("mine", "mine");
}

static void test_one_process_at_a_time(void **state) {
    struct tracked_files second = {.open = false};
    (void)state;
    run_first();
    assert_ok(open_out(false));
    assert_ok(mf_tracked_files_lock(&own));
    assert_ok(mf_tracked_files_open(&second, "out", TRACKED_FILES_OF_RUN));
    assert_fails(mf_tracked_files_lock(&second), STATUS_BAD_INPUT, "another process is running");
    mf_tracked_files_close(&second);
    assert_there("out/rdf.tsv");
}

/// As `plot` may beside a run: what one enters the other knows, and what both have written is known
/// as it was left.
static void test_two_writers_know_of_each_other(void **state) {
    struct tracked_files second = {.open = false};
    (void)state;
    run_first();
    assert_ok(open_out(false));
    assert_ok(mf_tracked_files_open(&second, "./out", TRACKED_FILES_OF_RUN));
    assert_ok(write_file("out/a.svg", "own"));
    assert_ok(write_file("./out/b.svg", "second"));
    mf_tracked_files_close(&second);
    assert_ok(write_file("out/b.svg", "own"));
    mf_tracked_files_close(&own);
    assert_ok(open_out(false));
    assert_ok(mf_tracked_files_check(&own, NULL));
    assert_true(mf_tracked_files_has(&own, "a.svg") && mf_tracked_files_has(&own, "b.svg"));
    assert_false(mf_tracked_files_has_others(&own));
}

/// Many names, written by threads at once: none is lost, and no two temporary names are the same.
static void *write_many(void *context) {
    const int *first = context;
    for (int k = 0; k < 50; k++) {
        char path[64];
        snprintf(path, sizeof path, "out/%d.tsv", k % 5 ? *first + k : k);
        if (write_file(path, "whole\n") != STATUS_OK)
            return "failed";
    }
    return NULL;
}

static void test_threads_write_at_once(void **state) {
    enum { THREADS = 4 };
    pthread_t thread[THREADS];
    int first[THREADS];
    void *failed;
    (void)state;
    run_first();
    assert_ok(open_out(false));
    assert_ok(mf_tracked_files_begin(&own, 2));
    assert_ok(mf_tracked_files_remove_earlier(&own));
    for (int t = 0; t < THREADS; t++) {
        first[t] = 1000 * (t + 1);
        assert_int_equal(pthread_create(&thread[t], NULL, write_many, &first[t]), 0);
    }
    for (int t = 0; t < THREADS; t++) {
        assert_int_equal(pthread_join(thread[t], &failed), 0);
        assert_null(failed);
    }
    mf_tracked_files_close(&own);
    assert_ok(open_out(false));
    assert_ok(mf_tracked_files_check(&own, NULL));
    assert_false(mf_tracked_files_has_others(&own));
    assert_int_equal(own.list.count, 10 + THREADS * 40);
    assert_text("out/0.tsv", "whole\n");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, enter, leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_next_run_replaces_and_removes_what_is_its_own),
        TEST(test_files_of_others_are_not_replaced),
        TEST(test_files_that_were_changed_are_not_replaced),
        TEST(test_inputs_are_not_replaced_by_force),
        TEST(test_killed_run_leaves_a_list_that_is_right),
        TEST(test_run_that_does_not_begin_takes_nothing_over),
        TEST(test_folder_that_was_made_for_nothing_goes),
        TEST(test_links_are_not_followed),
        TEST(test_folder_that_is_removed_meanwhile_is_not_made_anew),
        TEST(test_lists_of_others_lead_nowhere),
        TEST(test_one_process_at_a_time),
        TEST(test_two_writers_know_of_each_other),
        TEST(test_threads_write_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
