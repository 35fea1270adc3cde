// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A loop that owns its measurements, turned inside out: it runs in a thread of its own and
/// stops at each measurement until somebody brings the answer.
///
/// The two threads take turns, so no data is ever seen by both at once.
#pragma once

#include "base/status.h"

#include <stdbool.h>

struct coroutine;

/// Begin `body`, which calls mf_coroutine_measure as often as it likes and returns.
/// @return NULL if there is no memory or no thread; the message is set. End it by mf_coroutine_end.
struct coroutine *mf_coroutine_begin(void (*body)(struct coroutine *self, void *context),
                                     void *context) MUST_USE;

/// Wait until the body asks.
/// @return what it gave mf_coroutine_measure, valid until the answer; NULL if it has returned.
const double *mf_coroutine_question(struct coroutine *coroutine);

/// Answer a question, so that the body goes on.
void mf_coroutine_answer(struct coroutine *coroutine, double answer);

/// Stop the body wherever it is, and free everything; NULL is allowed.
void mf_coroutine_end(struct coroutine *coroutine);

/// From inside the body: the answer to a question. false, and at once for ever after, when the body
/// is to return.
bool mf_coroutine_measure(struct coroutine *self, const double *question, double *answer) MUST_USE;
