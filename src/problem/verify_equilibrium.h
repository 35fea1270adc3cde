// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Whether the simulations of a verification are those of equilibrium: their energy, their
/// pressure and their g(r), by observe/stationary.h.
#pragma once

#include "problem/measurement.h"

enum { VERIFY_EQUILIBRIUM_SIZE = 160 };

/// Say what is not, into `text`; "" if all is, or if there is one replica. Of samples in
/// equilibrium one of a thousand is reported. Fails: NO_MEMORY. Tested: test_verify_equilibrium.
enum status mf_verify_equilibrium(const struct measurement *replicas, size_t count,
                                  char text[VERIFY_EQUILIBRIUM_SIZE]) MUST_USE;
