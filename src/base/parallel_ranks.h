// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Tasks that ranks share: what mf_parallel_try does where there is more than one.
#pragma once

#include "base/parallel.h"
#include "base/parallel_failure.h"

/// mf_parallel_try with other ranks. A thread of its own talks to them, so that a rank is served
/// while all its other threads work: rank 0's hands out tasks in their order and collects what they
/// found; that of another rank asks for a task whenever a thread waits.
enum status mf_parallel_try_together(const struct parallel_tasks *tasks) MUST_USE;
