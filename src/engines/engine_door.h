// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The engine that a command line names, for the fits that it starts (scene/run_options.h).
#pragma once

#include "scene/run_options.h"

/// What the option --engine has said: a command, "later", or NULL for nothing.
struct engine_door mf_engine_door(const char *command);
