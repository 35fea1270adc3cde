// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_damping.h"

bool mf_fit_damping_ask(struct fit_dampings *changes, uint64_t iteration, double *damping,
                        struct progress *progress) {
    double wanted;
    if (damping == NULL || !mf_progress_ask_damping(progress, &wanted) || wanted == *damping)
        return false;
    const bool again =
        changes->count > 0 && changes->change[changes->count - 1].iteration == iteration;
    if (changes->count == FIT_DAMPINGS_MAX && !again) {
        mf_progress_print(progress, "mesofit: warning: the damping was changed %d times; it stays",
                          FIT_DAMPINGS_MAX);
        return false;
    }
    changes->count += !again;
    changes->change[changes->count - 1] = (struct fit_damping){iteration, wanted};
    *damping = wanted;
    mf_progress_print(progress, "from iteration %llu on: damping %.6g",
                      (unsigned long long)iteration, wanted);
    return true;
}

void mf_fit_damping_write(const struct fit_dampings *changes, struct json_writer *writer) {
    if (changes->count == 0)
        return;
    mf_json_begin_list(writer, "changed");
    for (size_t k = 0; k < changes->count; k++) {
        mf_json_begin(writer, NULL);
        mf_json_write_integer(writer, "iteration", (int64_t)changes->change[k].iteration);
        mf_json_write_number(writer, "damping", changes->change[k].damping);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}
