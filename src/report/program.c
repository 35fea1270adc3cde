// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // pipe2, wait4
#include "report/program.h"

#include "base/clock.h"
#include "base/interrupt.h"
#include "base/spent.h"
#include "io/output.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum {
    EXIT_NOT_FOUND = 127,   ///< of the child, when there is no such program
    EXIT_NOT_STARTED = 126, ///< of the child, when it cannot run the program
};

// Running -----------------------------------------------------------------------------------------

extern char **environ;

static const char plain_locale[] = "LC_ALL=C.UTF-8";

/// The environment of this program, but for its language: where decimals have a comma awk reads
/// 0.5 as 0, and the order of names is another one. To be freed with free(), NULL without memory.
static char **make_environment(void) {
    size_t count = 0, kept = 0;
    while (environ[count])
        count++;
    char **environment = calloc(count + 2, sizeof *environment);
    for (size_t k = 0; environment && k < count; k++)
        if (strncmp(environ[k], plain_locale, strcspn(plain_locale, "=") + 1) != 0)
            environment[kept++] = environ[k];
    if (environment)
        environment[kept] = (char *)(size_t)plain_locale;
    return environment;
}

/// What is run, and for how long.
struct running {
    const char *folder, *name; ///< the name is for messages
    const char *const *words;
    enum program_says says;
    double end;                ///< by the clock; INFINITY: any time
    bool stops;                ///< when this program is to stop,
    const atomic_bool *cancel; ///< or this is set
    const struct program_ear *ear;
};

/// In the child: nothing but calls that are safe after a fork of a program with threads.
static void become(const struct running *running, char **environment, pid_t parent,
                   const int ends[2]) {
    const char *const *words = running->words;
    const enum program_says says = running->says;
    environ = environment;
    setpgid(0, 0); // a group of its own, so that it can be stopped as a whole
    if (running->stops && (prctl(PR_SET_PDEATHSIG, SIGTERM) != 0 || getppid() != parent))
        _exit(EXIT_NOT_STARTED);
    const int nothing = open("/dev/null", O_RDWR);
    const int out = says == PROGRAM_EVERYTHING ? ends[1] : nothing;
    if (nothing >= 0 && dup2(nothing, STDIN_FILENO) >= 0 && dup2(out, STDOUT_FILENO) >= 0 &&
        dup2(ends[1], STDERR_FILENO) >= 0 && close(ends[0]) == 0 && chdir(running->folder) == 0)
        execvp(words[0], (char *const *)words);
    _exit(errno == ENOENT ? EXIT_NOT_FOUND : EXIT_NOT_STARTED);
}

/// Milliseconds until the clock shows `end`; −1 if that is never.
static int time_left(double end) {
    const double seconds = end - clock_seconds();
    return isinf(end) ? -1 : seconds > 0 ? (int)ceil(1e3 * seconds) : 0;
}

/// Milliseconds until one looks again.
static int patience(const struct running *running) {
    enum { LOOK = 50 };
    const int left = time_left(running->end);
    return running->stops && (left < 0 || left > LOOK) ? LOOK : left;
}

static bool is_over(const struct running *running) {
    return time_left(running->end) == 0 || (running->stops && mf_interrupt_wanted(running->cancel));
}

/// Read to the end and keep the last size − 1 bytes as a text; false if it does not end in time.
static bool read_tail(int file, const struct running *running, char *text, size_t size) {
    char chunk[512];
    size_t used = 0;
    struct pollfd ready = {.fd = file, .events = POLLIN};
    for (;;) {
        const int events = poll(&ready, 1, patience(running));
        if (is_over(running))
            return false;
        if (events == 0 || (events < 0 && errno == EINTR))
            continue;
        const ssize_t count = read(file, chunk, sizeof chunk);
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            return true;
        const size_t capacity = size - 1 - (size_t)count;
        const size_t kept = used < capacity ? used : capacity;
        memmove(text, text + used - kept, kept);
        memcpy(text + kept, chunk, (size_t)count);
        used = kept + (size_t)count;
        text[used] = '\0';
        if (running->ear)
            running->ear->hear(running->ear->context, text);
    }
}

/// Cut `text` after its last line that is not empty, and return that line.
static const char *last_line(char *text) {
    size_t length = strlen(text);
    while (length > 0 && strchr(" \t\n", text[length - 1]))
        text[--length] = '\0';
    const char *newline = strrchr(text, '\n');
    return newline ? newline + 1 : text;
}

/// Processor time of a command that has ended, and of those that it has waited for.
static void account(const struct rusage *usage) {
    const struct timeval *user = &usage->ru_utime, *system = &usage->ru_stime;
    mf_spent_add(SPENT_ENGINE, (double)(user->tv_sec + system->tv_sec) +
                                   1e-6 * (double)(user->tv_usec + system->tv_usec));
}

/// Wait until a program has ended, which one that has closed its streams may not have; false if it
/// has not in time.
static bool wait_for(pid_t child, const struct running *running, int *state) {
    const struct timespec pause = {.tv_nsec = 2000000};
    const bool patient = running == NULL || (isinf(running->end) && !running->stops);
    for (;;) {
        struct rusage usage;
        const pid_t ended = wait4(child, state, patient ? 0 : WNOHANG, &usage);
        if (ended == child && running && running->stops)
            account(&usage);
        if (ended == child || (ended < 0 && errno != EINTR))
            return true;
        if (ended == 0 && is_over(running))
            return false;
        if (ended == 0)
            nanosleep(&pause, NULL);
    }
}

