// SPDX-License-Identifier: GPL-3.0-or-later
//
// LAMMPS's styles of terms: K stands for k/2 where ours has a half, "fene" is without its
// Lennard-Jones part at epsilon 0, and "multi/harmonic" has powers of cos phi, which is −cos psi.
// Tables are read linearly between as many rows as they have.
#include "export/export_lammps_molecules.h"

#include "io/output.h"

#include <ctype.h>
#include <math.h>

// Laws --------------------------------------------------------------------------------------------

/// A law that LAMMPS has: its style, and what follows in the line of coefficients.
struct style {
    const struct bonded_law *law;
    const char *name;
    void (*print)(const struct export_units *units, const struct bonded_curve *curve, FILE *stream);
};

static void print_harmonic_bond(const struct export_units *units, const struct bonded_curve *curve,
                                FILE *stream) {
    fprintf(stream, "%.12g %.12g",
            0.5 * mf_bonded_number(curve, "k") * units->energy / pow(units->length, 2),
            mf_bonded_number(curve, "length") * units->length);
}

static void print_fene(const struct export_units *units, const struct bonded_curve *curve,
                       FILE *stream) {
    fprintf(stream, "%.12g %.12g 0 0",
            mf_bonded_number(curve, "k") * units->energy / pow(units->length, 2),
            mf_bonded_number(curve, "longest") * units->length);
}

static void print_angle(const struct export_units *units, const struct bonded_curve *curve,
                        FILE *stream) {
    fprintf(stream, "%.12g %.12g", 0.5 * mf_bonded_number(curve, "k") * units->energy,
            mf_bonded_number(curve, "angle"));
}

static void print_cosine(const struct export_units *units, const struct bonded_curve *curve,
                         FILE *stream) {
    fprintf(stream, "%.12g", mf_bonded_number(curve, "k") * units->energy);
}

static void print_cosines(const struct export_units *units, const struct bonded_curve *curve,
                          FILE *stream) {
    static const char *const c[] = {"c0", "c1", "c2", "c3", "c4"};
    for (int n = 0; n < 5; n++)
        fprintf(stream, "%s%.12g", n ? " " : "",
                (n % 2 ? -1 : 1) * mf_bonded_number(curve, c[n]) * units->energy);
}

/// The last number is the weight of pairs four beads apart.
static void print_periodic(const struct export_units *units, const struct bonded_curve *curve,
                           FILE *stream) {
    fprintf(stream, "%.12g %.0f %.0f 0.0", mf_bonded_number(curve, "k") * units->energy,
            mf_bonded_number(curve, "multiplicity"), mf_bonded_number(curve, "phase"));
}

static const struct style styles[] = {
    {&mf_bond_harmonic, "harmonic", print_harmonic_bond},
    {&mf_bond_fene, "fene", print_fene},
    {&mf_angle_harmonic, "harmonic", print_angle},
    {&mf_angle_cosine, "cosine", print_cosine},
    {&mf_angle_cosine_squared, "cosine/squared", print_angle},
    {&mf_dihedral_ryckaert_bellemans, "multi/harmonic", print_cosines},
    {&mf_dihedral_periodic, "charmm", print_periodic},
};

static const struct style table_style = {NULL, "table", NULL};

static const struct style *find_style(const struct bonded_curve *curve) {
    if (curve->law == &mf_dihedral_ryckaert_bellemans && mf_bonded_number(curve, "c5") != 0)
        return &table_style;
    if (curve->law == &mf_dihedral_periodic) {
        const double phase = mf_bonded_number(curve, "phase");
        if (phase != rint(phase))
            return &table_style;
    }
    for (size_t k = 0; k < sizeof styles / sizeof *styles; k++)
        if (styles[k].law == curve->law)
            return &styles[k];
    return &table_style;
}

bool mf_export_lammps_has_law(const struct bonded_curve *curve) {
    return find_style(curve) != &table_style;
}

// Exclusions --------------------------------------------------------------------------------------

/// Whether all molecules exclude the same pairs if that number is so large for all.
static enum status is_right(const struct topology *topology, int exclude, bool *right) {
    *right = true;
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        size_t count;
        TRY(mf_topology_count_excluded(kind, exclude, &count));
        *right = *right && count == (size_t)kind->near_start[kind->beads];
    }
    return STATUS_OK;
}

enum status mf_export_lammps_check(struct export_job *job) {
    if (job->model->molecules == NULL)
        return STATUS_OK;
    for (job->exclude = 0; job->exclude <= TOPOLOGY_MAX_EXCLUDE; job->exclude++) {
        bool right;
        TRY(is_right(&job->model->molecules->topology, job->exclude, &right));
        if (right)
            return STATUS_OK;
    }
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: cannot be exported: molecules have different \"exclude\", and "
                          "special_bonds of LAMMPS is one for all",
                          job->model->folder);
}

// Data --------------------------------------------------------------------------------------------

void mf_export_lammps_counts(const struct export_job *job, FILE *stream) {
    const struct molecules *molecules = job->model->molecules;
    for (int order = 0; order < BONDED_KINDS; order++)
        if (molecules->groups[order] > 0)
            fprintf(stream, "%zu %s\n%d %s types\n", mf_topology_terms(&molecules->topology, order),
                    mf_bonded_kinds[order]->plural, molecules->groups[order],
                    mf_bonded_kinds[order]->name);
}

