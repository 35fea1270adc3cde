// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/memory.h"

#include <malloc.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

void *mf_memory_uncleared(size_t count, size_t size) {
    if (size != 0 && count > (SIZE_MAX - MEMORY_ALIGNMENT) / size) {
        mf_status_fail(STATUS_NO_MEMORY, "an array of %zu elements is too large", count);
        return NULL;
    }
    const size_t bytes = (count * size + MEMORY_ALIGNMENT) / MEMORY_ALIGNMENT * MEMORY_ALIGNMENT;
    void *array = aligned_alloc(MEMORY_ALIGNMENT, bytes);
    if (array == NULL)
        mf_status_fail(STATUS_NO_MEMORY, "out of memory: %zu bytes wanted", bytes);
    return array;
}

void *mf_memory_zeroed(size_t count, size_t size) {
    void *array = mf_memory_uncleared(count, size);
    if (array)
        memset(array, 0, count * size);
    return array;
}

void mf_memory_free(void *array) {
    free(array);
}

void mf_memory_keep(void) {
    enum { LARGE = 1 << 28 };
    mallopt(M_MMAP_THRESHOLD, LARGE);
    mallopt(M_TRIM_THRESHOLD, LARGE);
}
