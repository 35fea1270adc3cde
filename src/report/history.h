// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The iterations of a fit: history.tsv, timing.tsv, and potential_history.tsv,
/// omega_history.tsv or numbers_history.tsv.
///
/// The seconds stand in a file of their own, since everything in history.tsv is the same bits for
/// any number of threads and any restart.
#pragma once

#include "base/spent.h"
#include "problem/unknowns.h"
#include "report/run_folder.h"

/// Since the fit began [s]: by the clock, and of processor time of the leading process.
struct history_time {
    double seconds, processor;
    struct spent spent; ///< by the last iteration also after it
};

struct history {
    size_t iterations, capacity;
    size_t extra;            ///< columns of the method's own
    size_t points[UNKNOWNS]; ///< of the curves; 0: not fitted
    double *rows;            ///< shape [room, 5 + extra]: iteration, evaluations, engine_steps, …
    struct history_time *times;            ///< shape [room]
    double *curve[UNKNOWNS];               ///< shape [room, points]
    const struct inverse_problem *problem; ///< whose numbers are found; borrowed
    double *numbers;                       ///< shape [room, 2 numbers]: value and error of each
};

void mf_history_init(struct history *history, const struct inverse_method *method,
                     const size_t points[UNKNOWNS], const struct inverse_problem *problem);
/// Error of the first iteration; NaN before it.
double mf_history_first_error(const struct history *history);

void mf_history_clear(struct history *history);

/// On the wall, up to the end of the last iteration: without a verification, through which
/// checkpoints go on.
double mf_history_seconds(const struct history *history);

/// Append an iteration. Fails: NO_MEMORY.
enum status mf_history_add(struct history *history, const struct inverse_step *step,
                           struct history_time time) MUST_USE;

/// What was spent after the last iteration, too, counts with it: write timing.tsv again. Fails: as
/// mf_history_write. Tested: test_fit.
enum status mf_history_close(struct history *history, struct spent spent,
                             const struct run_folder *folder) MUST_USE;

/// Write the tables in these units.
enum status mf_history_write(const struct history *history, const struct inverse_method *method,
                             const struct unknowns *unknowns, const struct units *units,
                             const struct run_folder *folder) MUST_USE;

/// Pieces for a checkpoint. The lengths of all but the first, the number of iterations, depend on
/// it: after it was restored there is to be made room.
enum { HISTORY_SPANS = 4 + UNKNOWNS };
size_t mf_history_spans(struct history *history, struct memory_span *spans);
enum status mf_history_reserve(struct history *history) MUST_USE;
