// SPDX-License-Identifier: GPL-3.0-or-later
/// @file --live of commands that run something.
#pragma once

#include "app/commands.h"

/// What --live does.
enum status mf_cmd_live_run(const char *file, const struct run_options *options,
                            const char *port) MUST_USE;
