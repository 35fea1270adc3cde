// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A transport coefficient from what has flowed in equal intervals of time.
///
/// With x_n what has flowed in the interval n, of several components that fluctuate alike,
///   I(k) = ½ ⟨x_0 x_0⟩ + Σ_{n=1…k} ⟨x_0 x_n⟩
/// is half the slope of ⟨(x_1 + … + x_k)²⟩ with k: Green and Kubo's integral in the form of E.
/// Helfand, Phys. Rev. 119, 1 (1960), exact for any length of the intervals, also with noise whose
/// autocorrelation is a delta function.
///
/// I(k) comes to rest, and its noise grows with k. Of the windows T, T/2, T/4, … from the second
/// half of each of which I has a mean, the error of one has three parts: its own noise; that of
/// what the next doubling adds, in which as much may hide; and the largest difference from a longer
/// window, by which it may be too short. Error is so weighed against bias as A. Goldenshluger and
/// O. Lepski do, Ann. Stat. 39, 1608 (2011), in place of the threshold by eye of Y. Zhang, A. Otani
/// and E. J. Maginn, J. Chem. Theory Comput. 11, 3537 (2015). Taken is the longest window whose
/// error is at most a quarter above the least. Of white noise, decays with one time and those with
/// two or three, whose last one has a third of the integral, the values lie 0.8 to 1.2 of their
/// errors from the truth (rms), and at most a tenth of them are of the whole of T, if that is five
/// times as long as the flow remembers. Errors are of blocks of time.
#pragma once

#include "base/memory.h"
#include "base/status.h"

#include <stdbool.h>

enum { GREEN_KUBO_MAX_COMPONENTS = 6, GREEN_KUBO_SPANS = 3 };

struct green_kubo {
    size_t lags, components;
    size_t blocks, each; ///< of origins, for the errors
    size_t samples;
    double *last;     ///< shape [lags + 1, components]: the last samples, one after the other
    double *products; ///< shape [blocks, lags + 1]: Σ over origins of the mean product
};

/// Prepare for `samples` intervals. Fails: BAD_INPUT if they are fewer than twice the lags;
/// NO_MEMORY.
enum status mf_green_kubo_init(struct green_kubo *green_kubo, size_t lags, size_t components,
                               size_t samples) MUST_USE;
void mf_green_kubo_clear(struct green_kubo *green_kubo);

/// @param[in] flow  shape [components]
void mf_green_kubo_add(struct green_kubo *green_kubo, const double *flow);

size_t mf_green_kubo_spans(struct green_kubo *green_kubo, struct memory_span *spans);

/// Curves of lags + 1 numbers: I(k) of the intervals up to k, and ⟨x_0 x_k⟩.
struct green_kubo_curves {
    double *integral, *integral_error;
    double *correlation, *correlation_error;
};

struct green_kubo_summary {
    double value, error;
    size_t window; ///< the one that was taken, in intervals
    bool reached;  ///< windows agree, or the longest with the one before within two errors
    double blocks; ///< complete
};

/// `curves` may be NULL. NaN without a complete block. Tested: test_green_kubo.
struct green_kubo_summary mf_green_kubo_result(const struct green_kubo *green_kubo,
                                               const struct green_kubo_curves *curves);
