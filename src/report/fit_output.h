// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What a fit writes besides its history.
#pragma once

#include "io/json_write.h"
#include "report/progress.h"
#include "problem/unknowns.h"
#include "defaults/fit_file.h"
#include "report/run_folder.h"

#include <stdint.h>

/// The result of a fit so far.
struct fit_result {
    enum status status; ///< OK: converged, or exhausted; UNCONVERGED; INTERRUPTED
    /// The last one. Its curves are there where they are fitted, their errors may hold NaN, not
    /// known, and its formula may be "".
    struct inverse_step step;
    double seconds;                          ///< of the fit, without its verification
    const double *first[UNKNOWNS];           ///< the curve of the first iteration; NULL: none yet
    double first_error;                      ///< of that, as the method measured it
    const char *reason;                      ///< why it has not converged, or settled, or ""
    const struct fit_dampings *changes;      ///< by a person, while it ran
    const struct verification *verification; ///< of each state; NULL if there was none
};

/// potential.tsv and omega.tsv, what of them was fitted.
enum status mf_fit_output_curves(const struct fit_file *fit, const struct unknowns *unknowns,
                                 const struct fit_result *result,
                                 const struct run_folder *folder) MUST_USE;

/// From the verification of one state: rdf.tsv, etd.tsv and motion.tsv, as far as there are
/// targets.
enum status mf_fit_output_observables(const struct fit_file *fit,
                                      const struct verification *verification,
                                      const struct run_folder *folder) MUST_USE;

/// summary.json.
enum status mf_fit_output_summary(const struct fit_file *fit, const struct unknowns *unknowns,
                                  const struct fit_result *result,
                                  const struct run_folder *folder) MUST_USE;

/// The tables of the verification of one state, as mf_fit_output_observables writes them.
/// @param[in] inside  the state's folder in that of the fit, with / at its end, or ""
/// Fails: as mf_run_folder_reserve.
enum status mf_fit_reserve_observables(const struct fit_file *state, const char *inside,
                                       struct run_folder *folder) MUST_USE;

/// The tables of curves and iterations, as mf_fit_output_curves and mf_history_write write them.
/// Fails: as mf_run_folder_reserve.
enum status mf_fit_reserve_curves(const struct fit_file *fit, const struct unknowns *unknowns,
                                  struct run_folder *folder) MUST_USE;

// What a person has changed of a fit while it ran -------------------------------------------------

enum { FIT_DAMPINGS_MAX = 256 };

/// The damping of an inversion from an iteration on; plain data, which a checkpoint keeps.
struct fit_dampings {
    uint64_t count;
    struct fit_damping {
        uint64_t iteration; ///< the first whose step has it
        double damping;
    } change[FIT_DAMPINGS_MAX];
};

/// Ask who watches before an iteration, keep what is new, and say it: of one iteration the last
/// wish counts. Whether anything has changed.
/// @param[in,out] damping  of the method, or NULL: it has none
bool mf_fit_damping_ask(struct fit_dampings *changes, uint64_t iteration, double *damping,
                        struct progress *progress);
