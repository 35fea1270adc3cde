// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/measured.h"

#include "base/memory.h"
#include "base/names.h"
#include "base/parallel.h"

#include <math.h>
#include <string.h>

/// Width of the bins of g(r), and the part of the least height to which it goes, unless given [nm].
static const double usual_width = 0.01, usual_part = 0.45;

/// Of a box that is so large that there would be more, bins are wider.
static const double most_bins = 100000;

/// S(q) goes to twice the wave number 2π ρ^(1/3), near which a liquid has its peak, in so many bins
/// of at most so many waves unless given: their cost grows with beads times waves.
enum { WAVE_BINS = 100, USUAL_WAVES = 10 };

// What the beads are ------------------------------------------------------------------------------

static enum status find_composition(const struct mapping *mapping,
                                    struct composition *composition) {
    const bool mixed = mapping->types > 1;
    if (mapping->types > COMPOSITION_MAX_TYPES)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "there are %zu types of beads; there may be %d: a map (--map) "
                              "makes fewer",
                              mapping->types, COMPOSITION_MAX_TYPES);
    *composition = (struct composition){.types = (int)mapping->types};
    for (size_t type = 0; type < mapping->types; type++) {
        const char *name = mapping->type_name[type];
        if (!mixed && !mf_composition_is_name(name))
            continue; // of what is all alike nobody need speak
        if (!mf_composition_is_name(name))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "the type of beads \"%s\": expected a type name of " NAMES_OF_TYPE
                                  "; give it another name in a map (--map)",
                                  name, COMPOSITION_NAME_SIZE - 1);
        snprintf(composition->name[type], COMPOSITION_NAME_SIZE, "%.*s", COMPOSITION_NAME_SIZE - 1,
                 name);
    }
    for (size_t k = 0; k < mapping->beads; k++)
        composition->count[mapping->bead[k].type]++;
    return STATUS_OK;
}

/// Molecules matter if one has several beads.
static enum status find_molecules(struct measured *measured) {
    const struct mapping *const mapping = measured->mapping;
    OWNED bool *seen = NULL;
    bool several = false;
    TRY_ARRAY(seen, mapping->atoms);
    TRY_ARRAY(measured->molecule, mapping->beads);
    for (size_t k = 0; k < mapping->beads; k++) {
        const size_t molecule = mapping->bead[k].molecule;
        several = several || seen[molecule];
        seen[molecule] = true;
        measured->molecule[k] = (uint32_t)molecule;
    }
    measured->pairs.molecule = several ? measured->molecule : NULL;
    return STATUS_OK;
}

/// The molecules that a file tells of: their pairs are counted apart.
static enum status take_molecules(struct measured *measured) {
    struct measured_molecules *const own = &measured->molecules;
    if (measured->plan.molecules.molecules == NULL)
        return STATUS_OK;
    TRY(mf_measured_molecules_begin(own, &measured->plan.molecules, measured->mapping,
                                    &measured->pairs.composition));
    const struct topology *const topology = &own->molecules->topology;
    for (size_t id = 0; id < topology->particles; id++)
        measured->molecule[own->bead[id]] = topology->molecule[id];
    measured->pairs.molecule = measured->molecule;
    measured->pairs.within = true;
    return STATUS_OK;
}

/// Which part of a type's pairs is looked at. What a file tells of molecules leaves out is taken as
/// missing, as simulations have it.
static enum status find_shares(struct measured *measured) {
    TRY(mf_frame_pairs_possible(&measured->pairs, measured->share));
    for (int pair = 0; pair < mf_composition_pairs(&measured->pairs.composition); pair++) {
        const double all = mf_composition_possible_pairs(&measured->pairs.composition, pair);
        const bool counted = measured->share[pair] > 0 && !measured->pairs.within;
        measured->share[pair] = counted ? measured->share[pair] / all : 1;
    }
    return STATUS_OK;
}

/// What is not given: equal bins of the usual width up to most of what the box allows.
static enum status find_bins(struct measured *measured, const struct box_vectors *box,
                             const struct trajectory_frame *first) {
    struct measured_plan *const plan = &measured->plan;
    if (plan->height == 0)
        plan->height = mf_box_vectors_min_height(box);
    if (plan->range == 0)
        plan->range = usual_width * floor(usual_part * plan->height / usual_width);
    if (!(plan->range > 0))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: frame %zu: the box is too small for a g(r): its shortest height "
                              "is %g nm; choose --range and --bins accordingly",
                              first->file, first->number, plan->height);
    if (plan->bins == 0)
        plan->bins = (int64_t)fmin(most_bins, fmax(1, rint(plan->range / usual_width)));
    measured->pairs.range = plan->range;
    measured->pairs.bins = (size_t)plan->bins;
    return STATUS_OK;
}

