// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The lock of what all runs of a process share.
///
/// A process may fork while one of its threads is in here. Its child has that lock, but not the
/// thread: nobody would ever open it. So a fork waits until it is free, and the child has it free.
/// What belongs to one run alone has a lock of its own, which no child ever wants. Tested:
/// test_process_lock.
#pragma once

void mf_process_lock(void);
void mf_process_unlock(void);
