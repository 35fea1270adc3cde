// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/etd_records.h"

#include <string.h>

/// In place of a record.
static const uint32_t no_record = UINT32_MAX;

void mf_etd_records_clear(struct etd *etd) {
    mf_memory_free(etd->first);
    mf_memory_free(etd->second);
    mf_memory_free(etd->bin);
    mf_memory_free(etd->bucket);
    mf_memory_free(etd->next);
}

static uint32_t *find_bucket(const struct etd *etd, uint32_t low, uint32_t high) {
    // Multiplicative hashing (D. E. Knuth, The Art of Computer Programming, vol. 3, section 6.4).
    const uint64_t hash = ((uint64_t)low << 32 | high) * 0x9e3779b97f4a7c15u;
    return &etd->bucket[(hash >> 32) & (etd->buckets - 1)];
}

static void link_record(struct etd *etd, size_t record) {
    uint32_t *bucket = find_bucket(etd, etd->first[record], etd->second[record]);
    etd->next[record] = *bucket;
    *bucket = (uint32_t)record;
}

void mf_etd_records_compact(struct etd *etd) {
    size_t kept = 0;
    memset(etd->bucket, 0xff, etd->buckets * sizeof *etd->bucket);
    for (size_t p = 0; p < etd->state.followed; p++) {
        if (etd->first[p] == etd->second[p])
            continue;
        etd->first[kept] = etd->first[p];
        etd->second[kept] = etd->second[p];
        memmove(etd->bin + kept * etd->slots, etd->bin + p * etd->slots,
                etd->slots * sizeof *etd->bin);
        link_record(etd, kept++);
    }
    etd->state.followed = kept;
}

/// Move to arrays of twice the room, with two buckets a record.
static enum status grow(struct etd *etd) {
    enum status status = STATUS_OK;
    struct etd larger = *etd;
    larger.capacity = etd->capacity ? 2 * etd->capacity : 1024;
    larger.buckets = 2 * larger.capacity;
    larger.first = larger.second = larger.bucket = larger.next = NULL;
    larger.bin = NULL;
    NEW_ARRAY(larger.first, larger.capacity);
    NEW_ARRAY(larger.second, larger.capacity);
    NEW_ARRAY(larger.bin, larger.capacity * larger.slots);
    NEW_ARRAY(larger.bucket, larger.buckets);
    NEW_ARRAY(larger.next, larger.capacity);
    if (etd->capacity > 0) {
        memcpy(larger.first, etd->first, etd->capacity * sizeof *etd->first);
        memcpy(larger.second, etd->second, etd->capacity * sizeof *etd->second);
        memcpy(larger.bin, etd->bin, etd->capacity * etd->slots * sizeof *etd->bin);
        mf_etd_records_clear(etd);
    }
    *etd = larger;
done:
    if (status != STATUS_OK)
        mf_etd_records_clear(&larger);
    return status;
}

enum status mf_etd_reserve(struct etd *etd) {
    while (etd->capacity == 0 || etd->state.followed > etd->capacity)
        TRY(grow(etd));
    return STATUS_OK;
}

enum status mf_etd_records_find(struct etd *etd, uint32_t low, uint32_t high, size_t *record) {
    for (uint32_t p = *find_bucket(etd, low, high); p != no_record; p = etd->next[p])
        if (etd->first[p] == low && etd->second[p] == high) {
            *record = p;
            return STATUS_OK;
        }
    if (etd->state.followed == etd->capacity) {
        TRY(grow(etd));
        mf_etd_records_compact(etd);
    }
    *record = etd->state.followed++;
    etd->first[*record] = low;
    etd->second[*record] = high;
    memset(etd->bin + *record * etd->slots, 0xff, etd->slots * sizeof *etd->bin);
    link_record(etd, *record);
    return STATUS_OK;
}
