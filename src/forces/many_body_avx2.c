// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/simd.h"

#if SIMD_X86
#pragma GCC target("avx2,bmi2,fma,popcnt")
#include "many_body_loop.h"

MANY_BODY_INSTANCES(mf_many_body_avx2)
#endif
