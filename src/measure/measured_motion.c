// SPDX-License-Identifier: GPL-3.0-or-later
#include "measure/measured_motion.h"

#include "base/memory.h"
#include "io/units_scale.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const mf_measured_velocities[] = {"usual", "file", "differences", "none", NULL};

// Paths -------------------------------------------------------------------------------------------

/// Parts of the box: what counts as the same place, and as near half a box.
static const double same = 0.1, near_half = 0.45;

enum status mf_measured_path_init(struct measured_path *motion, size_t beads) {
    enum status status = STATUS_OK;
    *motion = (struct measured_path){.beads = beads};
    for (int d = 0; d < 3; d++) {
        NEW_ARRAY(motion->place[d], beads);
        NEW_ARRAY(motion->path[d], 3 * beads);
    }
    NEW_ARRAY(motion->state, 6 * beads);
    NEW_ARRAY(motion->boxes, 6 * beads);
done:
    if (status != STATUS_OK)
        mf_measured_path_clear(motion);
    return status;
}

void mf_measured_path_clear(struct measured_path *motion) {
    for (int d = 0; d < 3; d++) {
        mf_memory_free(motion->place[d]);
        mf_memory_free(motion->path[d]);
    }
    mf_memory_free(motion->state);
    mf_memory_free(motion->boxes);
    *motion = (struct measured_path){0};
}

/// The oldest path makes room for the present one.
static void turn(struct measured_path *motion) {
    double *const oldest = motion->path[0];
    motion->path[0] = motion->path[1];
    motion->path[1] = motion->path[2];
    motion->path[2] = oldest;
}

/// Fractions of the box with the images.
static void find_boxes(const struct measured_path *motion, const struct trajectory_frame *beads,
                       double *boxes) {
    double inverse[3][3];
    mf_frame_reciprocal(beads, inverse);
    for (int i = 0; i < 3; i++)
        for (size_t k = 0; k < motion->beads; k++) {
            const double *const at = beads->position[k];
            boxes[(size_t)i * motion->beads + k] =
                at[0] * inverse[i][0] + at[1] * inverse[i][1] + at[2] * inverse[i][2];
        }
}

static double nearest_step(const struct measured_path *motion, int32_t *const place[3], int i,
                           size_t k) {
    return 0x1p-32 * box_fraction_difference(place[i][k], motion->place[i][k]);
}

/// Whole boxes that the beads have gone since the frame before, in place of where they were in
/// that; false if nobody tells them.
static bool find_whole_boxes(struct measured_path *motion, const struct trajectory_frame *beads,
                             int32_t *const place[3]) {
    double *const now = motion->boxes, *const before = now + 3 * motion->beads;
    const bool told = motion->unwrapped && beads->unwrapped;
    size_t around = 0, stayed = 0;
    for (int i = 0; told && i < 3; i++)
        for (size_t k = 0; k < motion->beads; k++) {
            const size_t n = (size_t)i * motion->beads + k;
            const double step = nearest_step(motion, place, i, k);
            before[n] = rint(now[n] - before[n] - step);
            around += before[n] != 0;
            stayed += before[n] != 0 && fabs(step) < same;
        }
    return told && 2 * stayed <= around;
}

/// Steps to nearest images are of the wrong one if they are longer than half a box.
static void count_far(struct measured_path *motion, int32_t *const place[3]) {
    for (int i = 0; i < 3; i++)
        for (size_t k = 0; k < motion->beads; k++)
            motion->far += fabs(nearest_step(motion, place, i, k)) > near_half;
    motion->steps += 3 * motion->beads;
}

