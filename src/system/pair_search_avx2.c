// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/simd.h"

#if SIMD_X86
#pragma GCC target("avx2,bmi2,fma,popcnt")
#include "pair_search_loop.h"

PAIR_SEARCH_INSTANCE(mf_pair_search_avx2)
#endif
