// SPDX-License-Identifier: GPL-3.0-or-later
/// @file --live of commands that run something.
#pragma once

#include "app/command.h"

/// What the option takes, and what it does.
#define CMD_LIVE_OPTION                                                                            \
    { "--live", "[=PORT]", "show the run in a browser; the address is printed" }

/// Run a scene or run file beside a page.
/// @param[in] port  the option's value, or its name: any port
/// Fails: as the run; BAD_INPUT, IO as the server.
enum status mf_cmd_live_run(const char *file, const struct run_options *options,
                            const char *port) MUST_USE;
