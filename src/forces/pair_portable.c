// SPDX-License-Identifier: GPL-3.0-or-later
#include "pair_loop.h"

PAIR_INSTANCES(mf_pair_portable)
