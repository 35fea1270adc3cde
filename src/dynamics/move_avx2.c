// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/simd.h"

#if SIMD_X86
#pragma GCC target("avx2,bmi2,fma,popcnt")
#include "move_loop.h"

MOVE_INSTANCES(mf_move_avx2)
#endif
