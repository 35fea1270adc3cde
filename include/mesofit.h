/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file mesofit: turn a measured structure or motion back into the interactions that cause it. */
#ifndef MESOFIT_H
#define MESOFIT_H

#include "mesofit/fit.h"
#include "mesofit/inversion.h"
#include "mesofit/optimiser.h"
#include "mesofit/result.h"
#include "mesofit/run.h"
#include "mesofit/simulation.h"

#define MESOFIT_VERSION "0.2.0"

#endif
