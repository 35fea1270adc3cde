// SPDX-License-Identifier: GPL-3.0-or-later
#include "move_loop.h"

MOVE_INSTANCES(mf_move_portable)
