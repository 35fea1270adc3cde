// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_reserve.h"

#include "io/configuration.h"
#include "observe/rdf_observable.h"

#include <stdio.h>

static enum status reserve(struct run_folder *folder, const char *inside, const char *name,
                           const char *of, const char *ending) {
    char whole[OUTPUT_PATH_SIZE];
    snprintf(whole, sizeof whole, "%.3000s%.200s%s%.200s%s", inside, name, of[0] ? "_" : "", of,
             ending);
    return mf_run_folder_reserve(folder, whole);
}

static enum status reserve_pairs(struct run_folder *folder, const char *inside,
                                 const struct fit_file *state, int kind, size_t pairs) {
    for (size_t pair = 0; pair < pairs; pair++) {
        char of[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(&state->files.composition, (int)pair, of);
        TRY(reserve(folder, inside, mf_targets_name(kind), of, ".tsv"));
    }
    return STATUS_OK;
}

static enum status reserve_groups(struct run_folder *folder, const char *inside,
                                  const struct target_groups *groups) {
    for (size_t g = 0; g < groups->groups; g++) {
        const char *name = mf_targets_name(mf_bonded_distribution_kind(groups->order));
        if (groups->member[g].bins.count > 0)
            TRY(reserve(folder, inside, name, groups->name[g], ".tsv"));
    }
    return STATUS_OK;
}

enum status mf_fit_reserve_observables(const struct fit_file *state, const char *inside,
                                       struct run_folder *folder) {
    const struct target_files *files = &state->files;
    TRY(reserve_pairs(folder, inside, state, TARGET_RDF, files->rdf.pairs));
    TRY(reserve_pairs(folder, inside, state, mf_rdf_intermolecular_kind(), files->apart.pairs));
    if (files->given[TARGET_ETD])
        TRY(reserve(folder, inside, "etd_cells", "", ".tsv"));
    for (int order = 0; order < BONDED_KINDS; order++)
        TRY(reserve_groups(folder, inside, &files->groups[order]));
    for (int kind = 0; kind < TARGETS; kind++)
        if (files->curve[kind].points > 0)
            TRY(reserve(folder, inside, mf_targets_name(kind), "", ".tsv"));
    return reserve(folder, inside, CONFIGURATION_FILE, "", "");
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
                TRY(reserve(folder, "", name, "", endings[k]));
        }
    return STATUS_OK;
}
