// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // fopencookie
#include "base/terminal.h"

#include "base/visible.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>
#include <unistd.h>

static bool write_all(int file, const char *bytes, size_t count) {
    while (count > 0) {
        const ssize_t written = write(file, bytes, count);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return false;
        bytes += written;
        count -= (size_t)written;
    }
    return true;
}

/// Take one more byte; returns the bytes of `shown` that it, and what was begun, are shown as.
static size_t take(struct terminal *terminal, char byte, char shown[4 * VISIBLE_MAX]) {
    size_t used = 0, taken;
    terminal->begun[terminal->size++] = byte;
    while (terminal->size > 0 && !mf_visible_is_begun(terminal->begun, terminal->size)) {
        used += mf_visible_show(terminal->begun, terminal->size, "\n\t", shown + used, &taken);
        terminal->size -= taken;
        memmove(terminal->begun, terminal->begun + taken, terminal->size);
    }
    return used;
}

/// How the stream writes; 0 if it fails, with errno.
static ssize_t show(void *context, const char *bytes, size_t count) {
    enum { PIECE = 4096 };
    char shown[PIECE + 4 * VISIBLE_MAX];
    size_t used = 0;
    for (size_t k = 0; k < count; k++) {
        used += take(context, bytes[k], shown + used);
        if (used >= PIECE || k + 1 == count) {
            if (!write_all(((struct terminal *)context)->file, shown, used))
                return 0;
            used = 0;
        }
    }
    return (ssize_t)count;
}

FILE *mf_terminal_open(struct terminal *terminal, int file) {
    *terminal = (struct terminal){.file = file};
    return fopencookie(terminal, "w", (cookie_io_functions_t){.write = show});
}

enum status mf_terminal_begin(void) {
    static struct terminal terminals[2];
    FILE *out = mf_terminal_open(&terminals[0], STDOUT_FILENO);
    FILE *err = mf_terminal_open(&terminals[1], STDERR_FILENO);
    if (out == NULL || err == NULL)
        return mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    // As they were: lines to a terminal, pieces to a file; errors at once.
    setvbuf(out, NULL, isatty(STDOUT_FILENO) ? _IOLBF : _IOFBF, BUFSIZ);
    setvbuf(err, NULL, _IONBF, 0);
    stdout = out;
    stderr = err;
    return STATUS_OK;
}

void mf_terminal_clear_line(void) {
    (void)write_all(STDERR_FILENO, "\r\033[K", 4);
}
