// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/program.h"

#include "io/output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    EXIT_NOT_FOUND = 127,   ///< of the child, when there is no such program
    EXIT_NOT_STARTED = 126, ///< of the child, when it cannot run the program
};

// Running -----------------------------------------------------------------------------------------

/// In the child: nothing but calls that are safe after a fork of a program with threads.
static void become(const char *folder, const char *const *words, enum program_says says,
                   const int ends[2]) {
    const int nothing = open("/dev/null", O_RDWR);
    const int out = says == PROGRAM_EVERYTHING ? ends[1] : nothing;
    if (nothing >= 0 && dup2(nothing, STDIN_FILENO) >= 0 && dup2(out, STDOUT_FILENO) >= 0 &&
        dup2(ends[1], STDERR_FILENO) >= 0 && close(ends[0]) == 0 && chdir(folder) == 0)
        execvp(words[0], (char *const *)words);
    _exit(errno == ENOENT ? EXIT_NOT_FOUND : EXIT_NOT_STARTED);
}

/// Read to the end and keep the last size − 1 bytes as a text.
static void read_tail(int file, char *text, size_t size) {
    char chunk[512];
    size_t used = 0;
    for (;;) {
        const ssize_t count = read(file, chunk, sizeof chunk);
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            break;
        const size_t room = size - 1 - (size_t)count;
        const size_t kept = used < room ? used : room;
        memmove(text, text + used - kept, kept);
        memcpy(text + kept, chunk, (size_t)count);
        used = kept + (size_t)count;
    }
    text[used] = '\0';
}

/// Cut `text` behind its last line that is not empty, and return that line.
static const char *last_line(char *text) {
    size_t length = strlen(text);
    while (length > 0 && strchr(" \t\n", text[length - 1]))
        text[--length] = '\0';
    const char *newline = strrchr(text, '\n');
    return newline ? newline + 1 : text;
}

static int wait_for(pid_t child) {
    int state = 0;
    while (waitpid(child, &state, 0) < 0)
        if (errno != EINTR)
            return -1;
    return state;
}

enum status program_run(const char *folder, const char *const *words, enum program_says says,
                        char *text, size_t size) {
    int ends[2];
    text[0] = '\0';
    if (pipe(ends) != 0)
        return status_fail(STATUS_IO, "cannot run %s: %s", words[0], strerror(errno));
    const pid_t child = fork();
    if (child == 0)
        become(folder, words, says, ends);
    close(ends[1]);
    if (child > 0)
        read_tail(ends[0], text, size);
    close(ends[0]);
    if (child < 0)
        return status_fail(STATUS_IO, "cannot run %s: %s", words[0], strerror(errno));
    const int state = wait_for(child);
    if (WIFEXITED(state) && WEXITSTATUS(state) == 0)
        return STATUS_OK;
    if (WIFSIGNALED(state))
        return status_fail(STATUS_IO, "%s was ended by signal %d", words[0], WTERMSIG(state));
    if (WEXITSTATUS(state) == EXIT_NOT_FOUND)
        return status_fail(STATUS_IO, "%s is not installed", words[0]);
    return status_fail(STATUS_IO, "%s failed: %s", words[0],
                       text[0] ? last_line(text) : "no reason");
}

// Where this program's files are ------------------------------------------------------------------

static bool has_file(const char *folder, const char *file) {
    char path[OUTPUT_PATH_SIZE + 64];
    snprintf(path, sizeof path, "%s/%s", folder, file);
    return access(path, R_OK) == 0;
}

enum status program_find_folder(char *path, size_t size, const char *name, const char *file) {
    char folder[OUTPUT_PATH_SIZE];
    const ssize_t length = readlink("/proc/self/exe", folder, sizeof folder - 1);
    if (length < 0)
        return status_fail(STATUS_IO, "cannot read /proc/self/exe: %s", strerror(errno));
    folder[length] = '\0';
    for (char *slash = strrchr(folder, '/'); slash; slash = strrchr(folder, '/')) {
        *slash = '\0';
        snprintf(path, size, "%s/%s", folder, name);
        if (has_file(path, file))
            return STATUS_OK;
        snprintf(path, size, "%s/share/mesofit/%s", folder, name);
        if (has_file(path, file))
            return STATUS_OK;
    }
    return status_fail(STATUS_IO, "no folder %s with %s near the program", name, file);
}

void program_begin_again(char **words) {
    if (getenv("OMP_WAIT_POLICY") || getenv("GOMP_SPINCOUNT"))
        return;
    if (setenv("GOMP_SPINCOUNT", "1000", 1) == 0)
        execv("/proc/self/exe", words);
}
