// SPDX-License-Identifier: GPL-3.0-or-later
#include "topologies/lammps_styles.h"

#include "base/fields.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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

enum status mf_lammps_style_create(struct bonded_curve *curve, int order, const char *style,
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
