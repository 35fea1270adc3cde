// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Digest of bytes: what a checkpoint's checksum is, and how a run knows its own settings.
///
/// FNV-1a, 64 bits: G. Fowler, L. C. Noll, K.-P. Vo and D. Eastlake, draft-eastlake-fnv. It finds
/// accidents; it is no protection against forgery. Tested: test_digest.
#pragma once

#include <stddef.h>
#include <stdint.h>

/// Digest of no bytes.
#define DIGEST_OF_NOTHING 0xcbf29ce484222325u

/// Go on with a digest over more bytes; `memory` may be NULL, and adds nothing then.
void mf_digest_add(uint64_t *digest, const void *memory, size_t bytes);
