/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file What the program does, done by the library: from words, files and memory to a folder.
 *
 *     static const char *const words[] = {"simulate", "scene", "-o", "out"};
 *     const struct mesofit_text text = {"scene", "{\"particles\": {\"count\": 3000}, …}"};
 *     const struct mesofit_inputs inputs = {.texts = &text, .text_count = 1};
 *     struct mesofit_run *run = mesofit_run_create();
 *     if (mesofit_run_words(run, 4, words, &inputs) == MESOFIT_OK) …  // mesofit/result.h
 *
 * Results have the same bits as the program's. Figures are drawn by the program alone
 * (`mesofit plot DIR`). Several runs may be carried out at the same time, each by one thread.
 */
#ifndef MESOFIT_RUN_H
#define MESOFIT_RUN_H

#include "mesofit/status.h"
#include "mesofit/table.h"

#include <stddef.h>
#include <stdint.h>

/** One piece of work, and what it says of itself. */
struct mesofit_run;

/** NULL without memory. */
MESOFIT_API struct mesofit_run *mesofit_run_create(void);
MESOFIT_API void mesofit_run_free(struct mesofit_run *run);

/** A text that stands for a file of this name. */
struct mesofit_text {
    const char *name, *text;
};

/** A frame of the caller's, in the units of its trajectory. */
struct mesofit_frame {
    double time;             /**< NaN: not known */
    double box[9];           /**< its vectors a, b, c, one behind the other; zeros: there is none */
    const double *positions; /**< shape [atoms, 3] */
    const double *velocities; /**< the same, or NULL */
    const double *forces;     /**< the same [kJ/mol by the unit of length], or NULL */
};

/** Fill in frame `number`, whose arrays must stay until the next call. Called by the thread that
 *  carries out the run, with 0 twice and then with 1, 2, …; if `frames` is known, perhaps once more
 *  from 0 on. @return 1; 0 behind the last frame; below 0 if it failed, which ends the run with
 *  INTERRUPTED, without results. */
typedef int mesofit_frame_reader(void *context, size_t number, struct mesofit_frame *frame);

/** Frames that stand for a trajectory of this name. */
struct mesofit_trajectory {
    const char *name;
    size_t atoms;
    size_t frames;            /**< 0: not known, and each can be had once */
    double length, time;      /**< what 1 is [nm], [ps] */
    const char *const *names; /**< shape [atoms] */
    /** Shape [atoms] each, both or neither; runs of the same are one residue. NULL: each atom is a
     *  residue, and so a bead, called by its name. */
    const char *const *residue_names;
    const int64_t *residues;
    const double *masses; /**< shape [atoms] [u], NaN: not known; or NULL */
    mesofit_frame_reader *read;
    void *context;
};

/** An observable of the caller's, asked at each sample of "simulate" by the thread that carries out
 *  the run. All is in the units of the scene, by the number of the particle.
 *  @param position  in the box, from 0 to its edges; shape [count, dimensions] [nm in nm and ps,
 *                   lambda without units]
 *  @param velocity  at the end of the step; shape [count, dimensions] [nm/ps; lambda/tau]; NULL for
 * Monte Carlo, which has none
 *  @param type      shape [count]: 0, 1, … in the order of the scene's types
 *  @param edge      of the box, shape [dimensions] [as positions]
 *  @param[out] values  shape [room]
 *  @return how many values it has, the same in every sample. If there are more than `room` none
 *  need be written: it is asked once more for the same sample, with room enough. Below 0 if it
 *  failed: the run ends with BAD_INPUT and without results, and can be resumed from its last
 *  checkpoint. */
typedef ptrdiff_t mesofit_observable(void *context, size_t count, int dimensions,
                                     const double *position, const double *velocity,
                                     const int32_t *type, const double *edge, size_t room,
                                     double *values);

/** An observable with the name of its table, of letters, digits, "_" and "-": rows of "index",
 *  "value", the mean over the samples (NaN if one was not finite), and "error", its standard error,
 *  which sees that samples are correlated. */
struct mesofit_named_observable {
    const char *name;
    mesofit_observable *function;
    void *context;
};

/** What stands for files of these names, in the words and in what they name, and what a simulation
 *  measures besides. Borrowed for the call that gets it. */
struct mesofit_inputs {
    const struct mesofit_text *texts; /**< shape [text_count] */
    size_t text_count;
    const struct mesofit_table *tables; /**< shape [table_count] */
    size_t table_count;
    const struct mesofit_trajectory *trajectory;        /**< or NULL */
    const struct mesofit_named_observable *observables; /**< shape [observable_count], at most 16 */
    size_t observable_count;
};

/** Do what the program does with these words: "measure", "fit", "simulate" or "export", then files
 *  and options as `mesofit --help` lists them, without --live and --explain. All but export need
 *  -o, unless the default folder is wanted.
 *  @param inputs  or NULL
 *  Fails as the program: BAD_INPUT, IO, NO_MEMORY, UNSTABLE; UNCONVERGED and INTERRUPTED with what
 *  there is in the folder. */
MESOFIT_API enum mesofit_status mesofit_run_words(struct mesofit_run *run, size_t count,
                                                  const char *const *words,
                                                  const struct mesofit_inputs *inputs);

/** @name From any thread, while it is carried out or after */

/** End it at the next safe place, as Ctrl-C ends the program: INTERRUPTED. Also from a handler of a
 *  signal. */
MESOFIT_API void mesofit_run_stop(struct mesofit_run *run);

/** How far it is. */
struct mesofit_run_progress {
    uint64_t done, total; /**< total = 0: nothing has been told yet */
    double rate;          /**< parts a second; NaN: not known */
    int open;             /**< nobody knows how much there is still to be done */
    char unit[16];        /**< of what is counted, such as "steps" */
    char text[160];       /**< what else there is to say */
};

MESOFIT_API void mesofit_run_progress(struct mesofit_run *run,
                                      struct mesofit_run_progress *progress);

/** Line `number`, from 0 on, of what the program would say on stderr; NULL: not yet. Those that
 *  begin with "mesofit: warning: " are warnings. It stays until the run is freed. */
MESOFIT_API const char *mesofit_run_line(struct mesofit_run *run, size_t number);

#endif
