// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/integrator.h"

const struct integrator *const mf_integrator_list[] = {
    &mf_velocity_verlet, &mf_dpd_verlet,     &mf_dpd_vv,        &mf_shardlow,
    &mf_aboba,           &mf_aboba_implicit, &mf_lowe_andersen, NULL};
