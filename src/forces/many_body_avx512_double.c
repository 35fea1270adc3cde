// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/simd.h"

#if SIMD_X86
// 512-bit vectors must be asked for: see pair_avx512.c.
#pragma GCC target(                                                                                \
    "avx512f,avx512dq,avx512bw,avx512vl,avx2,bmi2,fma,popcnt,prefer-vector-width=512")
#define LANES_DOUBLE
#include "many_body_loop.h"

MANY_BODY_INSTANCES(mf_many_body_avx512_double)
#endif