double mf_measured_height(const struct trajectory_frame *frames, size_t count, double least) {
    struct box_vectors box;
    for (size_t k = 0; k < count; k++)
        if (mf_frame_box_find(&box, &frames[k]) == STATUS_OK)
            least = fmin(least, mf_box_vectors_min_height(&box));
    return least;
}

bool mf_measured_fits(const struct measured *measured, const struct measured_plan *asked,
                      double height) {
    const bool range = asked->range > 0 || measured->pairs.range <= 0.5 * height;
    const bool escapes = asked->motion.leave_out || asked->motion.escape > 0 ||
                         height >= measured_motion_most * measured->plan.height;
    return measured->in_vacuum || (range && escapes);
}

/// What is known of beads in all frames.
static enum status describe(struct measured *measured) {
    const struct mapping *const mapping = measured->mapping;
    bool known = true;
    for (size_t k = 0; k < mapping->beads; k++)
        known = known && isfinite(mapping->bead[k].mass);
    if (known)
        TRY_ARRAY(measured->mass, mapping->beads);
    for (size_t k = 0; known && k < mapping->beads; k++)
        measured->mass[k] = mapping->bead[k].mass;
    measured->configuration = (struct configuration){.dimensions = 3,
                                                     .threads = measured->plan.threads,
                                                     .count = mapping->beads,
                                                     .composition = &measured->pairs.composition,
                                                     .molecules = measured->molecules.molecules,
                                                     .time_step = NAN,
                                                     .molecule = measured->pairs.molecule,
                                                     .counts = &measured->counts,
                                                     .mass = measured->mass};
    return STATUS_OK;
}

/// Begin to measure an observable, after those that are. @param[in] settings  NULL: the defaults
static enum status observe(struct measured *measured, const struct observable *observable,
                           const void *settings) {
    static const struct measure_plan plan = {.equilibration = -1, .every = 1};
    struct observable_use *use = measured->use;
    while (use->observable)
        use++;
    use->observable = observable;
    use->settings = mf_memory_zeroed(1, observable->settings_size);
    if (use->settings == NULL)
        return STATUS_NO_MEMORY;
    mf_fields_set_defaults(observable->fields, use->settings);
    if (settings)
        memcpy(use->settings, settings, observable->settings_size);
    return mf_observable_begin(use, &measured->configuration, &plan);
}

static void plan_waves(struct structure_factor_settings *waves, size_t beads, double volume) {
    if (isnan(waves->q_maximum))
        waves->q_maximum = 4 * acos(-1) * cbrt((double)beads / volume);
    if (waves->bins == 0)
        waves->bins = WAVE_BINS;
    if (waves->waves == 0)
        waves->waves = USUAL_WAVES;
}

static enum status begin_observables(struct measured *measured, const struct box_vectors *box) {
    struct measured_plan *const plan = &measured->plan;
    const struct rdf_settings pairs = {.range = plan->range, .bins = plan->bins};
    measured->configuration.box = *box;
    TRY(observe(measured, &mf_rdf_observable, &pairs));
    if (measured->molecules.molecules)
        TRY(observe(measured, &mf_rdf_intermolecular, &pairs));
    plan_waves(&plan->waves, measured->mapping->beads, box->volume);
    if (plan->waves.q_maximum > 0)
        TRY(observe(measured, &mf_structure_factor, &plan->waves));
    if (plan->profile.bins > 0)
        TRY(observe(measured, &mf_density_profile_observable, &plan->profile));
    return STATUS_OK;
}

/// Of a simulation in two dimensions density, g(r) and D would be those of three.
static enum status refuse_plane(const struct box_vectors *box,
                                const struct trajectory_frame *first) {
    if (!mf_frame_box_is_plane(box, first))
        return STATUS_OK;
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s: frame %zu: all atoms lie in one plane: trajectories of two "
        "dimensions are not measured; g(r) that another program has of them is a "
        "target of a scene with \"dimensions\": 2 (a sheet that was flat at first "
        "is measured with a later --begin)",
        first->file, first->number);
}

static bool is_without_box(const struct trajectory_frame *frame) {
    bool periodic = false;
    for (int i = 0; i < 3; i++)
        periodic = periodic || frame->periodic[i];
    return !frame->has_box || !periodic;
}

