// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/simd.h"

#if SIMD_X86
#pragma GCC target(                                                                                \
    "avx512f,avx512dq,avx512bw,avx512vl,avx2,bmi2,fma,popcnt,prefer-vector-width=512")
#include "move_loop.h"

MOVE_INSTANCES(mf_move_avx512)
#endif