/// Go on by the fractions that the beads have moved since the frame before, which are 0 in the
/// first frame. @param[in] whole  shape [3, beads], boxes beside; NULL: none
static void go_on(struct measured_path *motion, const struct trajectory_frame *beads,
                  int32_t *const place[3], const double *whole) {
    const size_t count = motion->beads;
    double mean[3][3];
    for (int n = 0; n < 9; n++)
        mean[n / 3][n % 3] = 0.5 * 0x1p-32 * (motion->box[n / 3][n % 3] + beads->box[n / 3][n % 3]);
    for (int d = 0; d < 3; d++) {
        const double *const before = motion->path[1] + (size_t)d * count;
        double *const now = motion->path[2] + (size_t)d * count;
        for (size_t k = 0; k < count; k++) {
            double step = 0;
            for (int i = 0; i < 3; i++)
                step += mean[i][d] * (box_fraction_difference(place[i][k], motion->place[i][k]) +
                                      (whole ? 0x1p32 * whole[(size_t)i * count + k] : 0));
            now[k] = before[k] + step;
        }
    }
}

static void remember(struct measured_path *motion, const struct trajectory_frame *beads,
                     int32_t *const place[3]) {
    memcpy(motion->box, beads->box, sizeof motion->box);
    for (int i = 0; i < 3; i++)
        memcpy(motion->place[i], place[i], motion->beads * sizeof *place[i]);
}

static void subtract_mean(const struct measured_path *motion, double *values) {
    double sum = 0, all = 0;
    for (size_t k = 0; k < motion->beads; k++) {
        const double mass = motion->mass ? motion->mass[k] : 1;
        sum += mass * values[k];
        all += mass;
    }
    for (size_t k = 0; k < motion->beads; k++)
        values[k] -= sum / all;
}

static void set_state(struct measured_path *motion, const struct trajectory_frame *beads) {
    const size_t count = motion->beads;
    const double *const at = motion->path[motion->differences ? 1 : 2];
    double *const velocity = motion->state + 3 * count;
    memcpy(motion->state, at, 3 * count * sizeof *at);
    for (size_t k = 0; motion->differences && k < 3 * count; k++)
        velocity[k] = (motion->path[2][k] - motion->path[0][k]) / (2 * motion->interval);
    for (int d = 0; !motion->differences && beads->has_velocities && d < 3; d++)
        for (size_t k = 0; k < count; k++)
            velocity[(size_t)d * count + k] = beads->velocity[k][d];
    for (size_t d = 0; motion->together && d < 6; d++)
        subtract_mean(motion, motion->state + d * count);
}

const double *mf_measured_path_add(struct measured_path *motion,
                                   const struct trajectory_frame *beads, int32_t *const place[3]) {
    if (motion->frames == 0)
        remember(motion, beads, place);
    turn(motion);
    find_boxes(motion, beads, motion->boxes);
    double *const whole = motion->boxes + 3 * motion->beads;
    const bool told = find_whole_boxes(motion, beads, place);
    if (!told)
        count_far(motion, place);
    go_on(motion, beads, place, told ? whole : NULL);
    remember(motion, beads, place);
    memcpy(whole, motion->boxes, 3 * motion->beads * sizeof *whole);
    motion->unwrapped = beads->unwrapped;
    motion->frames++;
    if (motion->differences && motion->frames < 3)
        return NULL;
    set_state(motion, beads);
    return motion->state;
}

// Plans -------------------------------------------------------------------------------------------

/// Unless given: frames of a window, and which part of the trajectory a window is at most.
enum {
    USUAL_PART = 10,
    USUAL_LAGS = MEASURED_MOTION_FRAMES / USUAL_PART,
    WINDOWS_BETWEEN = 10,
    ESCAPE_BINS = 50
};

/// Unless given, where pairs begin and where they have escaped, in units of ρ^(−1/3): around the
/// first shell of a liquid.
static const double usual_near = 0.8, usual_far = 1.6;

/// Of an interval, by which frames may be off beside the rounding of their times.
static const double interval_tolerance = 1e-3;

// Preparing ---------------------------------------------------------------------------------------

