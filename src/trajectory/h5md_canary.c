// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/h5md_canary.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

/// It dies in silence: no handler of anybody, no core.
static void be_mortal(void) {
    static const int signals[] = {SIGSEGV, SIGBUS,  SIGFPE, SIGILL,  SIGABRT,
                                  SIGPIPE, SIGTERM, SIGHUP, SIGUSR1, SIGINT};
    for (size_t k = 0; k < sizeof signals / sizeof *signals; k++)
        signal(signals[k], signals[k] == SIGINT ? SIG_IGN : SIG_DFL);
    setrlimit(RLIMIT_CORE, &(const struct rlimit){0});
}

enum status mf_h5md_canary_begin(struct h5md_canary *canary, void (*go)(void *context, int to),
                                 void *context) {
    int ends[2];
    *canary = (struct h5md_canary){0};
    if (pipe(ends) != 0)
        return mf_status_fail(STATUS_NO_MEMORY, "no pipe to a process that reads HDF5 ahead");
    canary->child = fork();
    if (canary->child == 0) {
        be_mortal();
        close(ends[0]);
        go(context, ends[1]);
        _exit(0);
    }
    close(ends[1]);
    canary->from = ends[0];
    fcntl(canary->from, F_SETFD, FD_CLOEXEC);
    if (canary->child > 0)
        return STATUS_OK;
    *canary = (struct h5md_canary){0};
    close(ends[0]);
    return mf_status_fail(STATUS_NO_MEMORY, "no process is left that could read HDF5 ahead");
}

void mf_h5md_canary_tell(int to) {
    if (write(to, "", 1) != 1)
        _exit(0); // nobody listens any more
}

/// Whether it died of a signal.
static bool has_died(struct h5md_canary *canary) {
    int how = 0;
    close(canary->from);
    while (waitpid(canary->child, &how, 0) < 0 && errno == EINTR)
        continue;
    canary->child = 0;
    return WIFSIGNALED(how);
}

enum status mf_h5md_canary_wait(struct h5md_canary *canary, size_t steps, const char *file) {
    char byte;
    while (canary->child > 0 && canary->passed < steps) {
        const ssize_t got = read(canary->from, &byte, 1);
        canary->passed += got == 1;
        if (got == 0 && has_died(canary))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: HDF5 crashes where it reads it: it is damaged", file);
    }
    return STATUS_OK;
}

void mf_h5md_canary_end(struct h5md_canary *canary) {
    if (canary->child <= 0)
        return;
    kill(canary->child, SIGKILL);
    has_died(canary);
}
