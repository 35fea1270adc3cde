// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Kirkwood and Buff's integrals as an observable and a target.
#pragma once

#include "observe/observable.h"

struct kirkwood_buff_settings {
    double q_maximum; ///< of the waves [1/λ]; 0: mf_kirkwood_buff_waves_init chooses
};

extern const struct field mf_kirkwood_buff_observable_fields[]; ///< of the settings
extern const struct observable mf_kirkwood_buff_observable;

/// Add a value and its error of a pair of components to a summary, as "kirkwood_buff_A-B" and
/// "kirkwood_buff_error_A-B"; without types "kirkwood_buff" and "kirkwood_buff_error". What is not
/// known is left out.
/// @param[in] what  "kirkwood_buff", or what begins so
void mf_kirkwood_buff_write(struct json_writer *writer, const char *what,
                            const struct composition *components, size_t pair, double value,
                            double error);

/// Its target's number (mf_observable_kind): one value a pair of components, in their order.
int mf_kirkwood_buff_kind(void);
