// SPDX-License-Identifier: GPL-3.0-or-later
#include "pair_search_loop.h"

PAIR_SEARCH_INSTANCE(mf_pair_search_portable)