enum status mf_measured_begin(struct measured *measured, const struct measured_plan *plan,
                              const struct mapping *mapping, const struct trajectory_frame *first) {
    enum status status = STATUS_OK;
    struct box_vectors box;
    *measured = (struct measured){.plan = *plan, .mapping = mapping, .volume.columns = 1};
    measured->in_vacuum =
        plan->molecules.molecules && plan->profile.bins == 0 && is_without_box(first);
    if (!measured->in_vacuum) {
        CHECK(mf_frame_box_find(&box, first));
        CHECK(refuse_plane(&box, first));
    }
    if (mapping->beads < 2)
        CHECK(mf_status_fail(STATUS_BAD_INPUT,
                             "%s: there is a single bead, and a measurement is of pairs of them (a "
                             "residue, by name and number, is a bead unless --map says more)",
                             first->file));
    CHECK(find_composition(mapping, &measured->pairs.composition));
    CHECK(find_molecules(measured));
    CHECK(take_molecules(measured));
    CHECK(describe(measured));
    if (measured->in_vacuum)
        goto done;
    CHECK(find_shares(measured));
    CHECK(find_bins(measured, &box, first));
    CHECK(begin_observables(measured, &box));
    const struct box cube = mf_box_cube(box.volume);
    if (plan->weighted.cutoff > 0)
        CHECK(mf_weighted_density_init(&measured->weighted, &plan->weighted, &cube, mapping->beads,
                                       0));
done:
    if (status != STATUS_OK)
        mf_measured_clear(measured);
    return status;
}

static void clear_slots(struct measured *measured) {
    for (size_t k = 0; k < measured->slots; k++) {
        struct measured_slot *const slot = &measured->slot[k];
        mf_frame_clear(&slot->beads);
        for (int d = 0; d < 3; d++)
            mf_memory_free(slot->place[d]);
        mf_frame_pairs_clear(&slot->pairs);
        mf_frame_forces_clear(&slot->forces);
        mf_memory_free(slot->weighted);
    }
    mf_memory_free(measured->slot);
    measured->slots = 0;
}

void mf_measured_clear(struct measured *measured) {
    clear_slots(measured);
    mf_memory_free(measured->molecule);
    mf_measured_molecules_clear(&measured->molecules);
    for (struct observable_use *use = measured->use; use->observable; use++) {
        mf_observable_end(use);
        mf_memory_free(use->settings);
    }
    mf_memory_free(measured->mass);
    mf_weighted_density_clear(&measured->weighted);
    mf_measured_motion_clear(&measured->motion);
    mf_frame_features_clear(&measured->features);
    mf_sample_series_clear(&measured->volume);
    mf_frame_forces_end(&measured->forces);
    *measured = (struct measured){0};
}

static enum status make_slots(struct measured *measured, size_t count) {
    if (count <= measured->slots)
        return STATUS_OK;
    clear_slots(measured);
    TRY_ARRAY(measured->slot, count);
    measured->slots = count;
    for (size_t k = 0; k < count; k++)
        for (int d = 0; d < 3; d++)
            TRY_ARRAY(measured->slot[k].place[d], measured->mapping->beads);
    for (size_t k = 0; measured->plan.weighted.cutoff > 0 && k < count; k++)
        TRY_ARRAY(measured->slot[k].weighted, measured->mapping->beads);
    return STATUS_OK;
}

// Frames ------------------------------------------------------------------------------------------

/// Frames that are looked at by several threads, each by one.
struct batch {
    struct measured *measured;
    const struct trajectory_frame *frame;
};

static enum status find_pairs(const struct measured *measured, struct measured_slot *slot) {
    TRY(mf_frame_pairs_count(&slot->pairs, &measured->pairs, &slot->box, slot->place));
    if (measured->pairs.within)
        mf_frame_pairs_exclude(&slot->pairs, &measured->pairs, slot->place,
                               measured->molecules.excluded, measured->molecules.excluded_count);
    return STATUS_OK;
}

enum status mf_measured_weigh(const struct measured *measured, struct measured_slot *slot) {
    const struct weighted_density_settings *const settings = &measured->plan.weighted;
    if (settings->cutoff == 0)
        return STATUS_OK;
    TRY(mf_frame_box_check_range(&slot->box, &slot->beads, settings->cutoff,
                                 "the cutoff of the weighted density"));
    const bool within = measured->pairs.within;
    return mf_frame_pairs_weigh(&slot->pairs, &measured->pairs, settings, &slot->box, slot->place,
                                within ? measured->molecules.excluded : NULL,
                                within ? measured->molecules.excluded_count : 0, slot->weighted);
}

static enum status look_at(void *context, size_t task, void *result) {
    const struct batch *const batch = context;
    struct measured *const measured = batch->measured;
    struct measured_slot *const slot = &measured->slot[task];
    (void)result;
    TRY(mf_mapping_apply(measured->mapping, &batch->frame[task], &slot->beads));
    if (measured->in_vacuum)
        return STATUS_OK;
    TRY(mf_frame_box_find(&slot->box, &slot->beads));
    TRY(mf_frame_box_check_range(&slot->box, &slot->beads, measured->pairs.range,
                                 "the range of g(r)"));
    TRY(mf_frame_box_places(&slot->box, &slot->beads, slot->place));
    TRY(mf_measured_weigh(measured, slot));
    TRY(mf_measured_forces_look(measured, slot));
    return find_pairs(measured, slot);
}

