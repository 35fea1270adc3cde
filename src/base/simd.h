// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Instruction sets: which ones there are, which one is used.
#pragma once

#include <stdbool.h>

enum simd { SIMD_PORTABLE, SIMD_AVX2, SIMD_AVX512 };

/// GCC compiles a file for an instruction set by a pragma. Other compilers and processors get by
/// with portable kernels.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define SIMD_X86 1
#else
#define SIMD_X86 0
#endif

/// Instruction set that kernels use: the best of this processor, or the selected one.
enum simd mf_simd_used(void);

/// Its name: "portable", "avx2" or "avx512".
const char *mf_simd_name(void);

/// Use the instruction set called `name` from now on.
/// @return false, and change nothing, if there is none of that name or the processor lacks it.
/// Threads: call it before there are several.
bool mf_simd_select(const char *name);

/// Compile a function once for each instruction set; the loader picks one when the program starts.
/// For helpers that are plain loops; kernels have a file for each set (pair_avx2.c,
/// pair_search_avx2.c). Not with a sanitizer, whose functions are not there yet when the loader
/// asks, nor by clang 14, which gives static functions of one name in two files one resolver.
/// Unfused: without products that are added in one rounding, so that all sets have the same bits.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) &&      \
    !defined(__clang__)
#define SIMD_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#define SIMD_CLONES_UNFUSED __attribute__((target_clones("avx2", "default")))
#else
#define SIMD_CLONES
#define SIMD_CLONES_UNFUSED
#endif
