// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Faults of one input, collected in the order found and reported together.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

enum {
    FAULTS_REPORTED = 20, ///< more than that have one cause, not twenty
    FAULTS_SIZE = 8000,   ///< below the size of a status message, with room for "… and 99 more"
};

/// Start from {0}. Nothing to free.
struct faults {
    size_t count, reported;
    bool full;
    size_t length;
    char text[FAULTS_SIZE]; ///< a line for each reported fault
};

/// Add one line, unless it was reported already. After FAULTS_REPORTED lines, or when the text is
/// full, faults are only counted.
void mf_faults_add(struct faults *faults, const char *line);

/// Take back the line that begins with these words, if there is one: another explains it.
void mf_faults_take_back(struct faults *faults, const char *words);

/// OK if there are none; otherwise BAD_INPUT with all lines and how many were left out.
enum status mf_faults_status(const struct faults *faults) MUST_USE;