/// What became of a program that has ended.
static enum status assess(const char *name, int state, char *text) {
    if (WIFEXITED(state) && WEXITSTATUS(state) == 0)
        return STATUS_OK;
    if (WIFSIGNALED(state))
        return mf_status_fail(STATUS_IO, "%s was ended by signal %d", name, WTERMSIG(state));
    if (WEXITSTATUS(state) == EXIT_NOT_FOUND)
        return mf_status_fail(STATUS_IO, "%s is not installed", name);
    if (text[0])
        return mf_status_fail(STATUS_IO, "%s failed: %s", name, last_line(text));
    return mf_status_fail(STATUS_IO, "%s ended with exit code %d and said nothing", name,
                          WEXITSTATUS(state));
}

/// Stop it, with the programs that it has started: those of MPI are told first, as they have others
/// to tell.
static void stop(pid_t child, const struct running *running) {
    struct running gentle = {.end = clock_seconds() + 2};
    int state;
    if (running->stops && kill(-child, SIGTERM) == 0 && wait_for(child, &gentle, &state)) {
        kill(-child, SIGKILL); // what has not heard
        return;
    }
    kill(-child, SIGKILL);
    wait_for(child, NULL, &state);
}

static enum status run_it(const struct running *running, char *text, size_t size) {
    int ends[2];
    const pid_t parent = getpid();
    text[0] = '\0';
    char **environment = make_environment();
    if (environment == NULL)
        return mf_status_fail(STATUS_NO_MEMORY, "cannot run %s: out of memory", running->name);
    if (pipe2(ends, O_CLOEXEC) != 0) {
        free(environment);
        return mf_status_fail(STATUS_IO, "cannot run %s: %s", running->name, strerror(errno));
    }
    const double begun = clock_seconds();
    const pid_t child = fork();
    if (child == 0)
        become(running, environment, parent, ends);
    const int error = errno;
    free(environment);
    close(ends[1]);
    int state = -1;
    const bool ended =
        child > 0 && read_tail(ends[0], running, text, size) && wait_for(child, running, &state);
    close(ends[0]);
    if (child < 0)
        return mf_status_fail(STATUS_IO, "cannot run %s: %s", running->name, strerror(error));
    if (ended)
        return assess(running->name, state, text);
    stop(child, running);
    if (running->stops && mf_interrupt_wanted(running->cancel))
        return mf_status_fail(STATUS_INTERRUPTED, "%s was stopped", running->name);
    return mf_status_fail(STATUS_IO, "%s had not ended after %.3g s and was stopped", running->name,
                          running->end - begun);
}

enum status mf_program_hear(const char *folder, const char *const *words, enum program_says says,
                            double seconds, const struct program_ear *ear, char *text,
                            size_t size) {
    return run_it(&(struct running){.folder = folder,
                                    .name = words[0],
                                    .words = words,
                                    .says = says,
                                    .end = seconds > 0 ? clock_seconds() + seconds : INFINITY,
                                    .ear = ear},
                  text, size);
}

enum status mf_program_run(const char *folder, const char *const *words, enum program_says says,
                           double seconds, char *text, size_t size) {
    return mf_program_hear(folder, words, says, seconds, NULL, text, size);
}

enum status mf_program_command(const char *folder, const char *const *words,
                               const atomic_bool *cancel, char *text, size_t size) {
    enum { MOST = 32 };
    char script[OUTPUT_PATH_SIZE];
    const char *all[MOST + 4] = {"sh", "-c", script, "sh"};
    // A plain command takes the place of the shell, so that it ends with this program.
    const bool plain = words[0][strcspn(words[0], ";&|<>()$`=\n")] == '\0';
    const int length =
        snprintf(script, sizeof script, "%s%s \"$@\"", plain ? "exec " : "", words[0]);
    if (length < 0 || (size_t)length >= sizeof script)
        return mf_status_fail(STATUS_BAD_INPUT, "the command is too long: %.60s...", words[0]);
    for (size_t k = 1; k < MOST && words[k]; k++)
        all[3 + k] = words[k];
    return run_it(&(struct running){.folder = folder,
                                    .name = words[0],
                                    .words = all,
                                    .says = PROGRAM_EVERYTHING,
                                    .end = INFINITY,
                                    .stops = true,
                                    .cancel = cancel},
                  text, size);
}

// Where this program's files are ------------------------------------------------------------------

static bool has_file(const char *folder, const char *file) {
    char path[OUTPUT_PATH_SIZE + 64];
    snprintf(path, sizeof path, "%s/%s", folder, file);
    return access(path, R_OK) == 0;
}

enum status mf_program_find_folder(char *path, size_t size, const char *name, const char *file) {
    char folder[OUTPUT_PATH_SIZE];
    const ssize_t length = readlink("/proc/self/exe", folder, sizeof folder - 1);
    if (length < 0)
        return mf_status_fail(STATUS_IO, "cannot read /proc/self/exe: %s", strerror(errno));
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
    return mf_status_fail(STATUS_IO,
                          "no folder %s with %s near the program, where `make install` puts it",
                          name, file);
}

void mf_program_begin_again(char **words) {
    if (getenv("OMP_WAIT_POLICY") || getenv("GOMP_SPINCOUNT"))
        return;
    // By its own path: as /proc/self/exe, `ps` and `pkill` would call it "exe".
    char self[OUTPUT_PATH_SIZE];
    const ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    if (length < 0 || length == sizeof self - 1 || setenv("GOMP_SPINCOUNT", "1000", 1) != 0)
        return;
    self[length] = '\0';
    execv(self, words);
    execv("/proc/self/exe", words); // it was replaced meanwhile
}
