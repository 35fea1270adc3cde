// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/own_words.h"

#include <stddef.h>
#include <string.h>

static const char *const before[] = {"now_", "error_"};
static const char *const behind[] = {"_history",   "_flat",  "_error",
                                     "_boltzmann", "_lower", "_upper"};

bool mf_own_words_has(const char *name) {
    const size_t length = strlen(name);
    for (size_t k = 0; k < sizeof before / sizeof *before; k++)
        if (strncmp(name, before[k], strlen(before[k])) == 0)
            return true;
    for (size_t k = 0; k < sizeof behind / sizeof *behind; k++) {
        const size_t own = strlen(behind[k]);
        if (length >= own && strcmp(name + length - own, behind[k]) == 0)
            return true;
    }
    return false;
}
