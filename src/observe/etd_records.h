// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The pairs that an etd follows, one record each, found by their ids.
#pragma once

#include "observe/etd.h"

/// The record of a pair that is within r_maximum at an origin, a new one if there is none.
/// Fails: NO_MEMORY.
enum status mf_etd_records_find(struct etd *etd, uint32_t low, uint32_t high,
                                size_t *record) MUST_USE;

/// Drop the records of escaped pairs, and make the buckets again.
void mf_etd_records_compact(struct etd *etd);

void mf_etd_records_clear(struct etd *etd);
