// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/simulate_changes.h"

#include <stdio.h>

bool mf_simulate_changes_add(struct simulate_changes *changes,
                             const struct simulation_change *change) {
    const struct simulation_change *last = mf_simulate_changes_last(changes);
    const size_t place = last && last->step == change->step ? changes->count - 1 : changes->count;
    if (place == SIMULATE_CHANGES_MAX)
        return false;
    changes->change[place] = *change;
    changes->count = place + 1;
    return true;
}

const struct simulation_change *mf_simulate_changes_last(const struct simulate_changes *changes) {
    return changes->count > 0 ? &changes->change[changes->count - 1] : NULL;
}

void mf_simulate_changes_write(const struct simulate_changes *changes, struct json_writer *writer) {
    if (changes->count == 0)
        return;
    mf_json_begin_list(writer, "changed");
    for (size_t k = 0; k < changes->count; k++) {
        const struct simulation_change *change = &changes->change[k];
        mf_json_begin(writer, NULL);
        mf_json_write_integer(writer, "step", (int64_t)change->step);
        mf_json_write_quantity(writer, "temperature", "T_0", change->temperature);
        mf_json_write_quantity(writer, "time_step", "tau", change->time_step);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

void mf_simulate_changes_print(const struct simulate_changes *changes, const struct units *units,
                               struct progress *to) {
    const struct simulation_change *last = mf_simulate_changes_last(changes);
    char of_temperature[UNITS_NAME_SIZE], of_time[UNITS_NAME_SIZE];
    mf_progress_print(
        to, "after step %llu: temperature %.6g%s, time step %.6g%s; samples are reset",
        (unsigned long long)last->step, last->temperature * mf_units_factor(units, "T_0"),
        mf_units_suffix(units, "T_0", of_temperature),
        last->time_step * mf_units_factor(units, "tau"), mf_units_suffix(units, "tau", of_time));
}
