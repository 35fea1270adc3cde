// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_candidate.h"

#include "base/memory.h"

/// {"name": "potential", "unit": "kJ/mol", "r_unit": "nm", "r": […], "value": […]}
static void write_curve(struct json_writer *writer, const struct unknowns *unknowns,
                        const struct units *units, enum unknown_kind kind, size_t curve,
                        const double *value) {
    const struct unknowns_part part = mf_unknowns_part(unknowns, kind, curve);
    const double *r = mf_unknowns_r(unknowns, kind);
    char name[UNKNOWNS_NAME_SIZE], unit[UNITS_NAME_SIZE];
    const bool angle = strstr(mf_unknowns_heading(unknowns, kind, curve), "degrees") != NULL;
    const char *r_unit = angle ? "degrees" : "lambda";
    mf_unknowns_curve_name(unknowns, kind, curve, name);
    mf_json_begin(writer, NULL);
    mf_json_write_text(writer, "name", name);
    mf_json_write_text(writer, "unit", mf_units_name(units, mf_unknowns_unit(kind), unit));
    mf_json_write_text(writer, "r_unit", mf_units_name(units, r_unit, unit));
    mf_json_write_quantities(writer, "r", r_unit, r + part.first, part.points);
    mf_json_write_quantities(writer, "value", mf_unknowns_unit(kind), value + part.first,
                             part.points);
    mf_json_end(writer);
}

static enum status write_unknown(struct json_writer *writer, const struct watcher_run *run,
                                 const struct inverse_candidate *candidate,
                                 enum unknown_kind kind) {
    const size_t points = mf_unknowns_points(run->unknowns, kind);
    OWNED double *value = NULL;
    if (points == 0)
        return STATUS_OK;
    TRY_ARRAY(value, points);
    candidate->curve(candidate->context, kind, value);
    for (size_t k = 0; k < mf_unknowns_curve_count(run->unknowns, kind); k++)
        write_curve(writer, run->unknowns, run->units, kind, k, value);
    return STATUS_OK;
}

/// g(r) of one pair type, as curves are.
static void write_rdf(struct json_writer *writer, const struct watcher_run *run, size_t pair,
                      const double *g, const double *r) {
    const struct rdf_bins *bins = &run->targets->bins;
    const struct composition *types = &run->unknowns->problem->scene.composition;
    char name[COMPOSITION_PAIR_NAME_SIZE], unit[UNITS_NAME_SIZE];
    mf_composition_pair_name(types, (int)pair, name);
    mf_json_begin(writer, NULL);
    mf_json_write_text(writer, "name", name);
    mf_json_write_text(writer, "r_unit", mf_units_name(run->units, "lambda", unit));
    mf_json_write_quantities(writer, "r", "lambda", r, bins->count);
    mf_json_write_quantities(writer, "value", "1", g + pair * bins->count, bins->count);
    mf_json_write_quantities(writer, "target", "1",
                             run->targets->target[TARGET_RDF].value + pair * bins->count,
                             bins->count);
    mf_json_end(writer);
}

static enum status write_rdfs(struct json_writer *writer, const struct watcher_run *run,
                              const double *g) {
    const struct rdf_bins *bins = &run->targets->bins;
    const size_t pairs = run->targets->target[TARGET_RDF].count / bins->count;
    OWNED double *r = NULL;
    TRY_ARRAY(r, bins->count);
    for (size_t k = 0; k < bins->count; k++)
        r[k] = mf_rdf_bins_centre(bins, k);
    for (size_t pair = 0; pair < pairs; pair++)
        write_rdf(writer, run, pair, g, r);
    return STATUS_OK;
}

static enum status fill(struct json_writer *writer, const struct watcher_run *run,
                        const struct inverse_candidate *candidate) {
    const double temperature = run->unknowns->problem->scene.temperature;
    char unit[UNITS_NAME_SIZE];
    mf_json_writer_set_units(writer, run->units);
    mf_json_write_integer(writer, "number", (int64_t)candidate->number);
    mf_json_write_number(writer, "error", candidate->error);
    mf_json_write_quantity(writer, "temperature", "T_0",
                           candidate->temperature > 0 ? candidate->temperature * temperature : NAN);
    mf_json_write_text(writer, "temperature_unit", mf_units_name(run->units, "T_0", unit));
    mf_json_begin_list(writer, "curves");
    for (int kind = 0; kind < UNKNOWNS; kind++)
        TRY(write_unknown(writer, run, candidate, kind));
    mf_json_end(writer);
    mf_json_begin_list(writer, "rdf");
    if (candidate->rdf)
        TRY(write_rdfs(writer, run, candidate->rdf));
    mf_json_end(writer);
    return STATUS_OK;
}

struct json_writer *mf_live_candidate_write(const struct watcher_run *run,
                                            const struct inverse_candidate *candidate) {
    struct json_writer *writer = mf_json_writer_create();
    if (writer && fill(writer, run, candidate) != STATUS_OK) {
        mf_json_writer_free(writer);
        return NULL;
    }
    return writer;
}
