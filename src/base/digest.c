// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/digest.h"

void mf_digest_add(uint64_t *digest, const void *memory, size_t bytes) {
    const unsigned char *byte = memory;
    for (size_t k = 0; memory && k < bytes; k++)
        *digest = (*digest ^ byte[k]) * 0x100000001b3u;
}
