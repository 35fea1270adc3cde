// SPDX-License-Identifier: GPL-3.0-or-later
#define LANES_DOUBLE
#include "pair_loop.h"

PAIR_INSTANCES(mf_pair_portable_double)
