// SPDX-License-Identifier: GPL-3.0-or-later
#include "many_body_loop.h"

MANY_BODY_INSTANCES(mf_many_body_portable)
