// SPDX-License-Identifier: GPL-3.0-or-later
#include "close_loop.h"

CLOSE_INSTANCE(mf_close_portable)
