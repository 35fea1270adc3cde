// SPDX-License-Identifier: GPL-3.0-or-later
//
// Preloaded before the program's own libraries: the process is killed at the step of that number at
// which it changes what is on the disk: a file gets its name or is removed, a folder is made, a
// line comes into a list of files. KILL_AT=5 kills it before its fifth step, KILL_AT=-5 after it.
#define _GNU_SOURCE // RTLD_NEXT
#include <dlfcn.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int count;

static void kill_at(int number) {
    const char *text = getenv("KILL_AT");
    if (text && atoi(text) == number)
        raise(SIGKILL);
}

/// The function of this name that is preloaded over.
#define FIND(real, name)                                                                           \
    do {                                                                                           \
        void *symbol = dlsym(RTLD_NEXT, name);                                                     \
        memcpy(&(real), &symbol, sizeof(real));                                                    \
        kill_at(++count);                                                                          \
    } while (0)

int rename(const char *from, const char *to) {
    int (*real)(const char *, const char *);
    FIND(real, "rename");
    const int result = real(from, to);
    kill_at(-count);
    return result;
}

int renameat(int place, const char *from, int other, const char *to) {
    int (*real)(int, const char *, int, const char *);
    FIND(real, "renameat");
    const int result = real(place, from, other, to);
    kill_at(-count);
    return result;
}

int unlinkat(int place, const char *name, int flags) {
    int (*real)(int, const char *, int);
    FIND(real, "unlinkat");
    const int result = real(place, name, flags);
    kill_at(-count);
    return result;
}

int mkdirat(int place, const char *name, mode_t mode) {
    int (*real)(int, const char *, mode_t);
    FIND(real, "mkdirat");
    const int result = real(place, name, mode);
    kill_at(-count);
    return result;
}

/// After each line of a list.
int fdatasync(int file) {
    int (*real)(int);
    FIND(real, "fdatasync");
    const int result = real(file);
    kill_at(-count);
    return result;
}
