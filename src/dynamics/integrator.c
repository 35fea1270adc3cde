// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/integrator.h"

#define INTEGRATOR_LIST(record) &record,
const struct integrator *const mf_integrator_list[] = {INTEGRATORS(INTEGRATOR_LIST) NULL};
