// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_terms.h"

#include <string.h>

// Files -------------------------------------------------------------------------------------------

/// A file of a kind of terms, or of its table number `number`.
static enum status open_file(struct output *output, const struct export_job *job, const char *name,
                             int number) {
    char path[OUTPUT_PATH_SIZE], ending[16] = "";
    if (number >= 0)
        snprintf(ending, sizeof ending, "%d", number);
    snprintf(path, sizeof path, "%.3800s/%.200s%s.txt", job->folder, name, ending);
    return mf_output_open(output, path);
}

static enum status write_terms(const struct export_job *job, int order) {
    enum { NO_TABLE = -1 };
    const struct bonded_kind *kind = mf_bonded_kinds[order];
    const struct topology *topology = &job->model->molecules->topology;
    struct output output;
    TRY(open_file(&output, job, kind->plural, NO_TABLE));
    fprintf(output.stream, "# group and beads, from 0 on\n");
    for (int k = 0; k < topology->kinds; k++)
        for (int64_t m = 0; m < topology->kind[k].count; m++)
            for (int n = 0; n < topology->kind[k].terms[order]; n++) {
                const struct topology_term *term = &topology->kind[k].term[order][n];
                fprintf(output.stream, "%d", term->group);
                for (int bead = 0; bead < kind->beads; bead++)
                    fprintf(output.stream, " %u",
                            topology_id(&topology->kind[k], m, term->bead[bead]));
                fprintf(output.stream, "\n");
            }
    return mf_output_commit(&output);
}

static enum status write_table(const struct export_job *job, int order,
                               const struct export_bonded_table *table) {
    const struct bonded_kind *kind = mf_bonded_kinds[order];
    const double unit = kind->is_length ? job->units.length : 1;
    struct output output;
    TRY(open_file(&output, job, kind->name, table->number));
    fprintf(output.stream, "# %s[%s] energy[%s] -slope[%s/%s]\n", kind->is_length ? "r" : "angle",
            kind->is_length ? job->units.length_name : "rad", job->units.energy_name,
            job->units.energy_name, kind->is_length ? job->units.length_name : "rad");
    for (size_t k = 0; k < job->bonded.rows; k++)
        fprintf(output.stream, "%.15g %.15g %.15g\n", table->q[k] * unit,
                table->energy[k] * job->units.energy, -table->slope[k] * job->units.energy / unit);
    return mf_output_commit(&output);
}

static void print_exclusions(const struct export_job *job, FILE *stream) {
    const struct topology *topology = &job->model->molecules->topology;
    fprintf(stream, "# pairs of beads, from 0 on, that do not act as pairs\n");
    for (size_t id = 0; id < topology->particles; id++)
        for (size_t k = topology->excluded_start[id]; k < topology->excluded_start[id + 1]; k++)
            if (topology->excluded[k] > id)
                fprintf(stream, "%zu %u\n", id, topology->excluded[k]);
}

enum status mf_export_terms_files(const struct export_job *job) {
    const struct molecules *molecules = job->model->molecules;
    if (molecules == NULL)
        return STATUS_OK;
    for (int order = 0; order < BONDED_KINDS; order++) {
        if (mf_topology_terms(&molecules->topology, order) > 0)
            TRY(write_terms(job, order));
        for (int g = 0; g < molecules->groups[order]; g++)
            if (job->bonded.table[order][g].q)
                TRY(write_table(job, order, &job->bonded.table[order][g]));
    }
    return molecules->topology.excludes ? mf_export_file(job, "exclusions.txt", print_exclusions)
                                        : STATUS_OK;
}

// The script --------------------------------------------------------------------------------------

/// What a parameter of a law is to be multiplied with, by the unit that its field has.
static double unit_of(const struct export_job *job, const char *unit) {
    const struct export_units *units = &job->units;
    if (strcmp(unit, "lambda") == 0)
        return units->length;
    if (strcmp(unit, "degrees") == 0)
        return BONDED_RADIANS;
    if (strcmp(unit, "k_B T_0") == 0)
        return units->energy;
    if (strcmp(unit, "k_B T_0/lambda^2") == 0)
        return units->energy / (units->length * units->length);
    return 1;
}

static void print_group(const struct export_job *job, int order, int g, FILE *stream) {
    const struct molecules_group *group = &job->model->molecules->group[order][g];
    const struct bonded_law *law = group->curve.law;
    if (job->bonded.table[order][g].q) {
        fprintf(stream, "(\"%s\", \"table\", dict(file=\"%s%d.txt\"))", group->name,
                mf_bonded_kinds[order]->name, job->bonded.table[order][g].number);
        return;
    }
    fprintf(stream, "(\"%s\", \"%s\", dict(", group->name, law->name);
    for (const struct field *field = law->fields; field->name; field++)
        fprintf(stream, "%s%s=%.15g", field == law->fields ? "" : ", ", field->name,
                mf_bonded_number(&group->curve, field->name) * unit_of(job, field->unit));
    fprintf(stream, "))");
}

void mf_export_terms_head(const struct export_job *job, FILE *stream) {
    const struct molecules *molecules = job->model->molecules;
    fprintf(stream, "# of each kind of terms its groups (name, law, numbers; angles in radians), "
                    "and rows of group and beads\nterms = {}\n");
    for (int order = 0; order < BONDED_KINDS; order++) {
        const char *kind = mf_bonded_kinds[order]->plural;
        if (mf_topology_terms(&molecules->topology, order) == 0)
            continue;
        fprintf(stream, "terms[\"%s\"] = [\n", kind);
        for (int g = 0; g < molecules->groups[order]; g++) {
            fprintf(stream, "    ");
            print_group(job, order, g, stream);
            fprintf(stream, ",\n");
        }
        fprintf(stream, "], numpy.loadtxt(\"%s.txt\", dtype=int, ndmin=2)\n", kind);
    }
    fprintf(stream, molecules->topology.excludes
                        ? "excluded = numpy.loadtxt(\"exclusions.txt\", dtype=int, ndmin=2)\n\n"
                        : "excluded = numpy.empty((0, 2), dtype=int)\n\n");
}
