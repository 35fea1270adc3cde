// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/growing.h"

#include <string.h>

enum status mf_growing_reserve(void *array, size_t *capacity, size_t used, size_t wanted,
                               size_t size, size_t first) {
    size_t larger = *capacity > 0 ? 2 * *capacity : first;
    void *old;
    if (wanted <= *capacity)
        return STATUS_OK;
    larger = larger > wanted ? larger : wanted;
    void *const grown = mf_memory_uncleared(larger, size);
    if (grown == NULL)
        return STATUS_NO_MEMORY;
    memcpy(&old, array, sizeof old);
    if (used > 0)
        memcpy(grown, old, used * size);
    mf_memory_free(old);
    memcpy(array, &grown, sizeof grown);
    *capacity = larger;
    return STATUS_OK;
}
