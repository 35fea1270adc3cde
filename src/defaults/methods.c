// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/methods.h"

#define METHOD(name) &mf_##name,
#define METHOD_OPTIMISER(record, name, summary) &mf_matching_##record,
const struct inverse_method *const mf_methods[] = {INVERSIONS(METHOD) MATCHINGS(METHOD) NULL};