static enum status copy_masses(struct measured_motion *motion, const struct mapping *mapping) {
    for (size_t k = 0; k < mapping->beads; k++)
        if (!(mapping->bead[k].mass > 0))
            return STATUS_OK;
    TRY_ARRAY(motion->mass, mapping->beads);
    for (size_t k = 0; k < mapping->beads; k++)
        motion->mass[k] = mapping->bead[k].mass;
    return STATUS_OK;
}

/// Where velocities tell the temperature, those of the types must agree.
static enum status copy_types(struct measured_motion *motion, const struct mapping *mapping) {
    if (!motion->is_thermal)
        return STATUS_OK;
    TRY_ARRAY(motion->type, mapping->beads);
    motion->of_type.columns = mapping->types;
    for (size_t k = 0; k < mapping->beads; k++)
        motion->type[k] = mapping->bead[k].type;
    return STATUS_OK;
}

/// Momentum is that of all atoms: beads of some of them have a share that comes and goes.
static bool are_all(const struct mapping *mapping) {
    size_t atoms = 0;
    for (size_t k = 0; k < mapping->beads; k++)
        atoms += mapping->bead[k].count;
    return atoms == mapping->atoms;
}

static enum status choose_velocities(struct measured_motion *motion,
                                     const struct trajectory_frame *first) {
    const int wish = motion->plan.velocities;
    if (wish == MEASURED_VELOCITIES_FILE && !first->has_velocities)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: frame %zu has no velocities; --velocities differences would "
                              "make them of positions",
                              first->file, first->number);
    motion->path.differences = wish == MEASURED_VELOCITIES_DIFFERENCES;
    motion->has_vacf =
        motion->path.differences || (wish != MEASURED_VELOCITIES_NONE && first->has_velocities);
    return STATUS_OK;
}

static enum status choose_lags(const struct measured_motion *motion,
                               const struct trajectory_frame *first, struct motion_plan *plan) {
    const struct measured_motion_plan *const wish = &motion->plan;
    const double lags = rint(wish->window / motion->interval);
    const size_t part = wish->expected / USUAL_PART;
    if (wish->window > 0 && !(lags >= 2 && lags <= 1e5))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: --window %g: frames are %g ps apart, and a window has 2 to "
                              "100000 intervals",
                              first->file, wish->window, motion->interval);
    *plan = (struct motion_plan){.every = 1, .lags = USUAL_LAGS};
    if (wish->window > 0)
        plan->lags = (int64_t)lags;
    else if (wish->expected > 0 && part < USUAL_LAGS)
        plan->lags = part > 2 ? (int64_t)part : 2;
    plan->origin_every = plan->lags > WINDOWS_BETWEEN ? plan->lags / WINDOWS_BETWEEN : 1;
    return STATUS_OK;
}

static enum status begin_etd(struct measured_motion *motion, const struct motion_plan *plan,
                             size_t beads, const struct trajectory_frame *first,
                             const struct box_vectors *box, double height) {
    const double spacing = cbrt(box->volume / (double)beads),
                 most = measured_motion_most * 0.5 * height;
    const double wish = motion->plan.escape;
    const double far = wish > 0 ? wish : 0.01 * floor(100 * fmin(usual_far * spacing, most));
    const struct etd_grid grid = {.r_minimum = 0.01 * rint(100 * usual_near / usual_far * far),
                                  .r_maximum = far,
                                  .bins = ESCAPE_BINS,
                                  .times = plan->lags + 1};
    TRY(mf_frame_box_check_range(box, first, far, "the range of escape times"));
    return mf_etd_init_endless(&motion->etd, &grid, plan->origin_every, beads);
}

/// The shortest decimal number that `interval` may be, since times have been rounded to single
/// precision.
static double shorten(double interval, double error) {
    for (int digits = 1; digits < 9; digits++) {
        char text[32];
        snprintf(text, sizeof text, "%.*g", digits, interval);
        const double shorter = strtod(text, NULL);
        if (fabs(shorter - interval) <= error)
            return shorter;
    }
    return interval;
}

