// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/result.h"

#include "base/memory.h"
#include "io/json.h"
#include "io/output.h"
#include "problem/targets.h"
#include "report/result_tables.h"

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

// Results -----------------------------------------------------------------------------------------

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

/// Version 0.1.0 had another name for it.
static void read_old_truth(struct json_object *root, struct result_summary *summary) {
    static const struct field fields[] = {
        NUMBER_OF(struct result_summary, "truth_error", omega_truth_rms, ""), FIELD_END};
    if (mf_json_has(root, fields[0].name))
        mf_json_fields(root, fields, summary);
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
    read_old_truth(&root, summary);
    find_distance(summary);
    if (is_simulation(summary))
        read_simulated_diffusion(&root, summary);
    else if (root.item && !has_distance(&root) && !is_stopped(summary))
        mf_json_fault(&root, NULL, "not the result of a fit: there is no rdf_rmse or other rmse");
    return mf_json_close(document, STATUS_OK);
}

enum status mf_result_read(struct result *result, const char *folder) {
    enum status status = STATUS_OK;
    char summary[PATH_SIZE];
    snprintf(summary, sizeof summary, "%s/summary.json", folder);
    *result = (struct result){0};
    CHECK(check_folder(folder, summary));
    CHECK(read_summary(&result->summary, summary));
    CHECK(mf_result_tables_read(result, folder, is_simulation(&result->summary)));
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
