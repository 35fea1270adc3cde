// SPDX-License-Identifier: GPL-3.0-or-later
#include "topologies/lammps_topology.h"

#include "base/fields.h"
#include "base/memory.h"
#include "io/text_file.h"
#include "topologies/lammps_kinds.h"
#include "topologies/lammps_terms.h"
#include "trajectory/trajectory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Styles, and the laws that they are (manual, bond_style, angle_style, dihedral_style) ------------

/// Numbers of a line, which become those of a law, and what they are measured in.
struct numbers {
    const double *number;
    int count;
    double length, energy; ///< λ, k_B T_0
};

struct style {
    int order;
    const char *name;
    int min, max; ///< numbers
    const struct bonded_law *law;
    /// False if a number is none that the law can have.
    bool (*fill)(struct bonded_curve *curve, const struct numbers *numbers);
    const char *note;
};

// Numbers of laws ---------------------------------------------------------------------------------

/// K (r − r_0)²: K is k/2.
static bool fill_bond(struct bonded_curve *curve, const struct numbers *of) {
    return mf_bonded_set_number(curve, "k",
                                2 * of->number[0] * of->energy / (of->length * of->length)) &&
           mf_bonded_set_number(curve, "length", of->number[1] * of->length);
}

static bool fill_fene(struct bonded_curve *curve, const struct numbers *of) {
    return mf_bonded_set_number(curve, "k",
                                of->number[0] * of->energy / (of->length * of->length)) &&
           mf_bonded_set_number(curve, "longest", of->number[1] * of->length);
}

/// K (θ − θ_0)² and K (cos θ − cos θ_0)².
static bool fill_angle(struct bonded_curve *curve, const struct numbers *of) {
    return mf_bonded_set_number(curve, "k", 2 * of->number[0] * of->energy) &&
           mf_bonded_set_number(curve, "angle", of->number[1]);
}

static bool fill_cosine(struct bonded_curve *curve, const struct numbers *of) {
    return mf_bonded_set_number(curve, "k", of->number[0] * of->energy);
}

/// K [1 + cos(n φ − d)] with a weight of pairs four beads apart, which is to be 0.
static bool fill_charmm(struct bonded_curve *curve, const struct numbers *of) {
    return of->number[3] == 0 && mf_bonded_set_number(curve, "k", of->number[0] * of->energy) &&
           mf_bonded_set_number(curve, "multiplicity", of->number[1]) &&
           mf_bonded_set_number(curve, "phase", of->number[2]);
}

/// K [1 + d cos(n φ)], d = ±1.
static bool fill_harmonic(struct bonded_curve *curve, const struct numbers *of) {
    return fabs(of->number[1]) == 1 &&
           mf_bonded_set_number(curve, "k", of->number[0] * of->energy) &&
           mf_bonded_set_number(curve, "multiplicity", of->number[2]) &&
           mf_bonded_set_number(curve, "phase", of->number[1] > 0 ? 0 : 180);
}

/// Σ A_n (cos φ)^n: our angle is 0 at trans, so that odd powers change their sign.
static bool fill_powers(struct bonded_curve *curve, const double *a, int count, double energy) {
    static const char *const names[] = {"c0", "c1", "c2", "c3", "c4", "c5"};
    bool good = true;
    for (int n = 0; n < 6 && good; n++)
        good =
            mf_bonded_set_number(curve, names[n], n < count ? (n % 2 ? -a[n] : a[n]) * energy : 0);
    return good;
}

static bool fill_multi(struct bonded_curve *curve, const struct numbers *of) {
    return fill_powers(curve, of->number, of->count, of->energy);
}

static bool fill_nharmonic(struct bonded_curve *curve, const struct numbers *of) {
    return of->number[0] == of->count - 1 &&
           fill_powers(curve, of->number + 1, of->count - 1, of->energy);
}

/// ½ K_1 (1 + cos φ) + ½ K_2 (1 − cos 2φ) + ½ K_3 (1 + cos 3φ) + ½ K_4 (1 − cos 4φ).
static bool fill_opls(struct bonded_curve *curve, const struct numbers *of) {
    const double *k = of->number;
    const double a[] = {0.5 * (k[0] + k[2]) + k[1], 0.5 * k[0] - 1.5 * k[2], 4 * k[3] - k[1],
                        2 * k[2], -4 * k[3]};
    return fill_powers(curve, a, 5, of->energy);
}

