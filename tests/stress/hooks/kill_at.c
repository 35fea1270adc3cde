// SPDX-License-Identifier: GPL-3.0-or-later
//
// Preloaded before the program's own libraries: the process is killed at the rename of that number.
// KILL_AT=5 kills it before its fifth rename, KILL_AT=-5 after it.
#define _GNU_SOURCE // RTLD_NEXT
#include <dlfcn.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int rename(const char *from, const char *to) {
    static int count;
    int (*real)(const char *, const char *);
    void *symbol = dlsym(RTLD_NEXT, "rename");
    memcpy(&real, &symbol, sizeof real);
    const char *text = getenv("KILL_AT");
    const int at = text ? atoi(text) : 0;
    count++;
    if (at == count)
        raise(SIGKILL);
    const int result = real(from, to);
    if (at == -count)
        raise(SIGKILL);
    return result;
}
