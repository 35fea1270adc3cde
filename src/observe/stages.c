// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/stages.h"

#include <stdarg.h>
#include <stdio.h>

const struct stages_cost mf_stages_cost = {.sort = 28, .build = 0.9, .go_through = 0.7};

void mf_stages_add(struct stages *stages, const char *name, bool on, double nanoseconds,
                   const char *format, ...) {
    if (stages->count == STAGES_MAX)
        return;
    struct stage *stage = &stages->stage[stages->count++];
    *stage = (struct stage){.name = name, .on = on, .nanoseconds = on ? nanoseconds : 0};
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(stage->why, sizeof stage->why, format, arguments);
    va_end(arguments);
}

const char *mf_stages_length(const struct stages *stages, double length, int digits,
                             char text[STAGES_LENGTH_SIZE]) {
    char unit[UNITS_NAME_SIZE];
    snprintf(text, STAGES_LENGTH_SIZE, "%.*g%.32s", digits,
             mf_units_factor(stages->units, "lambda") * length,
             mf_units_suffix(stages->units, "lambda", unit));
    return text;
}

double mf_stages_pairs_within(const struct simulation_setup *setup, double r) {
    const double density = (double)setup->placement.count / mf_box_volume(&setup->box);
    return density * mf_box_shell_volume(&setup->box, 0, r) / 2;
}

double mf_stages_cutoff(const struct simulation_setup *setup) {
    const struct pair_law law = {.potential = setup->potential, .omega = setup->omega};
    return mf_pair_cutoff(&law);
}
