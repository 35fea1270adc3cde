// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/compare.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "io/tracked_files.h"
#include "report/compare_table.h"
#include "report/figures.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_SIZE = OUTPUT_PATH_SIZE + 64 };

// Names -------------------------------------------------------------------------------------------

/// The absolute path of a folder, without a last part "out", which says nothing.
static enum status find_path(struct compared *fit, const char *folder) {
    char *path = realpath(folder, NULL);
    if (path == NULL)
        return mf_status_fail(STATUS_IO, "%s: %s", folder, strerror(errno));
    char *slash = strrchr(path, '/');
    if (slash > path && strcmp(slash, "/out") == 0)
        *slash = '\0';
    snprintf(fit->path, sizeof fit->path, "%s", path);
    free(path);
    return STATUS_OK;
}

/// The last `parts` parts of a path, or all of it without its first slash.
static const char *last_parts(const char *path, size_t parts) {
    const char *begin = path + strlen(path);
    for (; parts > 0 && begin > path; parts--)
        do
            begin--;
        while (begin > path && begin[-1] != '/');
    return begin;
}

/// True if another folder has the same last parts.
static bool is_shared(const struct compared *fits, size_t count, const char *path, size_t parts) {
    const char *name = last_parts(path, parts);
    for (size_t k = 0; k < count; k++)
        if (strcmp(fits[k].path, path) != 0 && strcmp(last_parts(fits[k].path, parts), name) == 0)
            return true;
    return false;
}

static void name_fits(struct compared *fits, size_t count) {
    for (size_t k = 0; k < count; k++) {
        size_t parts = 1, same = 1;
        while (is_shared(fits, count, fits[k].path, parts))
            parts++;
        for (size_t before = 0; before < k; before++)
            same += strcmp(fits[before].path, fits[k].path) == 0;
        const char *name = last_parts(fits[k].path, parts);
        if (same > 1)
            snprintf(fits[k].name, sizeof fits[k].name, "%.*s (%zu)", OUTPUT_PATH_SIZE - 32, name,
                     same);
        else
            snprintf(fits[k].name, sizeof fits[k].name, "%s", name);
        mf_compare_table_clean(fits[k].name);
    }
}

// Blocks of tables --------------------------------------------------------------------------------

/// A fit without the table has one row of nan, so that the numbers of the blocks stay those of the
/// fits: gnuplot does not count empty blocks.
static void write_rows(FILE *stream, const struct result_table *table, size_t columns) {
    for (size_t k = 0; table->rows == 0 && k < columns; k++)
        fprintf(stream, "nan%c", k + 1 < columns ? '\t' : '\n');
    for (size_t k = 0; k < table->rows * table->columns; k++) {
        const char end = (k + 1) % table->columns ? '\t' : '\n';
        if (isnan(table->values[k]))
            fprintf(stream, "nan%c", end);
        else
            fprintf(stream, "%.10g%c", table->values[k], end);
    }
}

/// A table that fits may have.
struct block {
    const char *name;   ///< of the file
    const char *header; ///< names of the columns
    size_t columns;
    size_t table; ///< offset of its struct result_table in struct result
};

static const struct block blocks[] = {
    {"rdf_compare.tsv", "r[lambda]\ttarget[1]\ttarget_error[1]\tresult[1]\tresult_error[1]", 5,
     offsetof(struct result, rdf)},
    {"etd_compare.tsv",
     "time[tau]\tr0[lambda]\ttarget[1]\ttarget_error[1]\tresult[1]\tresult_error[1]", 6,
     offsetof(struct result, etd)},
    {"vacf_compare.tsv",
     "time[tau]\ttarget[lambda^2/tau^2]\ttarget_error[lambda^2/tau^2]\tresult[lambda^2/tau^2]\t"
     "result_error[lambda^2/tau^2]",
     5, offsetof(struct result, vacf)},
    {"potential_compare.tsv", "r[lambda]\tphi[k_B.T_0]\tphi_error[k_B.T_0]\ttruth[k_B.T_0]", 4,
     offsetof(struct result, potential)},
    {"omega_compare.tsv",
     "r[lambda]\tomega[sqrt(mu/tau)]\tomega_error[sqrt(mu/tau)]\ttruth[sqrt(mu/tau)]", 4,
     offsetof(struct result, omega)},
    {"error_compare.tsv",
     "iteration[1]\tevaluations[1]\tengine_steps[1]\tseconds[s]\terror[1]\tnoise[1]", 6,
     offsetof(struct result, course)},
};

