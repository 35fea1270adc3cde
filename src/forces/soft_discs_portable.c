// SPDX-License-Identifier: GPL-3.0-or-later
#include "soft_discs_loop.h"

SOFT_DISCS_INSTANCES(mf_soft_discs_portable)
