// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a scene saves by the parts of a step that it does not need.
#pragma once

#include "bench/bench_case.h"

#include <stdio.h>

/// Time the scene as a fit runs it, and then with one part more or less at every step, with the
/// instruction set and precision of `how`; print a line each. Fails: as mf_bench_case_begin.
enum status mf_bench_skips(FILE *out, const struct bench_scene *scene,
                           const struct bench_how *how) MUST_USE;
