// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The terminal: its second screen, its size, its keys. ECMA-48 and xterm's control
/// sequences.
#pragma once

#include "base/status.h"

#include <termios.h>

struct watch_screen {
    struct termios before;
};

/// Go to the second screen, without a cursor and without echo. Fails: BAD_INPUT if stdin or stdout
/// is no terminal.
enum status mf_watch_screen_open(struct watch_screen *screen) MUST_USE;

/// Back to what was there.
void mf_watch_screen_close(const struct watch_screen *screen);

/// Characters across and down; 80 and 24 if the terminal does not say.
void mf_watch_screen_size(int *columns, int *rows);

/// A key, or 0 after so many milliseconds, or sooner if the size has changed or a signal came.
int mf_watch_screen_key(int milliseconds);
