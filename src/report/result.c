// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/result.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "io/json.h"
#include "io/output.h"
#include "problem/targets.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Distances from targets --------------------------------------------------------------------------

/// Find `error_over_noise`, the rms of rmse over noise of all targets that a summary tells, in
/// which 1 is what statistics alone leave, and `worst`, the target with the largest of them. NaN
/// and "" if there is none, as of a simulation.
static void find_distance(struct result_summary *summary) {
    double sum = 0, largest = 0;
    size_t count = 0;
    summary->error_over_noise = NAN;
    summary->worst[0] = '\0';
    for (int kind = 0; mf_targets_name(kind); kind++) {
        const double ratio = summary->distance[kind].rmse / summary->distance[kind].noise;
        if (!isfinite(ratio))
            continue;
        sum += ratio * ratio;
        count++;
        if (ratio < largest)
            continue;
        largest = ratio;
        snprintf(summary->worst, sizeof summary->worst, "%s %.2g", mf_targets_name(kind), ratio);
    }
    if (count > 0)
        summary->error_over_noise = sqrt(sum / (double)count);
}

// The summary -------------------------------------------------------------------------------------

enum { PATH_SIZE = OUTPUT_PATH_SIZE + 64 };

#define TEXT(member)                                                                               \
    { .name = #member, .type = FIELD_TEXT, .offset = offsetof(struct result_summary, member) }
/// A number under a key of its own, in some struct.
#define NUMBER_OF(type_, key, member, its_unit)                                                    \
    {                                                                                              \
        .name = key, .type = FIELD_NUMBER, .offset = offsetof(type_, member), .initial = NAN,      \
        .minimum = -DBL_MAX, .maximum = DBL_MAX, .unit = its_unit                                  \
    }
#define NUMBER(member, its_unit) NUMBER_OF(struct result_summary, #member, member, its_unit)

#define MEAN(member, its_unit) NUMBER(member, its_unit), NUMBER(member##_error, its_unit)

/// Distances from targets stand after the first nine.
static const struct field own_fields[] = {
    TEXT(status),
    TEXT(method),
    TEXT(version),
    NUMBER(seconds, "s"),
    NUMBER(threads, "1"),
    NUMBER(iterations, "1"),
    NUMBER(evaluations, "1"),
    NUMBER(engine_steps, "1"),
    NUMBER(error_over_noise, "1"),
    MEAN(diffusion, "lambda^2/tau"),
    NUMBER(diffusion_cm2_per_s, "cm^2/s"),
    NUMBER(diffusion_error_cm2_per_s, "cm^2/s"),
    NUMBER(truth_rms, "k_BT_0"),
    NUMBER(truth_ramp, "k_BT_0"),
    NUMBER(truth_rms_without_ramp, "k_BT_0"),
    NUMBER(omega_truth_rms, "1"),
    MEAN(temperature, "T_0"),
    MEAN(temperature_configurational, "T_0"),
    MEAN(potential_energy, "k_BT_0"),
    MEAN(pressure, "k_BT_0/lambda^d"),
    MEAN(density, "1/lambda^d"),
    MEAN(kirkwood_buff, "lambda^d"),
    MEAN(compressibility, "1"),
    NUMBER(ramp_error, "k_BT_0"),
    NUMBER(ramp_pressure, "1/lambda^d"),
    NUMBER(pressure_left_open, "k_BT_0/lambda^d"),
    NUMBER(density_left_open, "1/lambda^d"),
    NUMBER(directions, "1"),
    NUMBER(seed, "1"),
    FIELD_END,
};

/// A unit as headings have it, without blanks: "k_BT_0.tau/lambda^3".
static void write_unit(const char *unit, char text[UNITS_NAME_SIZE]) {
    size_t length = 0;
    for (const char *at = unit; *at && length + 1 < UNITS_NAME_SIZE; at++)
        if (*at != ' ')
            text[length++] = *at;
        else if (strncmp(at + 1, "T_0", 3) != 0)
            text[length++] = '.';
    text[length] = '\0';
}

const struct field *mf_result_summary_field(size_t n, struct result_field *capacity) {
    static const struct field of_target[] = {
        {.name = "rmse", .offset = offsetof(struct result_distance, rmse)},
        {.name = "rmse_error", .offset = offsetof(struct result_distance, rmse_error)},
        {.name = "noise", .offset = offsetof(struct result_distance, noise)},
    };
    enum { BEFORE = 9, OF_TARGET = 3, FIELDS = sizeof own_fields / sizeof *own_fields - 1 };
    size_t kinds = 0;
    while (mf_targets_name((int)kinds))
        kinds++;
    if (n < BEFORE)
        return &own_fields[n];
    if (n >= BEFORE + OF_TARGET * kinds)
        return n - OF_TARGET * kinds < FIELDS ? &own_fields[n - OF_TARGET * kinds] : NULL;
    const size_t kind = (n - BEFORE) / OF_TARGET;
    const struct field *of = &of_target[(n - BEFORE) % OF_TARGET];
    const struct observable_kind about = mf_observable_kind((int)kind);
    snprintf(capacity->name, sizeof capacity->name, "%s_%s", about.target->name, of->name);
    write_unit(about.target->unit ? about.target->unit : "1", capacity->unit);
    capacity->field = (struct field){.name = capacity->name,
                                     .type = FIELD_NUMBER,
                                     .offset = offsetof(struct result_summary, distance) +
                                               kind * sizeof(struct result_distance) + of->offset,
                                     .initial = NAN,
                                     .minimum = -DBL_MAX,
                                     .maximum = DBL_MAX,
                                     .unit = capacity->unit};
    return &capacity->field;
}

/// Say what is wrong with the folder before a reader complains of a file in it.
static enum status check_folder(const char *folder, const char *summary) {
    struct stat about;
    if (stat(folder, &about) != 0)
        return mf_status_fail(STATUS_IO, "%s: %s", folder, strerror(errno));
    if (!S_ISDIR(about.st_mode))
        return mf_status_fail(STATUS_BAD_INPUT, "%s: not a folder", folder);
    if (access(summary, F_OK) != 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: missing, so this is no folder of a finished fit", summary);
    return STATUS_OK;
}

/// True if the result was compared with any target.
static bool has_distance(const struct json_object *root) {
    char key[64];
    bool found = false;
    for (int kind = 0; mf_targets_name(kind); kind++) {
        snprintf(key, sizeof key, "%s_rmse", mf_targets_name(kind));
        found = found || mf_json_is_member(root, key);
    }
    return found;
}

/// A fit that has not come to the comparison with its targets: its status tells.
static bool is_stopped(const struct result_summary *summary) {
    return strcmp(summary->status, mf_status_name(STATUS_UNSTABLE)) == 0 ||
           strcmp(summary->status, mf_status_name(STATUS_INTERRUPTED)) == 0;
}

static bool is_simulation(const struct result_summary *summary) {
    return strcmp(summary->method, "simulate") == 0;
}

/// D of a simulation stands in an object of its own.
static void read_simulated_diffusion(struct json_object *root, struct result_summary *summary) {
    static const struct field fields[] = {
        NUMBER_OF(struct result_summary, "diffusion_msd", diffusion, ""),
        NUMBER_OF(struct result_summary, "diffusion_msd_error", diffusion_error, ""), FIELD_END};
    struct json_object motion = mf_json_child(root, "motion", false);
    mf_json_fields(&motion, fields, summary);
}

/// λ stands in an object of its own, if it is known.
static void read_length_unit(struct json_object *root, struct result_summary *summary) {
    static const struct field fields[] = {NUMBER(length_unit_nm, "nm"), FIELD_END};
    struct json_object physical = mf_json_child(root, "physical", false);
    mf_json_fields(&physical, fields, summary);
}

/// What a summary says of the scale.
struct scale {
    double length, temperature, mass; ///< in physical units
    double time, energy;              ///< beside reduced ones, with the length
    double dimensions;                ///< of the scene; 3 if it does not say
};

#define SCALE(key, member) NUMBER_OF(struct scale, key, member, "")

/// "physical" of a summary in reduced units.
static void read_scale_beside(struct json_object *root, struct units *units) {
    static const struct field fields[] = {SCALE("length_unit_nm", length),
                                          SCALE("time_unit_ps", time),
                                          SCALE("energy_unit_kJ_per_mol", energy), FIELD_END};
    struct json_object physical = mf_json_child(root, "physical", false);
    struct scale scale;
    mf_json_fields(&physical, fields, &scale);
    if (!(scale.length > 0))
        return;
    units->length = scale.length;
    units->temperature = 1e3 * scale.energy / (UNITS_BOLTZMANN * UNITS_AVOGADRO);
    // 1 u nm²/ps² is 1 kJ/mol.
    units->mass = scale.energy * pow(scale.time / scale.length, 2) * UNITS_ATOMIC_MASS;
}

/// The units of the folder are an object of its own.
static void read_units(struct json_object *root, struct units *units) {
    static const struct field fields[] = {SCALE("length", length),
                                          SCALE("temperature", temperature), SCALE("mass", mass),
                                          SCALE("dimensions", dimensions), FIELD_END};
    struct json_object object = mf_json_child(root, "units", false);
    struct scale scale;
    const char *name =
        mf_json_choice(&object, "system", mf_units_systems, mf_units_systems[UNITS_REDUCED]);
    for (int k = 0; name && mf_units_systems[k]; k++)
        if (strcmp(mf_units_systems[k], name) == 0)
            units->system = k;
    if (!mf_units_are_physical(units)) {
        read_scale_beside(root, units);
        return;
    }
    mf_json_fields(&object, fields, &scale);
    units->length = units->system == UNITS_ANGSTROM_FS ? scale.length / 10 : scale.length;
    units->dimensions = scale.dimensions == 2 ? 2 : 3;
    units->temperature = scale.temperature;
    units->mass = scale.mass * UNITS_ATOMIC_MASS;
}

static void read_fields(const struct json_object *root, struct result_summary *summary) {
    const struct field *field;
    struct result_field capacity;
    for (size_t n = 0; (field = mf_result_summary_field(n, &capacity)); n++) {
        struct json_object own = *root; // asked for this alone
        mf_json_fields(&own, (const struct field[]){*field, FIELD_END}, summary);
    }
}

/// Keys that are not in the table are left alone: a later version may write more.
static enum status read_summary(struct result_summary *summary, const char *file) {
    struct json_document *document;
    TRY(mf_json_open(&document, file));
    struct json_object root = mf_json_root(document);
    read_fields(&root, summary);
    read_length_unit(&root, summary);
    read_units(&root, &summary->units);
    find_distance(summary);
    if (is_simulation(summary))
        read_simulated_diffusion(&root, summary);
    else if (root.item && !has_distance(&root) && !is_stopped(summary))
        mf_json_fault(&root, NULL, "not the result of a fit: there is no rdf_rmse or other rmse");
    return mf_json_close(document, STATUS_OK);
}

// Tables ------------------------------------------------------------------------------------------

/// A column of a table that is to be read.
struct wanted_column {
    const char *name; ///< in the header, without its unit; NULL: go by the place
    size_t place;     ///< from 1, if the header has no such name; 0: then it is nan
};

/// Read the columns that `wanted` says, which learns from the header; others are left alone.
static enum status read_table(struct result_table *table, const char *folder, const char *name,
                              struct wanted_column *wanted, size_t count) {
    CLEARED_BY(mf_data_table_clear) struct data_table from = {0};
    char file[PATH_SIZE];
    snprintf(file, sizeof file, "%s/%s", folder, name);
    TRY(mf_data_table_read_result(&from, file));
    TRY_ARRAY(table->values, from.rows * count);
    table->rows = from.rows;
    table->columns = count;
    for (size_t k = 0; k < count; k++) {
        const size_t found = wanted[k].name ? mf_data_table_find(&from, wanted[k].name) : 0;
        const size_t place = wanted[k].place = found ? found : wanted[k].place;
        if (place > from.columns)
            return mf_status_fail(STATUS_BAD_INPUT, "%s: there is no column %zu", file, place);
        for (size_t row = 0; row < from.rows; row++)
            table->values[row * count + k] =
                place > 0 ? from.values[row * from.columns + place - 1] : NAN;
    }
    return STATUS_OK;
}

static bool is_there(const char *folder, const char *name) {
    char file[PATH_SIZE];
    snprintf(file, sizeof file, "%s/%s", folder, name);
    return access(file, F_OK) == 0;
}

/// That of a simulation is r, g, g_error: a result without a target.
static enum status read_rdf(struct result_table *table, const char *folder, bool simulated) {
    struct wanted_column fitted[] = {{NULL, 1}, {NULL, 2}, {NULL, 3}, {NULL, 4}, {NULL, 5}};
    struct wanted_column counted[] = {{NULL, 1}, {NULL, 0}, {NULL, 0}, {NULL, 2}, {NULL, 3}};
    return is_there(folder, "rdf.tsv")
               ? read_table(table, folder, "rdf.tsv", simulated ? counted : fitted, 5)
               : STATUS_OK;
}

/// Cells of E of a simulation, which has a column for each r_0: a result without a target.
static enum status join_cells(struct result_table *cells, const struct result_table *bins,
                              const struct result_table *value, const struct result_table *error) {
    cells->columns = 6;
    TRY_ARRAY(cells->values, cells->columns * value->rows * bins->rows);
    for (size_t time = 0; time < value->rows; time++)
        for (size_t bin = 0; bin < bins->rows; bin++) {
            const size_t at = time * value->columns;
            double *row = cells->values + cells->columns * cells->rows++;
            row[0] = value->values[at];
            row[1] = bins->values[bin];
            row[2] = row[3] = NAN;
            row[4] = value->values[at + 1 + bin];
            row[5] = time < error->rows ? error->values[at + 1 + bin] : NAN;
        }
    return STATUS_OK;
}

static enum status read_simulated_etd(struct result_table *table, const char *folder) {
    enum status status = STATUS_OK;
    struct result_table bins = {0}, value = {0}, error = {0};
    struct wanted_column separation[] = {{NULL, 1}}, *columns = NULL;
    CHECK(read_table(&bins, folder, "etd_bins.tsv", separation, 1));
    NEW_ARRAY(columns, bins.rows + 1);
    for (size_t k = 0; k <= bins.rows; k++)
        columns[k] = (struct wanted_column){NULL, k + 1};
    CHECK(read_table(&value, folder, "etd.tsv", columns, bins.rows + 1));
    CHECK(read_table(&error, folder, "etd_error.tsv", columns, bins.rows + 1));
    CHECK(join_cells(table, &bins, &value, &error));
done:
    mf_memory_free(columns);
    mf_memory_free(bins.values);
    mf_memory_free(value.values);
    mf_memory_free(error.values);
    return status;
}

static enum status read_etd(struct result_table *table, const char *folder, bool simulated) {
    struct wanted_column fitted[] = {{NULL, 1}, {NULL, 2}, {NULL, 3},
                                     {NULL, 4}, {NULL, 5}, {NULL, 6}};
    if (simulated)
        return is_there(folder, "etd.tsv") ? read_simulated_etd(table, folder) : STATUS_OK;
    return is_there(folder, "etd_cells.tsv") ? read_table(table, folder, "etd_cells.tsv", fitted, 6)
                                             : STATUS_OK;
}

static enum status read_vacf(struct result_table *table, const char *folder, bool simulated) {
    struct wanted_column fitted[] = {{NULL, 1}, {NULL, 2}, {NULL, 3}, {NULL, 4}, {NULL, 5}};
    struct wanted_column counted[] = {
        {NULL, 1}, {NULL, 0}, {NULL, 0}, {"vacf", 0}, {"vacf_error", 0}};
    const char *file = simulated ? "motion.tsv" : "vacf.tsv";
    return is_there(folder, file) ? read_table(table, folder, file, simulated ? counted : fitted, 5)
                                  : STATUS_OK;
}

/// With what was known beside it, which another fit may have looked for.
static enum status read_potential(struct result_table *table, const char *folder) {
    enum { PHI = 1, TRUTH = 3, SOUGHT = 4, COLUMNS = 5 };
    struct wanted_column wanted[COLUMNS] = {
        {NULL, 1}, {"total", 2}, {"phi_error", 0}, {"truth", 0}, {NULL, 2}};
    if (!is_there(folder, "potential.tsv"))
        return STATUS_OK;
    TRY(read_table(table, folder, "potential.tsv", wanted, COLUMNS));
    table->columns = COLUMNS - 1;
    for (size_t k = 0; k < table->rows; k++) {
        const double *from = table->values + k * COLUMNS;
        double *to = table->values + k * table->columns;
        const double row[] = {from[0], from[PHI], from[2], from[TRUTH] + from[PHI] - from[SOUGHT]};
        memcpy(to, row, sizeof row);
    }
    return STATUS_OK;
}

/// A friction weight without a column of errors was not fitted.
static enum status read_omega(struct result_table *table, const char *folder) {
    struct wanted_column wanted[] = {{NULL, 1}, {NULL, 2}, {"omega_error", 0}, {"truth", 0}};
    if (!is_there(folder, "omega.tsv"))
        return STATUS_OK;
    TRY(read_table(table, folder, "omega.tsv", wanted, 4));
    if (wanted[2].place == 0) {
        mf_memory_free(table->values);
        *table = (struct result_table){0};
    }
    return STATUS_OK;
}

static double seconds_at(const struct result_table *timing, double iteration) {
    for (size_t row = 0; row < timing->rows; row++)
        if (timing->values[2 * row] == iteration)
            return timing->values[2 * row + 1];
    return NAN;
}

/// history.tsv with the seconds of timing.tsv.
static enum status read_course(struct result_table *table, const char *folder) {
    enum { SECONDS = 3 };
    enum status status = STATUS_OK;
    struct result_table timing = {0};
    struct wanted_column wanted[] = {{NULL, 1}, {NULL, 2}, {NULL, 3},
                                     {NULL, 0}, {NULL, 4}, {NULL, 5}};
    struct wanted_column times[] = {{NULL, 1}, {NULL, 2}};
    CHECK(read_table(table, folder, "history.tsv", wanted, 6));
    CHECK(read_table(&timing, folder, "timing.tsv", times, 2));
    for (size_t row = 0; row < table->rows; row++) {
        double *values = table->values + row * table->columns;
        values[SECONDS] = seconds_at(&timing, values[0]);
    }
done:
    mf_memory_free(timing.values);
    return status;
}

static enum status read_tables(struct result *result, const char *folder, bool simulated) {
    TRY(read_rdf(&result->rdf, folder, simulated));
    TRY(read_etd(&result->etd, folder, simulated));
    TRY(read_vacf(&result->vacf, folder, simulated));
    TRY(read_potential(&result->potential, folder));
    TRY(read_omega(&result->omega, folder));
    return simulated ? STATUS_OK : read_course(&result->course, folder);
}

enum status mf_result_read(struct result *result, const char *folder) {
    enum status status = STATUS_OK;
    char summary[PATH_SIZE];
    snprintf(summary, sizeof summary, "%s/summary.json", folder);
    *result = (struct result){0};
    CHECK(check_folder(folder, summary));
    CHECK(read_summary(&result->summary, summary));
    CHECK(read_tables(result, folder, is_simulation(&result->summary)));
done:
    if (status != STATUS_OK)
        mf_result_clear(result);
    return status;
}

void mf_result_clear(struct result *result) {
    mf_memory_free(result->rdf.values);
    mf_memory_free(result->etd.values);
    mf_memory_free(result->vacf.values);
    mf_memory_free(result->potential.values);
    mf_memory_free(result->omega.values);
    mf_memory_free(result->course.values);
    *result = (struct result){0};
}