/// What observables are told of a frame in a box.
static void describe_frame(struct measured *measured, const struct measured_slot *slot) {
    const struct frame_pairs *const pairs = &slot->pairs;
    measured->counts =
        (struct configuration_counts){measured->pairs.within ? pairs->within : pairs->counts,
                                      pairs->counts, measured->pairs.bins + 1, measured->share};
    measured->configuration.box = slot->box;
    measured->configuration.fraction = slot->place;
}

/// What may not suit the box of a frame are waves.
static enum status observe_frame(struct measured *measured, const struct measured_slot *slot) {
    if (measured->molecules.molecules)
        mf_measured_molecules_place(&measured->molecules, &slot->beads);
    for (const struct observable_use *use = measured->use; use->observable; use++) {
        const enum status status = use->observable->sample(use->state, &measured->configuration);
        if (status == STATUS_BAD_INPUT)
            return mf_status_prefix(status, "%s: frame %zu: S(q), which --q-range 0 leaves out",
                                    slot->beads.file, slot->beads.number);
        TRY(status);
    }
    measured->frames++;
    return STATUS_OK;
}

static enum status add_one(struct measured *measured, const struct measured_slot *slot) {
    if (measured->in_vacuum)
        return observe_frame(measured, slot);
    describe_frame(measured, slot);
    TRY(observe_frame(measured, slot));
    if (slot->weighted)
        TRY(mf_weighted_density_add(&measured->weighted, slot->weighted, measured->mapping->beads));
    TRY(mf_frame_features_add(&measured->features, &measured->pairs, &slot->pairs,
                              slot->box.volume));
    mf_measured_forces_add(measured, slot);
    TRY(mf_measured_motion_add(&measured->motion, &slot->beads, &measured->configuration));
    return mf_sample_series_add(&measured->volume, &slot->box.volume);
}

static enum status begin_motion(struct measured *measured, const struct trajectory_frame *first,
                                size_t count) {
    struct box_vectors box;
    TRY(mf_frame_box_find(&box, first));
    return mf_measured_motion_begin(&measured->motion, &measured->plan.motion, measured->mapping,
                                    first, count, &box, measured->plan.height);
}

/// Bonds and sizes, of molecules that a file tells of. Times are printed for frames at equal
/// intervals.
static enum status begin_molecules(struct measured *measured, const struct trajectory_frame *frames,
                                   size_t count) {
    const struct molecules *const molecules = measured->molecules.molecules;
    const bool timed = count > 1 && !measured->plan.motion.leave_out;
    TRY(mf_mapping_apply(measured->mapping, frames, &measured->slot[0].beads));
    TRY(mf_measured_molecules_start(&measured->molecules, &measured->slot[0].beads));
    measured->configuration.particles = &measured->molecules.particles;
    measured->configuration.time_step = timed ? frames[1].time - frames[0].time : NAN;
    for (int order = 0; order < BONDED_KINDS; order++) {
        const struct bonded_settings settings = {.bins = mf_bonded_kinds[order]->fine};
        if (molecules->groups[order] > 0)
            TRY(observe(measured, mf_bonded_distribution_of(order), &settings));
    }
    return observe(measured, &mf_molecule_sizes, NULL);
}

enum status mf_measured_add(struct measured *measured, const struct trajectory_frame *frames,
                            size_t count) {
    struct batch batch = {measured, frames};
    const struct parallel_tasks tasks = {
        .count = count, .threads = measured->plan.threads, .run = look_at, .context = &batch};
    TRY(make_slots(measured, count));
    if (measured->frames == 0 && !measured->in_vacuum)
        TRY(begin_motion(measured, frames, count));
    if (measured->frames == 0 && measured->molecules.molecules)
        TRY(begin_molecules(measured, frames, count));
    TRY(mf_measured_forces_begin(measured, frames, count));
    TRY(mf_parallel_try(&tasks));
    for (size_t k = 0; k < count; k++)
        TRY(add_one(measured, &measured->slot[k]));
    return STATUS_OK;
}

void mf_measured_end(struct measured *measured) {
    mf_measured_motion_end(&measured->motion);
    for (const struct observable_use *use = measured->use; use->observable; use++)
        for (int order = 0; order < BONDED_KINDS; order++)
            if (use->observable == mf_bonded_distribution_of(order))
                mf_bonded_distribution_join(use->state);
}
