// SPDX-License-Identifier: GPL-3.0-or-later
#include "forces/interaction.h"

#define INTERACTION_LIST(record) &record,
const struct interaction *const mf_interaction_list[] = {INTERACTIONS(INTERACTION_LIST) NULL};

enum status mf_interaction_no_laplacian(const void *parameters, void *state,
                                        const struct interaction_pass *pass, double *sum) {
    (void)parameters, (void)state, (void)pass, (void)sum;
    return STATUS_OK;
}