/// Whether frames can be followed in time.
static bool are_timed(const struct trajectory_frame *first) {
    return isfinite(first[0].time) && isfinite(first[1].time);
}

enum status mf_measured_motion_begin(struct measured_motion *motion,
                                     const struct measured_motion_plan *plan,
                                     const struct mapping *mapping,
                                     const struct trajectory_frame *first, size_t count,
                                     const struct box_vectors *box, double height) {
    enum status status = STATUS_OK;
    struct motion_plan lags;
    *motion = (struct measured_motion){.plan = *plan, .temperature.columns = 1};
    CHECK(copy_masses(motion, mapping));
    motion->is_kinetic = motion->mass && !mapping->off_mass && mapping->beads > 1;
    motion->is_thermal = motion->is_kinetic && !mapping->broken;
    motion->together = are_all(mapping);
    CHECK(copy_types(motion, mapping));
    if (plan->leave_out || count < 2 || !are_timed(first))
        goto done;
    motion->first_time = first[0].time;
    motion->interval =
        shorten(first[1].time - first[0].time,
                (double)FLT_EPSILON * fmax(fabs(first[0].time), fabs(first[1].time)));
    CHECK(mf_measured_path_init(&motion->path, mapping->beads));
    motion->path.mass = motion->mass;
    motion->path.together = motion->together;
    motion->path.interval = motion->interval;
    CHECK(choose_velocities(motion, first));
    CHECK(choose_lags(motion, first, &lags));
    CHECK(mf_motion_init_endless(&motion->motion, &lags, mapping->beads, motion->interval,
                                 motion->has_vacf));
    CHECK(begin_etd(motion, &lags, mapping->beads, first, box, height));
    motion->begun = true;
done:
    if (status != STATUS_OK)
        mf_measured_motion_clear(motion);
    return status;
}

void mf_measured_motion_clear(struct measured_motion *motion) {
    mf_memory_free(motion->mass);
    mf_measured_path_clear(&motion->path);
    mf_motion_clear(&motion->motion);
    mf_etd_clear(&motion->etd);
    mf_sample_series_clear(&motion->temperature);
    mf_memory_free(motion->type);
    mf_sample_series_clear(&motion->of_type);
    *motion = (struct measured_motion){0};
}

// Frames ------------------------------------------------------------------------------------------

static enum status check_frame(const struct measured_motion *motion,
                               const struct trajectory_frame *beads) {
    const double gone = beads->time - motion->last_time;
    const double tolerance =
        interval_tolerance * motion->interval + 4 * (double)FLT_EPSILON * fabs(beads->time);
    if (motion->frames > 0 && !(fabs(gone - motion->interval) <= tolerance))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: frame %zu, at %.7g ps, comes %.6g ps after the one before, not "
                              "%.6g: motion needs equal intervals; choose them by --every, or "
                              "measure only static quantities by --static",
                              beads->file, beads->number, beads->time, gone, motion->interval);
    if (motion->has_vacf && !motion->path.differences && !beads->has_velocities)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: frame %zu has no velocities, but those before have; use --velocities none",
            beads->file, beads->number);
    return STATUS_OK;
}

/// A kinetic temperature [K] by Σ m v² [u nm²/ps², which are kJ/mol].
static double temperature_of(double squares, double freedom) {
    return squares / freedom * 1e3 / (UNITS_BOLTZMANN * UNITS_AVOGADRO);
}

/// Kinetic temperatures [K] of the beads of each type; `all` is the mass of what rests together, of
/// whose freedom a bead of mass m has lost a share m/all, or INFINITY.
static enum status add_of_types(struct measured_motion *motion,
                                const struct trajectory_frame *beads, const double *momentum,
                                double all) {
    OWNED double *found = NULL;
    TRY_ARRAY(found, 2 * motion->of_type.columns);
    double *const freedom = found + motion->of_type.columns;
    for (size_t k = 0; k < beads->atoms; k++)
        for (int d = 0; d < 3; d++, freedom[motion->type[k]] += 1 - motion->mass[k] / all)
            found[motion->type[k]] +=
                motion->mass[k] * pow(beads->velocity[k][d] - momentum[d] / all, 2);
    for (size_t type = 0; type < motion->of_type.columns; type++)
        found[type] = temperature_of(found[type], freedom[type]);
    return mf_sample_series_add(&motion->of_type, found);
}

