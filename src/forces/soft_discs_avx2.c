// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/simd.h"

#if SIMD_X86
#pragma GCC target("avx2,bmi2,fma,popcnt")
#include "soft_discs_loop.h"

SOFT_DISCS_INSTANCES(mf_soft_discs_avx2)
#endif