// Styles ------------------------------------------------------------------------------------------

static const struct style styles[] = {
    {BONDED_BOND, "harmonic", 2, 2, &mf_bond_harmonic, fill_bond, NULL},
    {BONDED_BOND, "fene", 4, 4, &mf_bond_fene, fill_fene,
     "epsilon and sigma of fene are not used: pairs repel each other by \"conservative\", with "
     "\"exclude\": 0"},
    {BONDED_ANGLE, "harmonic", 2, 2, &mf_angle_harmonic, fill_angle, NULL},
    {BONDED_ANGLE, "cosine", 1, 1, &mf_angle_cosine, fill_cosine, NULL},
    {BONDED_ANGLE, "cosine/squared", 2, 2, &mf_angle_cosine_squared, fill_angle, NULL},
    {BONDED_DIHEDRAL, "charmm", 4, 4, &mf_dihedral_periodic, fill_charmm, NULL},
    {BONDED_DIHEDRAL, "harmonic", 3, 3, &mf_dihedral_periodic, fill_harmonic, NULL},
    {BONDED_DIHEDRAL, "multi/harmonic", 5, 5, &mf_dihedral_ryckaert_bellemans, fill_multi, NULL},
    {BONDED_DIHEDRAL, "nharmonic", 2, 7, &mf_dihedral_ryckaert_bellemans, fill_nharmonic, NULL},
    {BONDED_DIHEDRAL, "opls", 4, 4, &mf_dihedral_ryckaert_bellemans, fill_opls, NULL},
};
enum { STYLES = sizeof styles / sizeof *styles };

static const struct style *find_style(int order, const char *name, char known[160]) {
    known[0] = '\0';
    for (size_t k = 0; k < STYLES; k++) {
        if (styles[k].order != order)
            continue;
        if (strcmp(styles[k].name, name) == 0)
            return &styles[k];
        const size_t length = strlen(known);
        snprintf(known + length, 160 - length, "%s%s", length ? ", " : "", styles[k].name);
    }
    return NULL;
}

/// Make the curve of a style from the numbers after its name in a line of coefficients.
static enum status make_law(struct bonded_curve *curve, int order, const char *style,
                            const double *number, int count, double length, double energy,
                            const char **note) {
    char known[160];
    const struct style *found = find_style(order, style, known);
    if (found == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "style \"%.40s\" is not supported; use %s", style,
                              known);
    if (count < found->min || count > found->max)
        return mf_status_fail(STATUS_BAD_INPUT, "%d numbers, and %s has %d", count, style,
                              found->min);
    TRY(mf_bonded_create(curve, found->law));
    if (found->fill(curve, &(struct numbers){number, count, length, energy})) {
        *note = found->note && number[2] != 0 ? found->note : NULL;
        return STATUS_OK;
    }
    mf_bonded_clear(curve);
    return mf_status_fail(STATUS_BAD_INPUT, "the law \"%s\" cannot have these numbers%s",
                          found->law->name,
                          found->fill == fill_charmm ? "; the last weight must be 0" : "");
}

// Files -------------------------------------------------------------------------------------------

bool mf_lammps_topology_is(const char *file) {
    const char *slash = strrchr(file, '/'), *name = slash ? slash + 1 : file;
    const char *dot = strrchr(name, '.');
    return (dot && strcmp(dot, ".data") == 0) || strncmp(name, "data.", 5) == 0;
}

// Units -------------------------------------------------------------------------------------------

/// A unit of length and of energy of LAMMPS (manual, units): Å, and kcal/mol or eV.
static const struct scale {
    const char *name;
    double length, energy; ///< [nm], [kJ/mol]
} scales[] = {{"real", 0.1, 4.184}, {"metal", 0.1, 96.48533212331002}, {"lj", 1, 1}};
enum { SCALES = sizeof scales / sizeof *scales, LJ = SCALES - 1 };

