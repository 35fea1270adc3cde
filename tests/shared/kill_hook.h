// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Kill the program at one of its steps on the disk: KILL_HOOK is the library that does so
/// (tests/stress/hooks/kill_at.c).
#pragma once

/// Programs that are started from now on are killed before their step number `at` (counted from 1),
/// or after it if it is negative; 0: no more. Without KILL_HOOK the test fails.
void kill_hook_set(int at);
