/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file An inversion whose samples are the caller's: ask for them, and tell them.
 *
 *     struct mesofit_inversion *inversion = mesofit_inversion_open("run.json", "out", 0);
 *     while (inversion && mesofit_inversion_pieces(inversion) > 0) {
 *         for (size_t n = 0; n < mesofit_inversion_pieces(inversion); n++)
 *             …                                              // sample piece n, and tell it
 *         if (mesofit_inversion_go_on(inversion) != MESOFIT_OK) …
 *     }
 *     struct mesofit_result *result = mesofit_result_open("out");    // mesofit/result.h
 *
 * The run file has "engine": {"name": "command", "frames": "frames.extxyz"}; its other keys are
 * those of any fit. All pieces of a round may be sampled side by side. All that was told is in the
 * folder: it is what is saved between two jobs, and another process goes on from there. Numbers are
 * in the units of the run file, λ and k_B T_0 without "units".
 */
#ifndef MESOFIT_INVERSION_H
#define MESOFIT_INVERSION_H

#include "mesofit/result.h"

#include <stdint.h>

struct mesofit_inversion;

/** Begin an inversion, or go on with what a process before has left.
 *  @param run     the run file
 *  @param folder  of its results; it must not be there yet
 *  @param resume  1: it is, and the inversion goes on
 *  NULL on failure: as mesofit_run_words. */
MESOFIT_API struct mesofit_inversion *mesofit_inversion_open(const char *run, const char *folder,
                                                             int resume);
MESOFIT_API void mesofit_inversion_free(struct mesofit_inversion *inversion);

/** How many pieces of samples are asked for now; 0: the inversion has ended. */
MESOFIT_API size_t mesofit_inversion_pieces(const struct mesofit_inversion *inversion);

/** Samples that a replica asks for: frames of the canonical ensemble of the potentials and of all
 *  else that the caller knows. */
struct mesofit_piece {
    const char *folder; /**< for the caller's files, too */
    const char *before; /**< folder of the piece from whose last configuration this one goes on;
                             NULL: it begins anew */
    int64_t replica;    /**< from 1 on */
    int64_t seed;       /**< another for each piece */
    double temperature; /**< [K; T_0] */
    int dimensions;
    double box[3];         /**< edges [nm; angstrom; lambda] */
    int64_t equilibration; /**< time steps before the first frame */
    int64_t frames;
    int64_t every; /**< time steps from frame to frame */
    size_t beads;
    const int *type; /**< shape [beads]: 0, 1, … in the order of the scene's types */
};

/** Piece `number`, from 0 on; NULL: there are not so many. It stays until
 *  mesofit_inversion_go_on. */
MESOFIT_API const struct mesofit_piece *
mesofit_inversion_piece(const struct mesofit_inversion *inversion, size_t number);

/** Its potentials, as tables "potential", or of a mixture "potential_A-B" and so on, with the
 *  columns r, phi and force, their units and 2000 rows (mesofit_result_table). To be freed. NULL on
 *  failure: as mesofit_result_open. */
MESOFIT_API struct mesofit_result *
mesofit_inversion_potentials(const struct mesofit_inversion *inversion, size_t number);

/** The samples of a piece. */
struct mesofit_samples {
    const double *positions; /**< shape [frames, beads, dimensions], beads in the order of their
                                  types [nm; angstrom; lambda] */
    const double *boxes; /**< shape [frames, dimensions], of constant pressure; NULL: as asked */
    /** Shape [frames] each, what is known of a frame besides; NULL: nothing is. */
    const double *pressure, *temperature, *pair_energy;
};

/** Fails: BAD_INPUT for a number that is none; IO. Positions that are in another unit are noticed
 * when the inversion goes on. */
MESOFIT_API enum mesofit_status mesofit_inversion_tell(struct mesofit_inversion *inversion,
                                                       size_t number,
                                                       const struct mesofit_samples *samples);

/** Take what was told, and find out what is asked for next: what was not told is asked for again.
 *  Fails: as mesofit_run_words; UNCONVERGED in the end of a fit that has not converged. */
MESOFIT_API enum mesofit_status mesofit_inversion_go_on(struct mesofit_inversion *inversion);

#endif