/// Kinetic temperature [K] of the beads' velocities, about that of their centre of mass if it
/// rests.
static enum status add_temperatures(struct measured_motion *motion,
                                    const struct trajectory_frame *beads) {
    const double *const mass = motion->mass;
    double momentum[3] = {0}, squares = 0, all = 0;
    for (size_t k = 0; k < beads->atoms; k++) {
        all += mass[k];
        for (int d = 0; d < 3; d++) {
            momentum[d] += mass[k] * beads->velocity[k][d];
            squares += mass[k] * beads->velocity[k][d] * beads->velocity[k][d];
        }
    }
    for (int d = 0; motion->together && d < 3; d++)
        squares -= momentum[d] * momentum[d] / all;
    const double freedom = 3 * ((double)beads->atoms - (motion->together ? 1 : 0));
    const double temperature = temperature_of(squares, freedom);
    TRY(mf_sample_series_add(&motion->temperature, &temperature));
    return motion->type ? add_of_types(motion, beads, momentum, motion->together ? all : INFINITY)
                        : STATUS_OK;
}

static enum status add_pairs(struct measured_motion *motion, const struct trajectory_frame *beads,
                             const struct configuration *configuration) {
    struct etd *const etd = &motion->etd;
    if (mf_etd_opens(etd, etd->state.samples))
        TRY(mf_frame_box_check_range(&configuration->box, beads, etd->grid.r_maximum,
                                     "the range of escape times"));
    return mf_etd_sample(etd, configuration);
}

static enum status follow(struct measured_motion *motion, const struct trajectory_frame *beads,
                          const struct configuration *configuration) {
    TRY(check_frame(motion, beads));
    const double *const state = mf_measured_path_add(&motion->path, beads, configuration->fraction);
    if (state && configuration->particles)
        TRY(mf_motion_see_molecules(&motion->motion, configuration->particles));
    if (state)
        mf_motion_add(&motion->motion, state, motion->plan.threads);
    TRY(add_pairs(motion, beads, configuration));
    motion->last_time = beads->time;
    motion->frames++;
    return STATUS_OK;
}

enum status mf_measured_motion_add(struct measured_motion *motion,
                                   const struct trajectory_frame *beads,
                                   const struct configuration *configuration) {
    if (motion->begun)
        TRY(follow(motion, beads, configuration));
    motion->has_velocities = motion->has_velocities || beads->has_velocities;
    return beads->has_velocities && motion->is_kinetic ? add_temperatures(motion, beads)
                                                       : STATUS_OK;
}

/// Differences of positions were divided by the interval of the first two frames, whose times are
/// rounded more than those of all.
static void correct_differences(struct measured_motion *motion) {
    const size_t products = motion->motion.blocks * (size_t)(motion->motion.plan.lags + 1);
    const double factor = pow(motion->path.interval / motion->interval, 2);
    for (size_t k = 0; factor != 1 && k < products; k++)
        motion->motion.products[k] *= factor;
    motion->path.interval = motion->interval;
}

void mf_measured_motion_end(struct measured_motion *motion) {
    if (motion->frames < 2)
        return;
    const double intervals = (double)(motion->frames - 1);
    const double max = fmax(fabs(motion->first_time), fabs(motion->last_time));
    motion->interval = shorten((motion->last_time - motion->first_time) / intervals,
                               (double)FLT_EPSILON * max / intervals);
    motion->motion.time_step = motion->interval;
    if (motion->path.differences)
        correct_differences(motion);
}
