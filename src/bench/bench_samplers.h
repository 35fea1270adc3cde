// SPDX-License-Identifier: GPL-3.0-or-later
/// @file `mesofit bench samplers`: how soon each sampler of the inversions knows g(r).
#pragma once

#include "report/run_folder.h"

/// Print, for the scene's potential at its density and temperature, what the error of g (rms over
/// bins) times the square root of the processor time is, for every sampler, with 729 and with 2744
/// particles. Fails: BAD_INPUT (no potential), IO, NO_MEMORY, INTERRUPTED. Tested: test_bench.
enum status mf_bench_samplers(const char *file, const struct run_options *common) MUST_USE;
