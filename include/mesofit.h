// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The version of the library and the program.
#pragma once

#define MESOFIT_VERSION "0.1.0"
