// SPDX-License-Identifier: GPL-3.0-or-later
//
// Files that many threads of two programs write into one folder at once, from a byte to a megabyte:
// each has its own bytes whenever it is looked at, and nothing is left behind.
#include "live/live_folder.h"
#include "shared/run_program.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

enum { PROGRAMS = 2, THREADS = 4, ROUNDS = 100, LARGEST = 1 << 20 };

static int root;

/// Bytes of a file are its letter, and their number is that of a round.
static size_t size_of(int round) {
    return (size_t)1 << (round % 21);
}

static bool has(const char *file, char letter) {
    static _Thread_local char text[LARGEST];
    size_t size;
    const int opened = mf_live_folder_read(root, file, &size);
    const ssize_t got = opened < 0 ? -1 : read(opened, text, sizeof text);
    if (opened >= 0)
        close(opened);
    bool same = got > 0 && (size & (size - 1)) == 0 && (size_t)got == size;
    for (ssize_t k = 0; same && k < got; k++)
        same = text[k] == letter;
    return same;
}

/// Returns NULL if all went well.
static void *write_rounds(void *context) {
    const char letter = *(const char *)context;
    char file[16], *bytes = malloc(LARGEST);
    snprintf(file, sizeof file, "%c.txt", letter);
    memset(bytes, letter, LARGEST);
    void *failed = NULL;
    for (int round = 0; round < ROUNDS && failed == NULL; round++)
        if (mf_live_folder_write(root, file, bytes, size_of(round), true) != STATUS_OK ||
            !has(file, letter))
            failed = context;
    free(bytes);
    return failed;
}

/// One program: whether all of its threads had their bytes.
static bool write_all(const char *letters) {
    pthread_t thread[THREADS];
    bool good = true;
    for (int k = 0; k < THREADS; k++)
        if (pthread_create(&thread[k], NULL, write_rounds, (void *)(size_t)&letters[k]) != 0)
            return false;
    for (int k = 0; k < THREADS; k++) {
        void *failed;
        good = pthread_join(thread[k], &failed) == 0 && failed == NULL && good;
    }
    return good;
}

static void test_files_of_threads_and_programs_have_their_own_bytes(void **state) {
    static const char letters[] = "abcdefgh";
    struct temporary_folder *folder = *state;
    pid_t program[PROGRAMS];
    int status[PROGRAMS];
    root = open(folder->path, O_RDONLY | O_DIRECTORY);
    assert_true(root >= 0);
    for (int k = 0; k < PROGRAMS; k++)
        if ((program[k] = fork()) == 0)
            _exit(write_all(letters + k * THREADS) ? 0 : 1);
    for (int k = 0; k < PROGRAMS; k++)
        assert_int_equal(waitpid(program[k], &status[k], 0), program[k]);
    for (int k = 0; k < PROGRAMS; k++)
        assert_int_equal(status[k], 0);
    run_program_assert_no_partial(folder->path);
    close(root);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_files_of_threads_and_programs_have_their_own_bytes,
                                        temporary_folder_create, temporary_folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
