// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/frame_waves.h"

#include "base/memory.h"

#include <math.h>

static const double turn = 2 * 3.14159265358979323846;

static enum status begin(struct frame_waves *waves, const struct density_waves_plan *plan) {
    if (waves->numbers)
        return STATUS_OK;
    TRY(mf_density_waves_init(&waves->waves, plan));
    TRY_ARRAY(waves->numbers, (waves->waves.curves + 2) * plan->bins);
    return STATUS_OK;
}

void mf_frame_waves_clear(struct frame_waves *waves) {
    mf_density_waves_clear(&waves->waves);
    mf_memory_free(waves->numbers);
    *waves = (struct frame_waves){0};
}

static void report_angle(const void *context, size_t bead, double angle[3]) {
    int32_t *const *const place = context;
    for (int i = 0; i < 3; i++)
        angle[i] = turn * 0x1p-32 * place[i][bead];
}

enum status mf_frame_waves_find(struct frame_waves *waves, const struct density_waves_plan *plan,
                                const struct frame_box *box, int32_t *const place[3]) {
    const struct density_angles angles = {report_angle, place};
    double lattice[3][3], length[3];
    for (int i = 0; i < 3; i++) {
        length[i] = hypot(box->edge[i][0], hypot(box->edge[i][1], box->edge[i][2]));
        for (int d = 0; d < 3; d++)
            lattice[i][d] = turn * box->inverse[i][d];
    }
    TRY(begin(waves, plan));
    TRY(mf_density_waves_list(&waves->waves, lattice, length));
    mf_density_waves_find(&waves->waves, &angles, 1);
    mf_structure_factor_take(&waves->waves, waves->numbers);
    return STATUS_OK;
}
