// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/partial_file.h"

#include "io/tracked_file.h"
#include "io/output.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// What processes that were killed had begun to write in one folder: "rdf.tsv.12-3.partial" and the
/// like. @param[in] folder  its name, with / at its end, or ""
static void remove_in(const struct manifest *list, const char *folder) {
    char path[2 * OUTPUT_PATH_SIZE], name[OUTPUT_PATH_SIZE], whole[OUTPUT_PATH_SIZE];
    struct dirent **entries;
    snprintf(path, sizeof path, "%s/%s", list->folder, folder);
    const int count = scandir(path, &entries, NULL, alphasort);
    for (int k = 0; k < count; k++) {
        const size_t stem = mf_output_partial_stem(entries[k]->d_name);
        snprintf(name, sizeof name, "%.3800s%s", folder, entries[k]->d_name);
        snprintf(whole, sizeof whole, "%.3800s%.*s", folder, (int)stem, entries[k]->d_name);
        if (stem > 0 && mf_manifest_find(list, whole))
            mf_tracked_file_remove(list->place, name);
        free(entries[k]);
    }
    if (count >= 0)
        free(entries);
}

void mf_partial_file_remove(const struct manifest *list) {
    char before[OUTPUT_PATH_SIZE] = "";
    remove_in(list, "");
    for (size_t k = 0; k < list->count; k++) {
        char folder[OUTPUT_PATH_SIZE];
        const char *name = list->entry[k].name, *slash = strrchr(name, '/');
        snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - name) + 1 : 0, name);
        if (strcmp(folder, before) != 0)
            remove_in(list, folder);
        memcpy(before, folder, sizeof before);
    }
}
