// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/interaction.h"

#define INTERACTION_LIST(record) &record,
const struct interaction *const mf_interaction_list[] = {INTERACTIONS(INTERACTION_LIST) NULL};
