// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/simd.h"

#include <string.h>

static const char *const names[] = {"portable", "avx2", "avx512"};

/// −1: the best.
static int selected = -1;

static enum simd best(void) {
#if SIMD_X86
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
        return SIMD_AVX512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
        __builtin_cpu_supports("bmi2"))
        return SIMD_AVX2;
#endif
    return SIMD_PORTABLE;
}

enum simd mf_simd_used(void) {
    return selected < 0 ? best() : (enum simd)selected;
}

const char *mf_simd_name(void) {
    return names[mf_simd_used()];
}

bool mf_simd_select(const char *name) {
    for (int k = SIMD_PORTABLE; k <= (int)best(); k++)
        if (strcmp(name, names[k]) == 0) {
            selected = k;
            return true;
        }
    return false;
}
