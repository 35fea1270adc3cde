// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a small C program needs to run a simulation of its own.
#pragma once

#include "curves/formula.h"
#include "curves/sampled.h"
#include "observe/measure.h"

#define MESOFIT_VERSION "0.1.0"
