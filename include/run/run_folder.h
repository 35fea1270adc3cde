// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The folder that a run writes.
#pragma once

#include "base/status.h"
#include "io/output.h"
#include "system/composition.h"

#include <stdbool.h>
#include <stdint.h>

/// Options that all runs share, from the command line.
struct run_options {
    const char *folder; ///< -o, or NULL: `out` beside the input file
    int threads;
    bool has_threads; ///< they were asked for
    bool has_seed;
    uint64_t seed; ///< --seed, instead of the input file's
    bool quiet, resume;
};

struct run_folder {
    char path[OUTPUT_PATH_SIZE];
};

/// Choose and make the folder of a run of `input`. Results of an earlier run in it are removed
/// unless it is resumed, so that a folder never mixes two runs. Fails: IO.
enum status run_folder_open(struct run_folder *folder, const char *input,
                            const struct run_options *options) MUST_USE;

/// Path of a file in the folder, into `path` of OUTPUT_PATH_SIZE bytes.
void run_folder_file(const struct run_folder *folder, const char *name, char *path);

/// Path of the g(r) of a kind of pairs: rdf.tsv, or rdf_A-B.tsv in a mixture.
void run_folder_rdf(const struct run_folder *folder, const struct composition *composition,
                    int pair, char *path);

/// Draw the figures of the folder; what fails is a warning on stderr.
void run_folder_draw(const struct run_folder *folder);
