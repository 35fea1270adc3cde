// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // ppoll
#include "shared/run_program.h"

#include "base/clock.h"
#include "shared/testing.h"

#include <ftw.h>
#include <libgen.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

extern char **environ;

enum { MAX_WORDS = 128 };

static const double usual_work_limit = 300, longest_idle = 600; // [s]

/// A running program.
struct child {
    pid_t process;
    clockid_t work; ///< its processor time
    int out, err;   ///< ends to read from; −1 once at its end
    size_t out_length, err_length;
    double started;     ///< clock [s]
    double first_words; ///< what it had worked by then [s]; negative: none yet
    double seen, since; ///< what it had worked when last seen to do so [s], and when that was
};

static const char *program_path(void) {
    const char *path = getenv("MESOFIT");
    if (path == NULL)
        fail_msg("the environment variable MESOFIT does not say where the program is");
    return path;
}

const char *run_program_sources(void) {
    static char path[1024];
    snprintf(path, sizeof path, "%s", program_path());
    char *folder = dirname(path);
    while (strlen(folder) > 1) {
        char page[1100];
        snprintf(page, sizeof page, "%s/ARCHITECTURE.md", folder);
        if (access(page, R_OK) == 0)
            return folder;
        folder = dirname(folder);
    }
    fail_msg("no sources above %s", program_path());
    return NULL;
}

/// posix_spawn knows no limits: the child inherits ours, which nothing here can run into.
static int spawn_limited(pid_t *process, long largest_file,
                         const posix_spawn_file_actions_t *actions,
                         const posix_spawnattr_t *attributes, char *const *words) {
    struct rlimit before;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    const struct rlimit limit = {largest_file > 0 ? (rlim_t)largest_file : before.rlim_cur,
                                 before.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    const int error = posix_spawn(process, words[0], actions, attributes, words, environ);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    return error;
}

/// Signals that a parent ignored, such as a shell's background job, take effect in the program.
static void init_attributes(posix_spawnattr_t *attributes) {
    sigset_t signals;
    sigemptyset(&signals);
    static const int numbers[] = {SIGINT, SIGTERM, SIGUSR1, SIGHUP, SIGPIPE, SIGXFSZ};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        sigaddset(&signals, numbers[k]);
    posix_spawnattr_init(attributes);
    posix_spawnattr_setsigdefault(attributes, &signals);
    posix_spawnattr_setflags(attributes, POSIX_SPAWN_SETSIGDEF);
}

static struct child start(const struct run_program_how *how, const char *const *words) {
    char *line[MAX_WORDS + 2] = {strdup(program_path())};
    for (int k = 0; words[k]; k++) {
        assert_true(k < MAX_WORDS);
        line[k + 1] = strdup(words[k]);
    }
    int out[2], err[2];
    assert_int_equal(pipe(out), 0);
    assert_int_equal(pipe(err), 0);
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", 0, 0);
    posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, err[1], STDERR_FILENO);
    for (int end = 0; end < 2; end++) {
        posix_spawn_file_actions_addclose(&actions, out[end]);
        posix_spawn_file_actions_addclose(&actions, err[end]);
    }
    init_attributes(&attributes);
    const double now = clock_seconds();
    struct child child = {
        .out = out[0], .err = err[0], .started = now, .since = now, .first_words = -1};
    const int error = spawn_limited(&child.process, how->largest_file, &actions, &attributes, line);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    close(out[1]);
    close(err[1]);
    if (error != 0)
        fail_msg("cannot start %s: %s", line[0], strerror(error));
    assert_int_equal(clock_getcpuclockid(child.process, &child.work), 0);
    for (int k = 0; line[k]; k++)
        free(line[k]);
    return child;
}

/// Append what there is to read; at the end of the stream *file becomes −1.
static void take(int *file, char *text, size_t size, size_t *length) {
    if (*length + 1 >= size)
        fail_msg("the program says more than %zu bytes", size);
    const ssize_t count = read(*file, text + *length, size - 1 - *length);
    if (count > 0) {
        *length += (size_t)count;
        text[*length] = '\0';
        return;
    }
    close(*file);
    *file = -1;
}

