// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The whole reference: every subcommand with its options, every key of run and scene files.
///
/// It is made of the records of the subcommands and of what `mesofit describe` knows, so that
/// docs/reference.md and the man page say what the program does. Tested: test_reference.
#pragma once

#include "app/cmd_describe.h"

#include <stdio.h>

void mf_reference_print_markdown(FILE *stream, const struct topic *topics, size_t count);
void mf_reference_print_man(FILE *stream, const struct topic *topics, size_t count);