/// The names of the columns, with the units of the folder.
static void write_header(FILE *stream, const struct block *block,
                         const struct result_summary *summary) {
    const char *name = block->header;
    while (*name) {
        char reduced[64], translated[256];
        const size_t length = strcspn(name, "\t");
        snprintf(reduced, sizeof reduced, "%.*s", (int)length, name);
        mf_data_table_translate(&summary->units, reduced, translated, sizeof translated);
        name += length + (name[length] == '\t');
        fprintf(stream, "%s%c", translated, *name ? '\t' : '\n');
    }
}

static const struct result_table *table_of(const struct compared *fit, const struct block *block) {
    return (const struct result_table *)((const char *)&fit->result + block->table);
}

/// Whether any fit has the table.
static bool is_wanted(const struct block *block, const struct compared *fits, size_t count) {
    size_t rows = 0;
    for (size_t k = 0; k < count; k++)
        rows += table_of(&fits[k], block)->rows;
    return rows > 0;
}

/// One block a fit.
static enum status write_blocks(const char *out, const struct block *block,
                                const struct compared *fits, size_t count) {
    struct output output;
    char file[PATH_SIZE];
    snprintf(file, sizeof file, "%s/%s", out, block->name);
    TRY(mf_output_open(&output, file));
    for (size_t k = 0; k < count; k++) {
        fprintf(output.stream, "%s# %zu\t%s\n# ", k ? "\n\n" : "", k, fits[k].name);
        write_header(output.stream, block, &fits[k].result.summary);
        write_rows(output.stream, table_of(&fits[k], block), block->columns);
    }
    return mf_output_commit(&output);
}

enum { BLOCKS = sizeof blocks / sizeof blocks[0] };

/// Nothing is written if something may not be. The figure is reserved, too: if it fails, the tables
/// are there all the same.
static enum status reserve(struct tracked_files *own, const struct compared *fits, size_t count) {
    TRY(mf_tracked_files_reserve(own, "figures/"));
    static const char *const figures[] = {"figures/compare.svg", "figures/compare.png",
                                          "figures/compare_dynamics.svg",
                                          "figures/compare_dynamics.png"};
    for (size_t k = 0; k < sizeof figures / sizeof *figures; k++)
        TRY(mf_tracked_files_reserve(own, figures[k]));
    TRY(mf_tracked_files_reserve(own, "compare.tsv"));
    for (size_t k = 0; k < BLOCKS; k++)
        if (is_wanted(&blocks[k], fits, count))
            TRY(mf_tracked_files_reserve(own, blocks[k].name));
    return STATUS_OK;
}

/// What an earlier comparison left, and this one does not write, goes.
static enum status write_tables(struct tracked_files *own, const struct compared *fits,
                                size_t count) {
    TRY(mf_tracked_files_lock(own));
    TRY(reserve(own, fits, count));
    TRY(mf_tracked_files_begin(own, 0));
    TRY(mf_compare_table_write(own->folder, fits, count));
    for (size_t k = 0; k < BLOCKS; k++)
        if (is_wanted(&blocks[k], fits, count))
            TRY(write_blocks(own->folder, &blocks[k], fits, count));
    return mf_tracked_files_remove_earlier(own);
}

/// What a folder calls 1 of a reduced unit, in nm, ps, u and so on.
static double size_of(const struct units *units, const char *unit) {
    struct units physical = *units;
    physical.system = UNITS_NM_PS;
    return mf_units_factor(&physical, unit) / mf_units_factor(units, unit);
}

static void convert_table(struct result_table *table, const char *header, const struct units *from,
                          const struct units *to) {
    const char *name = header;
    for (size_t c = 0; c < table->columns; c++) {
        char unit[UNITS_NAME_SIZE];
        const char *bracket = strchr(name, '[') + 1;
        snprintf(unit, sizeof unit, "%.*s", (int)strcspn(bracket, "]"), bracket);
        for (size_t row = 0; row < table->rows; row++)
            table->values[row * table->columns + c] *= size_of(from, unit) / size_of(to, unit);
        name = bracket;
    }
}

