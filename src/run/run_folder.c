// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/run_folder.h"

#include "run/figures.h"

#include <dirent.h>
#include <errno.h>
#include <fnmatch.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *const results[] = {
    "summary.json",
    "history.tsv",
    "timing.tsv",
    "potential.tsv",
    "potential_history.tsv",
    "potential_flat.tsv",
    "weight_flat.tsv",
    "potential.pot",
    "rdf.tsv",
    "thermodynamics.tsv",
    "motion.tsv",
    "etd.tsv",
    "etd_error.tsv",
    "etd_bins.tsv",
    "force_covariance.tsv",
    "omega.tsv",
    "checkpoint.bin",
    "weight_history.tsv",
    "etd_cells.tsv",
    "vacf.tsv",
    "msd.tsv",
    "pareto.tsv",
    "pareto_history.tsv",
    "pareto_potential.tsv",
    "pareto_weight.tsv",
};

/// Tables about the kinds of pairs of a mixture, which its file names.
static const char *const partial_results[] = {"rdf_*-*.tsv", "potential_*-*.tsv",
                                              "potential_*-*.pot", "pareto_potential_*-*.tsv"};

static int is_partial_result(const struct dirent *entry) {
    for (size_t k = 0; k < sizeof partial_results / sizeof *partial_results; k++)
        if (fnmatch(partial_results[k], entry->d_name, 0) == 0)
            return 1;
    return 0;
}

static enum status remove_result(const struct run_folder *folder, const char *name) {
    char path[OUTPUT_PATH_SIZE];
    run_folder_file(folder, name, path);
    if (unlink(path) != 0 && errno != ENOENT)
        return status_fail(STATUS_IO, "%s: %s", path, strerror(errno));
    return STATUS_OK;
}

static enum status remove_results(const struct run_folder *folder) {
    enum status status = STATUS_OK;
    for (size_t k = 0; k < sizeof results / sizeof *results; k++)
        TRY(remove_result(folder, results[k]));
    // Names like these are a run's where a run has been, and somebody's elsewhere.
    char used[OUTPUT_PATH_SIZE];
    run_folder_file(folder, "used.json", used);
    if (access(used, F_OK) != 0)
        return STATUS_OK;
    struct dirent **entries;
    const int count = scandir(folder->path, &entries, is_partial_result, alphasort);
    if (count < 0)
        return status_fail(STATUS_IO, "%s: %s", folder->path, strerror(errno));
    for (int k = 0; k < count; k++) {
        char name[63]; // longer than any that a run gives
        snprintf(name, sizeof name, "%.62s", entries[k]->d_name);
        if (status == STATUS_OK)
            status = remove_result(folder, name);
        free(entries[k]);
    }
    free(entries);
    return status;
}

/// Find out now, and not after an hour, that the folder cannot be written.
static enum status check_writable(const struct run_folder *folder) {
    if (access(folder->path, W_OK | X_OK) == 0)
        return STATUS_OK;
    return status_fail(STATUS_IO, "%s: %s", folder->path, strerror(errno));
}

enum status run_folder_open(struct run_folder *folder, const char *input,
                            const struct run_options *options) {
    const char *slash = strrchr(input, '/');
    if (options->folder)
        snprintf(folder->path, sizeof folder->path, "%s", options->folder);
    else
        snprintf(folder->path, sizeof folder->path, "%.*sout", slash ? (int)(slash - input + 1) : 0,
                 input);
    TRY(output_make_folder(folder->path));
    TRY(check_writable(folder));
    return options->resume ? STATUS_OK : remove_results(folder);
}

void run_folder_file(const struct run_folder *folder, const char *name, char *path) {
    // A path cut short here fails to open, with the cut path in the message.
    snprintf(path, OUTPUT_PATH_SIZE, "%.*s/%s", OUTPUT_PATH_SIZE - 64, folder->path, name);
}

void run_folder_rdf(const struct run_folder *folder, const struct composition *composition,
                    int pair, char *path) {
    char kind[COMPOSITION_PAIR_NAME_SIZE], name[COMPOSITION_PAIR_NAME_SIZE + 8];
    composition_pair_name(composition, pair, kind);
    snprintf(name, sizeof name, "rdf%s%s.tsv", kind[0] ? "_" : "", kind);
    run_folder_file(folder, name, path);
}

void run_folder_draw(const struct run_folder *folder) {
    if (figures_draw(folder->path) != STATUS_OK)
        fprintf(stderr, "mesofit: warning: %s\n", status_message());
}
