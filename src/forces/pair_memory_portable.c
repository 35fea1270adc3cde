// SPDX-License-Identifier: GPL-3.0-or-later
#include "pair_memory_loop.h"

PAIR_MEMORY_INSTANCES(mf_pair_memory_portable)
