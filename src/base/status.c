// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/status.h"

#include "base/visible.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { MESSAGE_SIZE = STATUS_MESSAGE_SIZE };

static _Thread_local char message[MESSAGE_SIZE], stripped[MESSAGE_SIZE];

/// Messages quote files, whose texts may be anything.
static int print_visible(char *text, const char *format, va_list arguments) {
    char raw[MESSAGE_SIZE];
    vsnprintf(raw, sizeof raw, format, arguments);
    mf_visible_copy(text, MESSAGE_SIZE, raw, "\n\x1f");
    return (int)strlen(text);
}

enum status mf_status_fail(enum status status, const char *format, ...) {
    char text[MESSAGE_SIZE]; // the arguments may be parts of the message before
    va_list arguments;
    va_start(arguments, format);
    print_visible(text, format, arguments);
    va_end(arguments);
    memcpy(message, text, sizeof message);
    return status;
}

enum status mf_status_prefix(enum status status, const char *format, ...) {
    char rest[MESSAGE_SIZE];
    memcpy(rest, message, sizeof rest);
    va_list arguments;
    va_start(arguments, format);
    const int length = print_visible(message, format, arguments);
    va_end(arguments);
    const int capacity = MESSAGE_SIZE - length - (int)sizeof ": ";
    if (capacity > 0)
        snprintf(message + length, (size_t)(MESSAGE_SIZE - length), ": %.*s", capacity, rest);
    return status;
}

const char *mf_status_marked(void) {
    return message;
}

void mf_status_strip(char *text) {
    char *to = text;
    bool inside = false;
    for (; *text; text++) {
        inside = inside != (*text == STATUS_MARK);
        if (!inside && *text != STATUS_MARK)
            *to++ = *text;
    }
    *to = '\0';
}

const char *mf_status_message(void) {
    memcpy(stripped, message, sizeof stripped);
    mf_status_strip(stripped);
    return stripped;
}

const char *mf_status_name(enum status status) {
    switch (status) {
    case STATUS_OK:
        return "ok";
    case STATUS_BAD_INPUT:
        return "bad input";
    case STATUS_IO:
        return "input/output error";
    case STATUS_NO_MEMORY:
        return "out of memory";
    case STATUS_UNSTABLE:
        return "unstable";
    case STATUS_UNCONVERGED:
        return "unconverged";
    case STATUS_INTERRUPTED:
        return "interrupted";
    }
    return "unknown";
}
