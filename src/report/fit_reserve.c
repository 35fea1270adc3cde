// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_reserve.h"

#include "io/configuration.h"

#include <stdio.h>

static enum status reserve(struct run_folder *folder, const char *inside, const char *name,
                           const char *ending) {
    char whole[OUTPUT_PATH_SIZE];
    snprintf(whole, sizeof whole, "%.3000s%.200s%s", inside, name, ending);
    return mf_run_folder_reserve(folder, whole);
}

enum status mf_fit_reserve_observables(const struct fit_file *state, const char *inside,
                                       struct run_folder *folder) {
    struct target_table table;
    for (int kind = 0; mf_targets_name(kind); kind++)
        for (size_t n = 0; mf_target_files_table(&state->files, kind, n, &table); n++)
            if (table.count > 0)
                TRY(reserve(folder, inside, table.name, ".tsv"));
    return reserve(folder, inside, CONFIGURATION_FILE, "");
}

enum status mf_fit_reserve_curves(const struct fit_file *fit, const struct unknowns *unknowns,
                                  struct run_folder *folder) {
    static const char *const endings[] = {".tsv", "_history.tsv", ".pot"};
    TRY(mf_run_folder_reserve(folder, "history.tsv"));
    TRY(mf_run_folder_reserve(folder, "timing.tsv"));
    TRY(mf_run_folder_reserve(folder, "tasks.tsv"));
    if (fit->problem.numbers > 0)
        TRY(mf_run_folder_reserve(folder, "numbers_history.tsv"));
    for (int kind = 0; kind < UNKNOWNS; kind++)
        for (size_t curve = 0; mf_unknowns_points(unknowns, kind) > 0 &&
                               curve < mf_unknowns_curve_count(unknowns, kind);
             curve++) {
            char name[UNKNOWNS_NAME_SIZE];
            mf_unknowns_curve_name(unknowns, kind, curve, name);
            const bool votca = kind == UNKNOWN_POTENTIAL && mf_units_known(&fit->scene.units);
            for (int k = 0; k < (votca ? 3 : 2); k++)
                TRY(reserve(folder, "", name, endings[k]));
        }
    return STATUS_OK;
}
