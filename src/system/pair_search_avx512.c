// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/simd.h"

#if SIMD_X86
// 512-bit vectors must be asked for: GCC prefers 256 bits on processors that clock down for them.
#pragma GCC target(                                                                                \
    "avx512f,avx512dq,avx512bw,avx512vl,avx2,bmi2,fma,popcnt,prefer-vector-width=512")
#include "pair_search_loop.h"

PAIR_SEARCH_INSTANCE(mf_pair_search_avx512)
#endif