/// Make the numbers of a folder those of other units.
static void convert(struct compared *fit, const struct units *to) {
    struct result_summary *summary = &fit->result.summary;
    const struct field *field;
    struct result_field capacity;
    for (size_t n = 0; (field = mf_result_summary_field(n, &capacity)); n++)
        if (field->type == FIELD_NUMBER) {
            char *member = (char *)summary + field->offset;
            double value;
            memcpy(&value, member, sizeof value);
            value *= size_of(&summary->units, field->unit) / size_of(to, field->unit);
            memcpy(member, &value, sizeof value);
        }
    for (size_t k = 0; k < BLOCKS; k++)
        convert_table((struct result_table *)((char *)&fit->result + blocks[k].table),
                      blocks[k].header, &summary->units, to);
    summary->units = *to;
    summary->length_unit_nm = NAN;
}

/// Numbers of different units do not stand in one table: those of the first folder are for all.
static enum status bring_together(struct compared *fits, size_t count, const char *const *folders) {
    const struct units *first = &fits[0].result.summary.units;
    for (size_t k = 1; k < count; k++) {
        const struct units *other = &fits[k].result.summary.units;
        if (first->system == other->system)
            continue;
        if (!mf_units_known(first) || !mf_units_known(other))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "compare: %s is in %s units and %s in %s ones: give \"units\" in "
                                  "the scene to convert them",
                                  folders[0], mf_units_systems[first->system], folders[k],
                                  mf_units_systems[other->system]);
        convert(&fits[k], first);
        if (!mf_units_are_physical(first))
            fits[k].result.summary.length_unit_nm = first->length;
    }
    return STATUS_OK;
}

/// Tables and figures are over r in λ: those of different λ do not go together.
static enum status check_lengths(const struct compared *fits, size_t count,
                                 const char *const *folders) {
    static const double rounding = 1e-9;
    const double *first = NULL;
    size_t at = 0;
    for (size_t k = 0; k < count; k++) {
        const double *length = &fits[k].result.summary.length_unit_nm;
        if (isnan(*length))
            continue;
        if (first && fabs(*length / *first - 1) > rounding)
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "compare: the unit of length is %.6g nm in %s and %.6g nm in %s: "
                                  "tables over r in it do not go together",
                                  *first, folders[at], *length, folders[k]);
        if (first == NULL) {
            first = length;
            at = k;
        }
    }
    return STATUS_OK;
}

/// A length of one folder that has no unit may be another one: a person has to know.
static void warn_of_lengths(const struct compared *fits, size_t count, const char *const *folders) {
    size_t with = count, without = count;
    for (size_t k = 0; k < count; k++) {
        size_t *first = isnan(fits[k].result.summary.length_unit_nm) ? &without : &with;
        *first = *first < count ? *first : k;
    }
    if (with < count && without < count)
        fprintf(
            stderr,
            "mesofit: warning: compare: lambda is %.6g nm in %s and has no \"units\" in %s: all "
            "is compared in reduced units, as if it were the same\n",
            fits[with].result.summary.length_unit_nm, folders[with], folders[without]);
}

enum status mf_compare_folders(const char *const *folders, size_t count, const char *out,
                               bool force, bool quiet) {
    enum status status = STATUS_OK;
    struct compared *fits = NULL;
    struct tracked_files own = {.open = false};
    if (count == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "compare: give the folder of at least one fit");
    NEW_ARRAY(fits, count);
    for (size_t k = 0; k < count; k++) {
        CHECK(mf_result_read(&fits[k].result, folders[k]));
        CHECK(find_path(&fits[k], folders[k]));
    }
    CHECK(bring_together(fits, count, folders));
    CHECK(check_lengths(fits, count, folders));
    warn_of_lengths(fits, count, folders);
    name_fits(fits, count);
    CHECK(mf_tracked_files_make(&own, out, TRACKED_FILES_OF_COMPARISON));
    own.force = force;
    CHECK(write_tables(&own, fits, count));
    if (!quiet)
        CHECK(mf_compare_table_print(fits, count));
    if (mf_figures_draw_comparison(out) != STATUS_OK)
        fprintf(stderr, "mesofit: warning: %s\n", mf_status_message());
    else if (!quiet)
        printf("figures: %s/figures\n", out);
done:
    mf_tracked_files_close(&own);
    for (size_t k = 0; fits && k < count; k++)
        mf_result_clear(&fits[k].result);
    mf_memory_free(fits);
    return status;
}