size_t mf_export_lammps_molecule(const struct export_model *model, size_t particle) {
    const struct topology *topology = &model->molecules->topology;
    const uint32_t molecule = topology->molecule[particle];
    return molecule < (uint64_t)topology->molecules ? molecule + (size_t)1 : 0;
}

static void print_terms(const struct topology *topology, int order, FILE *stream) {
    size_t number = 0;
    for (int k = 0; k < topology->kinds; k++) {
        const struct topology_kind *kind = &topology->kind[k];
        for (int64_t m = 0; m < kind->count; m++)
            for (int n = 0; n < kind->terms[order]; n++) {
                const struct topology_term *term = &kind->term[order][n];
                fprintf(stream, "%zu %d", ++number, term->group + 1);
                for (int bead = 0; bead < mf_bonded_kinds[order]->beads; bead++)
                    fprintf(stream, " %u", topology_id(kind, m, term->bead[bead]) + 1);
                fprintf(stream, "\n");
            }
    }
}

void mf_export_lammps_terms(const struct export_job *job, FILE *stream) {
    const struct molecules *molecules = job->model->molecules;
    for (int order = 0; order < BONDED_KINDS; order++) {
        if (molecules->groups[order] == 0)
            continue;
        fprintf(stream, "\n%c%s\n\n", toupper(mf_bonded_kinds[order]->plural[0]),
                mf_bonded_kinds[order]->plural + 1);
        print_terms(&molecules->topology, order, stream);
    }
}

// Tables ------------------------------------------------------------------------------------------

static void print_key(const struct export_job *job, int order, int group, FILE *stream) {
    for (const char *letter = mf_bonded_kinds[order]->name; *letter; letter++)
        fputc(toupper(*letter), stream);
    fprintf(stream, "_%s", job->model->molecules->group[order][group].name);
}

static void print_table(const struct export_job *job, int order, int group, FILE *stream) {
    const struct export_bonded_table *table = &job->bonded.table[order][group];
    const struct export_units *units = &job->units;
    const struct bonded_kind *kind = mf_bonded_kinds[order];
    const double unit = kind->is_length ? units->length : 1 / kind->scale;
    fprintf(stream, "\n");
    print_key(job, order, group, stream);
    fprintf(stream, "\nN %zu%s\n\n", export_bonded_rows(&job->bonded, order),
            kind->periodic ? " DEGREES" : "");
    for (size_t k = 0; k < export_bonded_rows(&job->bonded, order); k++)
        fprintf(stream, "%zu %.15g %.15g %.15g\n", k + 1, table->q[k] * unit,
                table->energy[k] * units->energy, -table->slope[k] * units->energy / unit);
}

void mf_export_lammps_tables(const struct export_job *job, FILE *stream) {
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; g < job->model->molecules->groups[order]; g++)
            if (job->bonded.table[order][g].q)
                print_table(job, order, g, stream);
}

// Input -------------------------------------------------------------------------------------------

static const struct style *style_of(const struct export_job *job, int order, int group) {
    return find_style(&job->model->molecules->group[order][group].curve);
}

/// Whether a group before has the same style.
static bool was_named(const struct export_job *job, int order, int group) {
    for (int g = 0; g < group; g++)
        if (style_of(job, order, g) == style_of(job, order, group))
            return true;
    return false;
}

static bool is_hybrid(const struct export_job *job, int order) {
    for (int g = 1; g < job->model->molecules->groups[order]; g++)
        if (!was_named(job, order, g))
            return true;
    return false;
}

void mf_export_lammps_styles(const struct export_job *job, FILE *stream) {
    const struct molecules *molecules = job->model->molecules;
    for (int order = 0; order < BONDED_KINDS; order++) {
        if (molecules->groups[order] == 0)
            continue;
        fprintf(stream, "%s_style%s", mf_bonded_kinds[order]->name,
                is_hybrid(job, order) ? " hybrid" : "");
        for (int g = 0; g < molecules->groups[order]; g++) {
            const struct style *style = style_of(job, order, g);
            if (was_named(job, order, g))
                continue;
            fprintf(stream, " %s", style->name);
            if (style == &table_style)
                fprintf(stream, " linear %zu", export_bonded_rows(&job->bonded, order));
        }
        fprintf(stream, "\n");
    }
}

static void print_special(int exclude, FILE *stream) {
    fprintf(stream, "special_bonds lj/coul %d %d %d\n", exclude < 1, exclude < 2, exclude < 3);
}

void mf_export_lammps_coefficients(const struct export_job *job, FILE *stream) {
    const struct molecules *molecules = job->model->molecules;
    for (int order = 0; order < BONDED_KINDS; order++)
        for (int g = 0; g < molecules->groups[order]; g++) {
            const struct style *style = style_of(job, order, g);
            fprintf(stream, "%s_coeff %d ", mf_bonded_kinds[order]->name, g + 1);
            if (is_hybrid(job, order))
                fprintf(stream, "%s ", style->name);
            if (style == &table_style) {
                fprintf(stream, "mesofit.table ");
                print_key(job, order, g, stream);
            } else {
                style->print(&job->units, &molecules->group[order][g].curve, stream);
            }
            fprintf(stream, " # %s\n", molecules->group[order][g].name);
        }
    print_special(job->exclude, stream);
}

