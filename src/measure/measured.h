// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What is measured of the frames of a trajectory, over beads.
///
/// All numbers are in nm, ps, u and kJ/mol: these are the reduced units of λ = 1 nm, μ = 1 u and
/// k_B T_0 = 1 kJ/mol, of which τ is 1 ps, so that the accumulators of observe/ take them as they
/// are.
#pragma once

#include "measure/frame_features.h"
#include "measure/frame_forces.h"
#include "measure/frame_pairs.h"
#include "measure/measured_molecules.h"
#include "measure/measured_motion.h"
#include "observe/bonded_distribution.h"
#include "observe/density_profile.h"
#include "observe/measure.h"
#include "observe/rdf_observable.h"
#include "observe/structure_factor.h"
#include "trajectory/mapping.h"

struct measured_plan {
    double range;  ///< of g(r) [nm]
    double height; ///< least of the boxes, by which ranges that are 0 go; 0: the first's
    int64_t bins;  ///< of it
    struct structure_factor_settings waves; ///< q_maximum NAN: 4π ρ^(1/3); 0: it is not measured;
                                            ///< 0 bins, waves: 100, 10
    struct density_profile_settings profile;   ///< 0 bins: it is not measured
    struct weighted_density_settings weighted; ///< without a cutoff it is not measured
    double force_cutoff; ///< of pairs whose forces are matched [nm]; 0: forces are not looked at
    struct measured_motion_plan motion;
    struct measured_molecules_plan molecules; ///< all zero: nobody tells of them
    int threads;
};

/// Observables at most: g(r) in all and between molecules, waves, profile, sizes, and all orders.
enum { MEASURED_MAX = 5 + (int)BONDED_KINDS };

struct measured {
    struct measured_plan plan;
    bool in_vacuum;                ///< there is no box: nothing but molecules is measured
    const struct mapping *mapping; ///< borrowed
    struct frame_pairs_plan pairs;
    double share[COMPOSITION_MAX_PAIRS]; ///< of a type's pairs that are not of one molecule
    uint32_t *molecule;                  ///< shape [beads], of what has several beads
    struct measured_slot {
        struct trajectory_frame beads;
        struct box_vectors box;
        int32_t *place[3]; ///< shape [beads]
        struct frame_pairs pairs;
        struct frame_forces forces;
        double *weighted; ///< shape [beads]
    } * slot;             ///< one for each frame of a batch
    size_t slots;
    struct measured_molecules molecules;
    double *mass;                       ///< shape [beads] [u]; NULL: not all are known
    struct configuration_counts counts; ///< of the frame that is added
    struct configuration configuration; ///< the same
    /// Ended by one without an observable. g(r) is with `molecules` of all pairs that they do not
    /// exclude, else of beads of different residues or molecules.
    struct observable_use use[MEASURED_MAX + 1];
    struct weighted_density weighted;
    struct measured_motion motion;
    struct frame_forces_plan forces; ///< of frames that have them
    struct frame_features features;  ///< by which it is seen where equilibrium begins
    size_t frames;
    struct sample_series volume; ///< [nm³]
};

/// Prepare for the frames of a mapping, whose types must be names of types of beads. `first` is a
/// frame with the box that says what range there may be; with molecules it need have none. Fails:
/// BAD_INPUT, NO_MEMORY.
enum status mf_measured_begin(struct measured *measured, const struct measured_plan *plan,
                              const struct mapping *mapping,
                              const struct trajectory_frame *first) MUST_USE;

/// Add frames in their order, the first two together; the same bits for any number of threads, and
/// however many come at a time. Fails: BAD_INPUT, naming the frame; NO_MEMORY. Tested:
/// test_measured.
enum status mf_measured_add(struct measured *measured, const struct trajectory_frame *frames,
                            size_t count) MUST_USE;

/// When all frames have been added: the mean interval, and bins as wide as distributions ask for.
void mf_measured_end(struct measured *measured);

/// How wide the distribution of a group is, of an order of which there are groups.
/// Fails: NO_MEMORY.
enum status mf_measured_moments(const struct measured *measured, int order, int group,
                                struct bonded_moments *moments) MUST_USE;

/// The means of two parts that the lengths of a group of bonds have, as
/// mf_bonded_distribution_parts, else NaN; and which share of them is beyond all bins, that is
/// twice the longest mean of a group in the first frame. Fails: NO_MEMORY.
struct measured_lengths {
    size_t bonds;
    double part[2], beyond, end; ///< end: of the bins
};
enum status mf_measured_lengths(const struct measured *measured, int group,
                                struct measured_lengths *lengths) MUST_USE;

/// The state of an observable that is measured, NULL of one that is not, and g(r), if there is one.
const void *mf_measured_state(const struct measured *measured, const struct observable *observable);
const struct rdf *mf_measured_rdf(const struct measured *measured);

/// The least of the heights of these frames' boxes, and of `least` [nm].
double mf_measured_height(const struct trajectory_frame *frames, size_t count, double least);

/// Whether a box of such a height holds the ranges that were not asked for, of g(r) and of escape
/// times, which the first box or the plan's height has given.
bool mf_measured_fits(const struct measured *measured, const struct measured_plan *asked,
                      double height);

void mf_measured_clear(struct measured *measured);

/// The units of all that is measured, for results in those of `system`.
struct units mf_measured_units(int system);

/// The mean of a series of frames, NAN of none; its standard error, NAN if it is not known, unless
/// that is NULL.
double mf_measured_mean(const struct sample_series *series, double *error);

/// Cube of the mean volume.
struct box mf_measured_box(const struct measured *measured);

/// Find the weighted densities of a frame of beads with its places, if there is a weight, by any
/// thread. Fails: BAD_INPUT if the box is too small; NO_MEMORY.
enum status mf_measured_weigh(const struct measured *measured, struct measured_slot *slot) MUST_USE;

// The normal equations of force matching. Nothing is done where they are not asked for; frames
// without forces are passed over.

/// Fewer frames with forces tell no errors.
enum { MEASURED_FORCES_FEWEST = 8 };

/// Choose the nodes by the first frame with forces, once there is one. Fails: as
/// mf_frame_forces_begin; BAD_INPUT if the range is longer than the box allows, or many frames have
/// no forces.
enum status mf_measured_forces_begin(struct measured *measured,
                                     const struct trajectory_frame *frames, size_t count) MUST_USE;

/// Of a frame of beads with its places, by any thread. Fails: NO_MEMORY.
enum status mf_measured_forces_look(const struct measured *measured,
                                    struct measured_slot *slot) MUST_USE;

/// Add it, in the order of frames.
void mf_measured_forces_add(struct measured *measured, const struct measured_slot *slot);

/// Whether there were enough of them. Fails: BAD_INPUT, naming the file.
enum status mf_measured_forces_check(const struct measured *measured, const char *file) MUST_USE;
