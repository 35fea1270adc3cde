// SPDX-License-Identifier: GPL-3.0-or-later
#include "move_loop.h"

MOVE_INSTANCES(move_portable)
