// SPDX-License-Identifier: GPL-3.0-or-later
#include "inverse/inverse.h"

const struct inverse_method *const inverse_methods[] = {&imc, &matching, NULL};
