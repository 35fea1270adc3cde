// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/simd.h"

#if SIMD_X86
#pragma GCC target("avx2,bmi2,fma,popcnt")
#include "pair_memory_loop.h"

PAIR_MEMORY_INSTANCES(mf_pair_memory_avx2)
#endif
