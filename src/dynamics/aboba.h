// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Parameters of the integrator aboba-implicit.
#pragma once

struct aboba_parameters {
    double tolerance; ///< of the implicit friction, relative to what it changes
};
