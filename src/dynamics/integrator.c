// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/integrator.h"

const struct integrator *const integrator_list[] = {&velocity_verlet, &dpd_verlet, &dpd_vv,
                                                    &shardlow,        &aboba,      &aboba_implicit,
                                                    &lowe_andersen,   NULL};