static const struct scale *find_scale(const char *name) {
    for (size_t k = 0; k < SCALES; k++)
        if (strcmp(scales[k].name, name) == 0)
            return &scales[k];
    return NULL;
}

/// The units that the first line of a file tells, or "".
static void find_units(const char *text, char units[TOPOLOGY_NAME_SIZE]) {
    static const char key[] = "units = ";
    char title[512];
    units[0] = '\0';
    snprintf(title, sizeof title, "%.*s", (int)strcspn(text, "\n"), text);
    const char *at = strstr(title, key);
    if (at)
        snprintf(units, TOPOLOGY_NAME_SIZE, "%.*s", (int)strcspn(at + strlen(key), " ,\t\r"),
                 at + strlen(key));
}

enum status mf_lammps_topology_units(const char *file, const char *given, const struct units *units,
                                     const char **style) {
    char *text, title[TOPOLOGY_NAME_SIZE];
    size_t length;
    const bool known = mf_units_known(units);
    TRY(mf_text_file_read(file, &text, &length));
    find_units(text, title);
    mf_memory_free(text);
    if (title[0] && given[0] && strcmp(title, given) != 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s:1: the file has the units \"%s\"", file, title);
    const char *name = given[0] ? given : title[0] ? title : known ? "real" : "lj";
    const struct scale *scale = find_scale(name);
    if (scale == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s:1: unknown units \"%s\"; expected real, metal or lj", file, name);
    if (scale == &scales[LJ] && known)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: units of \"lj\" are for a scene without \"units\"", file);
    *style = scale->name;
    return STATUS_OK;
}

// Groups ------------------------------------------------------------------------------------------

struct reading {
    struct molecules *molecules;
    const char *file;
    double length, energy; ///< the file's units in λ, k_B T_0
    struct lammps_terms terms;
    int *group[BONDED_KINDS]; ///< shape [terms]: of each
    char *note;
};

/// The group of a type of terms: the scene's of that name, or a new one with its coefficients.
static enum status find_group(struct reading *reading, int order, int type, size_t line,
                              int *group_of_type) {
    struct molecules *molecules = reading->molecules;
    const struct lammps_coefficient *coefficient = &reading->terms.coefficient[order][type];
    char name[TOPOLOGY_NAME_SIZE];
    const char *note = NULL;
    int g = 0;
    snprintf(name, sizeof name, "%d", type);
    while (g < molecules->groups[order] && strcmp(molecules->group[order][g].name, name) != 0)
        g++;
    *group_of_type = g;
    if (g < molecules->groups[order])
        return STATUS_OK;
    if (coefficient->line == 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s:%zu: type %d of %ss has no coefficients here, and no law \"%d\" "
                              "in the scene's",
                              reading->file, line, type, mf_bonded_kinds[order]->name, type);
    if (g == MOLECULES_MAX_GROUPS)
        return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: there are more than %d types of %ss",
                              reading->file, line, MOLECULES_MAX_GROUPS,
                              mf_bonded_kinds[order]->name);
    struct molecules_group *group = &molecules->group[order][g];
    const enum status status =
        make_law(&group->curve, order, coefficient->style, coefficient->number, coefficient->count,
                 reading->length, reading->energy, &note);
    if (status != STATUS_OK)
        return mf_status_prefix(status, "%s:%zu", reading->file, coefficient->line);
    memcpy(group->name, name, sizeof name);
    molecules->groups[order]++;
    if (note && reading->note[0] == '\0')
        snprintf(reading->note, LAMMPS_NOTE_SIZE, "%.100s:%zu: %s", reading->file,
                 coefficient->line, note);
    return STATUS_OK;
}

static enum status find_groups(struct reading *reading, int order,
                               const struct structure_terms *terms) {
    const size_t types = (size_t)reading->terms.types[order];
    OWNED int *of_type = NULL; // −1: no term before has the type
    TRY_ARRAY(of_type, types + 1);
    memset(of_type, 0xff, (types + 1) * sizeof *of_type);
    for (size_t n = 0; n < terms->count; n++) {
        const uint32_t type = terms->type[n];
        if (of_type[type] < 0)
            TRY(find_group(reading, order, (int)type, reading->terms.line[order][n],
                           &of_type[type]));
        reading->group[order][n] = of_type[type];
    }
    return STATUS_OK;
}