/// Processor time [s] that it has had, also after its end until it is waited for.
static double find_work(const struct child *child) {
    struct timespec now;
    assert_int_equal(clock_gettime(child->work, &now), 0);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/// Wait at most so long [s], and never longer than ten milliseconds, for something to read, and
/// take it.
static void listen_to(struct child *child, double seconds, struct run_program_result *result) {
    struct pollfd ends[] = {{.fd = child->out, .events = POLLIN},
                            {.fd = child->err, .events = POLLIN}};
    const struct timespec max = {.tv_nsec = (long)(1e9 * fmin(fmax(seconds, 0), 0.01))};
    if (ppoll(ends, 2, &max, NULL) <= 0)
        return;
    if (ends[0].revents)
        take(&child->out, result->out, sizeof result->out, &child->out_length);
    if (ends[1].revents)
        take(&child->err, result->err, sizeof result->err, &child->err_length);
    if (child->out_length + child->err_length > 0 && child->first_words < 0)
        child->first_words = find_work(child);
}

static void give_up(const struct child *child, const char *what, double seconds,
                    const struct run_program_result *result) {
    kill(child->process, SIGKILL);
    waitpid(child->process, NULL, 0);
    fail_msg("the program has %s for %g s; it says: %s", what, seconds, result->err);
}

/// A program that works too long is stopped, and one that waits for what never comes.
static void kill_if_lost(struct child *child, double work, const struct run_program_how *how,
                         const struct run_program_result *result) {
    const double limit = how->work_limit > 0 ? how->work_limit : usual_work_limit;
    if (work > limit)
        give_up(child, "worked", limit, result);
    if (work > child->seen) {
        child->seen = work;
        child->since = clock_seconds();
    } else if (clock_seconds() - child->since > longest_idle) {
        give_up(child, "done nothing", longest_idle, result);
    }
}

/// Work that is left before it is interrupted [s]; infinite before its first words, if they are
/// what counts.
static double until_interruption(const struct child *child, double work,
                                 const struct run_program_how *how) {
    const double since = how->interrupt_from_start ? 0 : child->first_words;
    return since >= 0 ? since + how->interrupt_after - work : HUGE_VAL;
}

void run_program(struct run_program_result *result, const struct run_program_how *how,
                 const char *const *words) {
    *result = (struct run_program_result){0};
    struct child child = start(how, words);
    bool interrupted = how->interrupt_with == 0;
    int status;
    while (child.out >= 0 || child.err >= 0) {
        const double work = find_work(&child);
        const double left = interrupted ? HUGE_VAL : until_interruption(&child, work, how);
        if (left <= 0) {
            interrupted = true;
            kill(child.process, how->interrupt_with);
        }
        // Threads may work side by side, so that the time is over sooner.
        listen_to(&child, fmax(left / 4, 1e-5), result);
        kill_if_lost(&child, work, how, result);
    }
    siginfo_t ended;
    assert_int_equal(waitid(P_PID, (id_t)child.process, &ended, WEXITED | WNOWAIT), 0);
    result->worked = find_work(&child);
    result->seconds = clock_seconds() - child.started;
    assert_int_equal(waitpid(child.process, &status, 0), child.process);
    result->code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

void run_program_assert_code(const struct run_program_result *result, int expected) {
    if (result->code != expected)
        fail_msg("exit code %d instead of %d; it says: %s%s", result->code, expected, result->out,
                 result->err);
}

static int refuse_partial(const char *path, const struct stat *about, int type, struct FTW *place) {
    (void)about, (void)type, (void)place;
    const char *dot = strrchr(path, '.');
    if (dot && strcmp(dot, ".partial") == 0)
        fail_msg("%s was left behind", path);
    return 0;
}

void run_program_assert_no_partial(const char *folder) {
    assert_int_equal(nftw(folder, refuse_partial, 16, FTW_PHYS), 0);
}

static int refuse_results(const char *path, const struct stat *about, int type, struct FTW *place) {
    if (strcmp(path + place->base, "summary.json") == 0)
        fail_msg("%s was left behind", path);
    return refuse_partial(path, about, type, place);
}

void run_program_assert_refused(const struct run_program_result *result, const char *folder,
                                const char *what, size_t lines, const char *const *words) {
    if (result->code != 2 || result->out[0] || strncmp(result->err, "mesofit: ", 9) != 0)
        fail_msg("%s: exit code %d, stdout \"%s\", stderr \"%s\"", what, result->code, result->out,
                 result->err);
    if (run_program_lines(result->err) != lines)
        fail_msg("%s: not %zu lines: %s", what, lines, result->err);
    for (; *words; words++)
        if (strstr(result->err, *words) == NULL)
            fail_msg("%s: \"%s\" is not in: %s", what, *words, result->err);
    if (folder && access(folder, F_OK) == 0) // a folder that was made for it may have gone with it
        assert_int_equal(nftw(folder, refuse_results, 16, FTW_PHYS), 0);
}

int run_program_in_pieces(int code, const char *const *words) {
    static struct run_program_result result;
    enum { MAX_PIECES = 12, INTERRUPTED = 130 };
    const double shortest = 1e-5, longest = 0.05;
    const char *begun[MAX_WORDS] = {NULL}, *resumed[MAX_WORDS] = {NULL};
    int count = 0;
    for (; words[count]; count++)
        begun[count] = resumed[count] = words[count];
    begun[count] = "--force"; // an attempt that came too late has left its results
    resumed[count] = "--resume";
    for (double first = longest; first > shortest; first /= 3) {
        for (int piece = 0; piece < MAX_PIECES; piece++) {
            const struct run_program_how how = {.interrupt_with = SIGINT,
                                                .interrupt_after = first * (1 << piece)};
            run_program(&result, &how, piece ? resumed : begun);
            if (result.code != INTERRUPTED) {
                run_program_assert_code(&result, code);
                if (piece == 0)
                    break; // it was faster than the signal
                return piece;
            }
            assert_contains(result.err, "--resume");
        }
    }
    fail_msg("it could not be interrupted, or did not end");
    return 0;
}

size_t run_program_lines(const char *text) {
    size_t lines = 0;
    for (; *text; text++)
        lines += *text == '\n' || text[1] == '\0';
    return lines;
}
