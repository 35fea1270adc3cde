// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The user's wish to stop (Ctrl-C), seen by every long loop.
#pragma once

#include <stdbool.h>

/// Catch SIGINT and SIGTERM from now on; a second one ends the program at once.
void interrupt_install(void);

/// True once the user has asked to stop. Any thread may ask, as often as it likes.
bool interrupt_requested(void);
