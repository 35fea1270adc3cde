// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/version.h"

const char mf_version[] = MESOFIT_BUILD;
