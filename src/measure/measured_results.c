// SPDX-License-Identifier: GPL-3.0-or-later
//
// What is asked of a measurement that is over.
#include "base/memory.h"
#include "measure/measured.h"

#include <math.h>

enum status mf_measured_moments(const struct measured *measured, int order, int group,
                                struct bonded_moments *moments) {
    const void *const state = mf_measured_state(measured, mf_bonded_distribution_of(order));
    struct bonded_bins bins;
    OWNED double *counts = mf_bonded_distribution_counts(state, group, &bins);
    if (counts == NULL)
        return STATUS_NO_MEMORY;
    *moments = mf_bonded_distribution_moments(&bins, counts);
    return STATUS_OK;
}

enum status mf_measured_lengths(const struct measured *measured, int group,
                                struct measured_lengths *lengths) {
    const void *const state = mf_measured_state(measured, mf_bonded_distribution_of(BONDED_BOND));
    const struct topology *const topology = &measured->molecules.molecules->topology;
    lengths->bonds = mf_bonded_distribution_terms(topology, BONDED_BOND, group);
    const double all = (double)measured->frames * (double)lengths->bonds;
    struct bonded_bins bins;
    double inside = 0;
    OWNED double *counts = mf_bonded_distribution_counts(state, group, &bins);
    if (counts == NULL)
        return STATUS_NO_MEMORY;
    mf_bonded_distribution_parts(&bins, counts, lengths->part);
    for (size_t k = 0; k < bins.count; k++)
        inside += counts[k];
    lengths->beyond = 1 - inside / all;
    lengths->end = bins.low + (double)bins.count * bins.width;
    return STATUS_OK;
}

const void *mf_measured_state(const struct measured *measured,
                              const struct observable *observable) {
    const struct observable_use *use = measured->use;
    while (use->observable && use->observable != observable)
        use++;
    return use->state;
}

const struct rdf *mf_measured_rdf(const struct measured *measured) {
    const struct rdf_observed *const observed = mf_measured_state(measured, &mf_rdf_observable);
    return &observed->counted;
}

double mf_measured_mean(const struct sample_series *series, double *error) {
    struct running_mean mean = {0};
    for (size_t k = 0; k < series->count; k++)
        mf_statistics_add(&mean, series->values[k]);
    if (error)
        *error = series->count < 2
                     ? NAN
                     : mf_statistics_correlated_error(series->values, series->count, 1);
    return series->count > 0 ? mean.mean : NAN;
}

struct box mf_measured_box(const struct measured *measured) {
    return mf_box_cube(mf_measured_mean(&measured->volume, NULL));
}

struct units mf_measured_units(int system) {
    return (struct units){.length = 1,
                          .temperature = 1e3 / (UNITS_BOLTZMANN * UNITS_AVOGADRO),
                          .mass = UNITS_ATOMIC_MASS,
                          .system = system};
}

static bool are_asked_for(const struct measured *measured) {
    return measured->plan.force_cutoff > 0;
}

static enum status fail_without(const char *file) {
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: has no forces, which --forces needs: of GROMACS a .trr (mdrun with "
                          "nstfout), of LAMMPS a dump with fx fy fz, of H5MD the element \"force\"",
                          file);
}

/// The force of a density is one between pairs, which are looked at as far as theirs.
static enum status choose_weight(const struct measured *measured, struct frame_forces_plan *plan) {
    const struct weighted_density_settings *const weight = &measured->plan.weighted;
    if (weight->cutoff > plan->cutoff)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "--forces %g: they must reach as far as --weighted-density, %g nm",
                              plan->cutoff, weight->cutoff);
    plan->weight = weight->cutoff > 0 ? weight : NULL;
    return STATUS_OK;
}

static enum status begin(struct measured *measured, const struct trajectory_frame *frame) {
    struct measured_slot *const slot = measured->slot;
    struct frame_forces_plan *const plan = &measured->forces;
    plan->cutoff = measured->plan.force_cutoff;
    TRY(choose_weight(measured, plan));
    plan->pairs = &measured->pairs;
    plan->molecules = &measured->molecules;
    TRY(mf_mapping_apply(measured->mapping, frame, &slot->beads));
    TRY(mf_frame_box_find(&slot->box, &slot->beads));
    TRY(mf_frame_box_check_range(&slot->box, &slot->beads, plan->cutoff, "the range of --forces"));
    TRY(mf_frame_box_places(&slot->box, &slot->beads, slot->place));
    TRY(mf_measured_weigh(measured, slot));
    return mf_frame_forces_begin(plan, &slot->box, &slot->beads, slot->place, slot->weighted);
}

enum status mf_measured_forces_begin(struct measured *measured,
                                     const struct trajectory_frame *frames, size_t count) {
    enum { WITHOUT = 100 };
    if (!are_asked_for(measured) || measured->forces.equations.size > 0)
        return STATUS_OK;
    if (measured->in_vacuum)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: frame %zu: --forces needs a box (--box)",
                              frames->file, frames->number);
    for (size_t k = 0; k < count; k++)
        if (frames[k].has_forces)
            return begin(measured, &frames[k]);
    return measured->frames > WITHOUT ? fail_without(frames->file) : STATUS_OK;
}

enum status mf_measured_forces_look(const struct measured *measured, struct measured_slot *slot) {
    if (!are_asked_for(measured) || !slot->beads.has_forces)
        return STATUS_OK;
    TRY(mf_frame_box_check_range(&slot->box, &slot->beads, measured->forces.cutoff,
                                 "the range of --forces"));
    TRY(mf_frame_forces_find(&slot->forces, &measured->forces, &slot->box, &slot->beads,
                             slot->place, slot->weighted));
    if (slot->forces.square > 0 && isfinite(slot->forces.square))
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT, "%s: frame %zu: %s", slot->beads.file,
                          slot->beads.number,
                          slot->forces.square > 0 ? "its forces are too large"
                                                  : "all forces are 0: give frames that have them");
}

void mf_measured_forces_add(struct measured *measured, const struct measured_slot *slot) {
    if (!are_asked_for(measured) || !slot->beads.has_forces)
        return;
    for (size_t k = 0; k < slot->beads.atoms; k++) {
        const double *const force = slot->beads.force[k];
        if (force[0] != 0 || force[1] != 0 || force[2] != 0)
            measured->forces.pushed[k] = true;
    }
    mf_force_equations_add(&measured->forces.equations, slot->forces.gram, slot->forces.product,
                           slot->forces.virial, slot->forces.square);
}

/// Those of a group that was not written are 0.
static enum status check_beads(const struct measured *measured, const char *file) {
    const size_t beads = (size_t)measured->forces.equations.beads;
    size_t still = 0;
    for (size_t k = 0; k < beads; k++)
        still += !measured->forces.pushed[k];
    if (still == 0)
        return STATUS_OK;
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: the forces of %zu of %zu beads are 0 in all frames: --forces needs "
                          "those of all atoms, of which none is frozen",
                          file, still, beads);
}

enum status mf_measured_forces_check(const struct measured *measured, const char *file) {
    const size_t frames = measured->forces.equations.frames;
    if (!are_asked_for(measured))
        return STATUS_OK;
    if (frames >= MEASURED_FORCES_FEWEST)
        return check_beads(measured, file);
    if (frames == 0)
        return fail_without(file);
    return mf_status_fail(
        STATUS_BAD_INPUT, "%s: %zu frame%s with forces tell%s no errors: --forces needs %d or more",
        file, frames, frames == 1 ? "" : "s", frames == 1 ? "s" : "", MEASURED_FORCES_FEWEST);
}
