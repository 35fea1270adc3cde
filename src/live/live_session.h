// SPDX-License-Identifier: GPL-3.0-or-later
/// @file `mesofit live`, and --live of other commands: runs beside a server for one page.
#pragma once

#include "scene/run_options.h"
#include "base/status.h"

#include <stdbool.h>

struct live_options {
    const char *subject;    ///< a scene, a run file, a folder of results; NULL: the page chooses
    struct run_options run; ///< for every run
    const char *topics;     ///< JSON of all topics with their fields, for the page
    bool start;             ///< the subject, a file, begins at once
    bool stay;              ///< serve on after the end of its run
    int port;               ///< 0: any
};

/// Print the address of the page on stdout, serve it, and run what it asks for. It ends with the
/// run of the subject unless it stays, and with Ctrl-C.
/// Fails: as the server; as the run with which it ends. Tested: test_live.
enum status mf_live_session(const struct live_options *options) MUST_USE;