double mf_export_lammps_reach(const struct export_model *model) {
    static const double stretch = 1.5;
    if (model->molecules == NULL)
        return 0;
    double longest = mf_export_bonded_longest(model);
    bool far = false; // a term reaches beyond two bonds
    for (int order = 0; order < BONDED_KINDS; order++)
        far |= model->molecules->groups[order] > 0 && mf_bonded_kinds[order]->reach > 2;
    for (int g = 0; g < model->molecules->groups[BONDED_BOND]; g++)
        longest = fmax(longest, mf_bonded_rest(&model->molecules->group[BONDED_BOND][g].curve));
    return stretch * longest * (far ? 2 : 1);
}

// Energies of local densities ---------------------------------------------------------------------

bool mf_export_lammps_overlays(const struct export_job *job) {
    return job->densities.terms > 0;
}

static const char *name_of(const struct export_job *job, int term) {
    return mf_export_densities_of(job->model)->term[term].name;
}

/// Rows of a table, or as many zeros, of which LAMMPS reads any number a line.
static void print_rows(const struct export_grid *grid, double unit, FILE *stream) {
    enum { COLUMNS = 5 };
    for (size_t k = 0; k < grid->rows; k++)
        fprintf(stream, "%.15g%c", unit * grid->phi[k],
                (k + 1) % COLUMNS == 0 || k + 1 == grid->rows ? '\n' : ' ');
}

/// Three comments, of which LAMMPS looks into the first one for units; types, rows, cutoff.
static void print_head(const struct export_job *job, int term, FILE *stream) {
    const struct export_model *model = job->model;
    const struct export_units *units = &job->units;
    const struct export_density *table = &job->densities.table[term];
    const double unit = mf_export_density_unit(model, term, units->length);
    fprintf(stream,
            "# UNITS: %s\n# %s: f [%s] of the density rho, and its weight w(r), r [%s]\n# T1, "
            "T2, ... are the types:",
            units->system == EXPORT_REAL ? "real" : "lj", name_of(job, term), units->energy_name,
            units->length_name);
    for (int type = 0; type < model->types; type++)
        fprintf(stream, " %s", model->name[type]);
    fprintf(stream, "\n%d", model->types);
    for (int type = 0; type < model->types; type++)
        fprintf(stream, " T%d", type + 1);
    fprintf(stream, "\n%zu %.15g %zu %.15g %.15g\n", table->energy.rows, unit * table->energy.r[1],
            table->weight.rows, units->length * table->weight.r[1],
            units->length * weight_cutoff(&mf_export_densities_of(model)->term[term].weight));
}

static void print_density(const struct export_job *job, int term, FILE *stream) {
    const struct export_model *model = job->model;
    const struct many_body_term *of = &mf_export_densities_of(model)->term[term];
    const struct export_density *table = &job->densities.table[term];
    const double unit = mf_export_density_unit(model, term, job->units.length);
    print_head(job, term, stream);
    for (int type = 0; type < model->types; type++) {
        const bool counts = of->neighbours >> type & 1;
        fprintf(stream, "0 %.12g 0 none\n", model->mass[type] * job->units.mass);
        print_rows(&table->energy, of->central >> type & 1 ? job->units.energy : 0, stream);
        for (int at = 0; at < model->types; at++)
            print_rows(&table->weight, counts && of->central >> at & 1 ? unit : 0, stream);
    }
    for (int pair = 0; pair < job->grids.pairs; pair++)
        print_rows(&table->weight, 0, stream);
}

enum status mf_export_lammps_write_densities(const struct export_job *job) {
    for (int t = 0; t < job->densities.terms; t++) {
        struct output output;
        char path[OUTPUT_PATH_SIZE];
        snprintf(path, sizeof path, "%.3800s/%s.eam.fs", job->folder, name_of(job, t));
        TRY(mf_output_open(&output, path));
        print_density(job, t, output.stream);
        TRY(mf_output_commit(&output));
    }
    return STATUS_OK;
}

void mf_export_lammps_density_styles(const struct export_job *job, FILE *stream) {
    for (int t = 0; t < job->densities.terms; t++)
        fprintf(stream, " eam/fs");
    fprintf(stream, "\"");
}

void mf_export_lammps_density_coefficients(const struct export_job *job, FILE *stream) {
    for (int t = 0; t < job->densities.terms; t++) {
        fprintf(stream, " &\n  \"pair_coeff * * eam/fs ");
        if (job->densities.terms > 1) // which of the styles of this name
            fprintf(stream, "%d ", t + 1);
        fprintf(stream, "%s.eam.fs", name_of(job, t));
        for (int type = 0; type < job->model->types; type++)
            fprintf(stream, " T%d", type + 1);
        fprintf(stream, "\"");
    }
}
