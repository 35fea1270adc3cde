// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What surrounds every call of the library.
#pragma once

#include "base/status.h"
#include "mesofit/status.h"

/// The locale of the thread is C while it is in here, whatever the process has: numbers have a
/// point in files, texts and messages. Threads that are begun in here take it over. It is that of
/// the caller again when the call returns. Tested: test_library_locale.
///
/// GSL ends the program of whoever calls it wrongly, or runs out of memory, unless its handler is
/// off; here its return codes are read. It is off while any call of the library runs, and after the
/// last one the handler is again the caller's. Tested: test_library.
void mf_guard_enter(void);
void mf_guard_leave(void);

/// Leave, and say `status` in the caller's words.
enum mesofit_status mf_guard_return(enum status status);
