// SPDX-License-Identifier: GPL-3.0-or-later
#define _DEFAULT_SOURCE // madvise
#include "base/memory.h"

#include <malloc.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

/// Let the system use its pages of 2 MB, if it has such, for an array that is not small: a page of
/// 4 kB is looked up anew at nearly every access to somewhere. Arrays do not begin at such a page:
/// elements of one number in several arrays would then share the same few places of the caches.
static void want_large_pages(void *array, size_t bytes) {
#ifdef MADV_HUGEPAGE
    enum { NOT_SMALL = 1 << 20, PAGE = 1 << 12 };
    char *const end = (char *)array + bytes;
    char *const begin = (char *)array + (PAGE - (uintptr_t)array % PAGE) % PAGE;
    if (bytes >= NOT_SMALL)
        (void)madvise(begin, (size_t)(end - begin) / PAGE * PAGE, MADV_HUGEPAGE);
#else
    (void)array, (void)bytes;
#endif
}

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

void *mf_memory_scattered(size_t count, size_t size) {
    void *array = mf_memory_uncleared(count, size);
    if (array) {
        want_large_pages(array, count * size);
        memset(array, 0, count * size);
    }
    return array;
}

void mf_memory_free(void *array) {
    free(array);
}

void mf_memory_release(void *pointer) {
    void *array;
    memcpy(&array, pointer, sizeof array);
    mf_memory_free(array);
}

void mf_memory_keep(void) {
    enum { LARGE = 1 << 28 };
    mallopt(M_MMAP_THRESHOLD, LARGE);
    mallopt(M_TRIM_THRESHOLD, LARGE);
}

void mf_memory_image_clear(struct memory_image *image) {
    mf_memory_free(image->span);
    mf_memory_free(image->bytes);
    *image = (struct memory_image){0};
}

/// Bytes of a span in the image, so many that the next one is aligned.
static size_t capacity_of(size_t bytes) {
    return (bytes + MEMORY_ALIGNMENT - 1) / MEMORY_ALIGNMENT * MEMORY_ALIGNMENT;
}

enum status mf_memory_image_take(struct memory_image *image, const struct memory_span *spans,
                                 size_t count) {
    enum status status = STATUS_OK;
    struct memory_image taken = {.count = count};
    size_t size = 0;
    for (size_t k = 0; k < count; k++)
        size += capacity_of(spans[k].bytes);
    NEW_ARRAY(taken.span, count);
    NEW_ARRAY(taken.bytes, size);
    size = 0;
    for (size_t k = 0; k < count; k++) {
        taken.span[k] = (struct memory_span){taken.bytes + size, spans[k].bytes};
        if (spans[k].bytes > 0)
            memcpy(taken.bytes + size, spans[k].memory, spans[k].bytes);
        size += capacity_of(spans[k].bytes);
    }
    mf_memory_image_clear(image);
    *image = taken;
    return STATUS_OK;
done:
    mf_memory_image_clear(&taken);
    return status;
}
