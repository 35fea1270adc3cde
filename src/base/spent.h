// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What the processor time of a fit goes to. As all that a clock says, it steers nothing.
#pragma once

enum spent_on {
    SPENT_EQUILIBRATION, ///< simulating what is not counted
    SPENT_SAMPLES,       ///< simulating what is
    SPENT_LOST,          ///< samples that then did not count
    SPENT_ALGEBRA,       ///< what an inversion makes of its samples
    SPENT_VERIFICATION,
    SPENT_FIGURES, ///< by the programs that draw them
    SPENT_ENGINE,  ///< by another engine that samples
    SPENT_KINDS
};

/// Processor time of each kind [s].
struct spent {
    double seconds[SPENT_KINDS];
};

/// What this process has spent since it began.
struct spent mf_spent(void);

/// What was spent less another amount.
struct spent mf_spent_less(struct spent spent, struct spent less);

/// Several threads may add at once.
void mf_spent_add(enum spent_on kind, double seconds);

/// Samples that have taken so long [s] do not count any more.
void mf_spent_lose(double seconds);