// The file ----------------------------------------------------------------------------------------

static enum status read_terms(struct reading *reading, const struct trajectory *trajectory) {
    TRY(mf_lammps_terms_read(&reading->terms, &trajectory->structure, &trajectory->first));
    for (int order = 0; order < BONDED_KINDS; order++)
        TRY_ARRAY(reading->group[order], trajectory->structure.terms[order].count);
    return STATUS_OK;
}

static void clear(struct reading *reading) {
    for (int order = 0; order < BONDED_KINDS; order++)
        mf_memory_free(reading->group[order]);
    mf_lammps_terms_clear(&reading->terms);
}

static enum status find_kinds(const struct reading *reading, const struct structure *structure,
                              int exclude, struct topology *topology,
                              struct composition *composition, size_t **order) {
    return mf_lammps_kinds_find(&(struct lammps_kinds_source){.file = reading->file,
                                                              .structure = structure,
                                                              .group = reading->group,
                                                              .exclude = exclude},
                                topology, composition, order);
}

enum status mf_lammps_topology_read(struct molecules *molecules, struct composition *composition,
                                    const char *file, const struct units *units, const char *style,
                                    int exclude, size_t **order, char note[LAMMPS_NOTE_SIZE]) {
    enum status status = STATUS_OK;
    const struct trajectory_options options = {.units = style};
    const struct scale *scale = find_scale(style);
    const bool known = mf_units_known(units);
    struct reading reading = {.molecules = molecules,
                              .file = file,
                              .length = scale->length / (known ? units->length : 1),
                              .energy =
                                  scale->energy / (known ? mf_units_energy_kj_per_mol(units) : 1),
                              .note = note};
    struct trajectory trajectory;
    note[0] = '\0';
    *order = NULL;
    TRY(mf_trajectory_open(&trajectory, file, &options));
    CHECK(read_terms(&reading, &trajectory));
    for (int n = 0; n < BONDED_KINDS; n++)
        CHECK(find_groups(&reading, n, &trajectory.structure.terms[n]));
    CHECK(find_kinds(&reading, &trajectory.structure, exclude, &molecules->topology, composition,
                     order));
done:
    clear(&reading);
    mf_trajectory_close(&trajectory);
    return status;
}

/// Whether two kinds are as many molecules of the same types with as many terms.
static bool are_alike(const struct topology_kind *a, const struct composition *of_a,
                      const struct topology_kind *b, const struct composition *of_b) {
    if (a->count != b->count || a->beads != b->beads ||
        memcmp(a->terms, b->terms, sizeof a->terms) != 0)
        return false;
    for (int bead = 0; bead < a->beads; bead++)
        if (strcmp(of_a->name[a->type[bead]], of_b->name[b->type[bead]]) != 0)
            return false;
    return true;
}

enum status mf_lammps_topology_order(const char *file, const char *style,
                                     const struct topology *topology,
                                     const struct composition *composition, size_t **order) {
    enum status status = STATUS_OK;
    const struct trajectory_options options = {.units = style};
    struct reading reading = {.file = file};
    struct trajectory trajectory;
    struct topology own = {0};
    struct composition types = {0};
    *order = NULL;
    TRY(mf_trajectory_open(&trajectory, file, &options));
    CHECK(read_terms(&reading, &trajectory));
    for (int n = 0; n < BONDED_KINDS; n++)
        for (size_t k = 0; k < trajectory.structure.terms[n].count; k++)
            reading.group[n][k] = (int)trajectory.structure.terms[n].type[k];
    CHECK(find_kinds(&reading, &trajectory.structure, 0, &own, &types, order));
    bool same = own.kinds == topology->kinds;
    for (int k = 0; k < own.kinds && same; k++)
        same = are_alike(&own.kind[k], &types, &topology->kind[k], composition);
    if (!same)
        status =
            mf_status_fail(STATUS_BAD_INPUT, "%s: its molecules are not those of the scene", file);
done:
    mf_topology_clear(&own);
    clear(&reading);
    mf_trajectory_close(&trajectory);
    return status;
}
