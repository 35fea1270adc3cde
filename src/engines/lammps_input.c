// SPDX-License-Identifier: GPL-3.0-or-later
#include "engines/lammps_input.h"

#include "base/digest.h"
#include "base/memory.h"
#include "io/output.h"
#include "io/text_file.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { DEEPEST = 8 };

/// Commands whose words may be files that LAMMPS reads, and those that write.
static const char *const reading[] = {"read_data",
                                      "read_restart",
                                      "read_dump",
                                      "include",
                                      "molecule",
                                      "pair_coeff",
                                      "bond_coeff",
                                      "angle_coeff",
                                      "dihedral_coeff",
                                      "variable",
                                      "pair_style",
                                      "kspace_style",
                                      "kim",
                                      "improper_coeff",
                                      "fix",
                                      "bond_style",
                                      NULL};
static const char *const writing[] = {"dump",    "write_data", "write_restart", "write_dump",
                                      "restart", "log",        "print",         NULL};

static bool is_one_of(const char *word, const char *const *list) {
    for (; *list; list++)
        if (strcmp(word, *list) == 0)
            return true;
    return false;
}

/// A name in the folder of the input.
static void find_path(const char *folder, const char *name, char path[OUTPUT_PATH_SIZE]) {
    snprintf(path, OUTPUT_PATH_SIZE, "%.3700s%.250s", name[0] == '/' ? "" : folder, name);
}

static bool is_listed(const struct lammps_input *input, const char *name) {
    for (size_t k = 0; k < input->files; k++)
        if (strcmp(input->file[k], name) == 0)
            return true;
    return false;
}

/// Add the bytes of a file; false if there is none.
static bool digest_file(const char *path, uint64_t *digest) {
    char bytes[4096];
    FILE *file = fopen(path, "rb");
    if (file == NULL)
        return false;
    for (size_t n; (n = fread(bytes, 1, sizeof bytes, file)) > 0;)
        mf_digest_add(digest, bytes, n);
    const bool whole = ferror(file) == 0; // and no folder
    fclose(file);
    return whole;
}

static enum status add_file(struct lammps_input *input, const char *folder, const char *name) {
    char path[OUTPUT_PATH_SIZE];
    find_path(folder, name, path);
    if (strlen(name) >= LAMMPS_INPUT_NAME || is_listed(input, name) ||
        !digest_file(path, &input->digest))
        return STATUS_OK;
    if (strstr(name, ".."))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s%s: the input is run in another folder: name the file by its whole "
            "path, or put it beside the input",
            folder, name);
    if (input->files == LAMMPS_INPUT_FILES)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: more than %d files are read", folder,
                              LAMMPS_INPUT_FILES);
    snprintf(input->file[input->files++], LAMMPS_INPUT_NAME, "%s", name);
    return STATUS_OK;
}

static enum status read_file(struct lammps_input *input, const char *folder, const char *name,
                             int depth);

/// Averages and prints are fixes that write.
static bool writes_fix(char **word, size_t words) {
    return strcmp(word[0], "fix") == 0 && words > 3 &&
           (strncmp(word[3], "ave/", strlen("ave/")) == 0 || strcmp(word[3], "print") == 0);
}

/// One command, whose words are parted by NUL.
static enum status read_command(struct lammps_input *input, const char *folder, char **word,
                                size_t words, int depth) {
    const bool writes = is_one_of(word[0], writing) || writes_fix(word, words);
    const bool reads = is_one_of(word[0], reading) && !writes;
    if (strcmp(word[0], "pair_style") == 0) {
        input->sets_style = true;
        input->is_hybrid = words > 1 && strncmp(word[1], "hybrid", strlen("hybrid")) == 0;
    }
    if (strcmp(word[0], "units") == 0 && words > 1)
        snprintf(input->units, sizeof input->units, "%s", strchr(word[1], '$') ? "" : word[1]);
    if (strcmp(word[0], "read_restart") == 0 || strcmp(word[0], "if") == 0)
        input->units[0] = '\0'; // there they may be set, too
    if (strcmp(word[0], "include") == 0 && words > 1) {
        input->has_interactions |= strcmp(word[1], "mesofit.lmp") == 0;
        input->has_run |= strcmp(word[1], "mesofit-run.lmp") == 0;
        TRY(read_file(input, folder, word[1], depth + 1));
    }
    for (size_t k = 1; k < words; k++) {
        if (writes && is_listed(input, word[k]))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s%s: it is read, and `%s` writes it: all replicas would; leave "
                                  "that line out of the input",
                                  folder, word[k], word[0]);
        if (reads)
            TRY(add_file(input, folder, word[k]));
    }
    return STATUS_OK;
}

/// Part a line into words, without its comment.
static size_t split(char *line, char **word, size_t most) {
    static const char blanks[] = " \t\r\"'";
    size_t words = 0;
    line[strcspn(line, "#")] = '\0';
    for (char *at = strtok_r(line, blanks, &line); at && words < most;
         at = strtok_r(NULL, blanks, &line))
        word[words++] = at;
    return words;
}

static enum status read_file(struct lammps_input *input, const char *folder, const char *name,
                             int depth) {
    enum { MOST = 64 };
    OWNED char *text = NULL;
    size_t length;
    char path[OUTPUT_PATH_SIZE], *word[MOST], *rest = NULL;
    find_path(folder, name, path);
    if (depth == DEEPEST || (depth > 0 && access(path, R_OK) != 0)) // LAMMPS will say it
        return STATUS_OK;
    TRY(mf_text_file_read(path, &text, &length));
    mf_digest_add(&input->digest, text, length);
    for (char *line = strtok_r(text, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest)) {
        const size_t words = split(line, word, MOST);
        if (words > 0)
            TRY(read_command(input, folder, word, words, depth));
    }
    return STATUS_OK;
}

enum status mf_lammps_input_read(struct lammps_input *input, const char *file) {
    const char *slash = strrchr(file, '/'), *name = slash ? slash + 1 : file;
    char folder[OUTPUT_PATH_SIZE];
    *input = (struct lammps_input){.digest = DIGEST_OF_NOTHING, .units = "lj"}; // LAMMPS's default
    snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - file) + 1 : 0, file);
    TRY(read_file(input, folder, name, 0));
    TRY(add_file(input, folder, name));
    if (input->has_interactions && input->has_run)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: `include %s` is missing: mesofit.lmp stands where interactions are "
                          "set, mesofit-run.lmp where the run would",
                          file, input->has_interactions ? "mesofit-run.lmp" : "mesofit.lmp");
}
