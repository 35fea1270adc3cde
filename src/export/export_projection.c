// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_projection.h"

#include "dynamics/langevin.h"
#include "observe/etd.h"
#include "observe/motion.h"
#include "observe/thermodynamics.h"
#include "system/composition.h"

#include <math.h>

enum { POINTS = 4000 };

/// The law without its amplitude, of a share of the cutoff.
static double shape(const struct export_power *power, double share) {
    return power->family == EXPORT_RISING ? 1 - pow(share, power->exponent)
                                          : pow(1 - share, power->exponent);
}

/// The best amplitude for an exponent, and the misfit that it leaves.
static struct export_power fit_amplitude(const struct table *omega, const struct table *potential,
                                         int pair, double temperature, struct export_power power) {
    double own = 0, both = 0, theirs = 0;
    for (int k = 0; k < POINTS; k++) {
        const double share = (k + 0.5) / POINTS, r = share * power.cutoff;
        double value = 0, phi;
        if (r < table_cutoff(omega, pair))
            mf_table_evaluate_pair(omega, pair, r, &value, NULL, NULL);
        mf_table_evaluate_pair(potential, pair, r, &phi, NULL, NULL);
        const double weight = r * r * exp(-phi / temperature), term = shape(&power, share);
        own += weight * value * value;
        both += weight * value * term;
        theirs += weight * term * term;
    }
    power.amplitude = both / theirs;
    power.misfit = own > 0 ? sqrt(fmax(0, 1 - both * both / (own * theirs))) : 0;
    return power;
}

struct export_power mf_export_power_fit(const struct table *omega, const struct table *potential,
                                        int pair, double temperature,
                                        const struct export_power *form) {
    static const double golden = 0.6180339887498949;
    struct export_power power = *form;
    if (omega == NULL || !(table_cutoff(omega, pair) > 0))
        return (struct export_power){0};
    if (!(power.cutoff > 0))
        power.cutoff = table_cutoff(omega, pair);
    if (power.exponent > 0)
        return fit_amplitude(omega, potential, pair, temperature, power);
    power.exponent = 1;
    power = fit_amplitude(omega, potential, pair, temperature, power);
    if (power.family == EXPORT_LINEAR || power.misfit < 0.1 * EXPORT_POWER_BOUND)
        return power;
    double low = log(0.02), high = log(20);
    for (int k = 0; k < 60; k++) {
        struct export_power left = power, right = power;
        left.exponent = exp(high - golden * (high - low));
        right.exponent = exp(low + golden * (high - low));
        if (fit_amplitude(omega, potential, pair, temperature, left).misfit <
            fit_amplitude(omega, potential, pair, temperature, right).misfit)
            high = log(right.exponent);
        else
            low = log(left.exponent);
    }
    power.exponent = exp(0.5 * (low + high));
    return fit_amplitude(omega, potential, pair, temperature, power);
}

static double value_of(const void *parameters, double r) {
    const struct export_power *power = parameters;
    return r < power->cutoff ? power->amplitude * shape(power, r / power->cutoff) : 0;
}

static double cutoff_of(const void *parameters) {
    return ((const struct export_power *)parameters)->cutoff;
}

/// Tables of such laws, one for each pair type. Fails: NO_MEMORY.
static enum status export_power_table(const struct export_power *power, int pairs,
                                      struct table *omega) {
    static const struct curve_family family = {
        .name = "nearest", .size = sizeof *power, .value = value_of, .cutoff = cutoff_of};
    enum status status = STATUS_OK;
    struct table part[COMPOSITION_MAX_PAIRS] = {{0}};
    for (int pair = 0; pair < pairs; pair++) {
        struct export_power law = power[pair];
        if (law.cutoff > 0)
            CHECK(mf_table_init_omega(&part[pair], &(struct curve){&family, &law}));
    }
    CHECK(mf_table_stack(omega, part, pairs));
done:
    for (int pair = 0; pair < pairs; pair++)
        mf_table_clear(&part[pair]);
    return status;
}

// Simulations -------------------------------------------------------------------------------------

/// What is measured of both, and when.
struct plan {
    struct etd_settings etd;
    struct motion_plan motion;
    struct measure_plan measure;
    int threads;
    struct measure_listener half; ///< listener of one simulation of two
};

/// Listener of two simulations as one.
struct halves {
    const struct measure_listener *listener; ///< NULL: nobody
    int done;                                ///< simulations that are over
};

static void report_half(void *context, const struct simulation *simulation, uint64_t done,
                        uint64_t total) {
    const struct halves *const halves = context;
    if (halves->listener)
        halves->listener->report(halves->listener->context, simulation,
                                 (uint64_t)halves->done * total + done, 2 * total);
}

/// One simulation.
struct run {
    struct simulation simulation;
    struct etd etd;
    struct motion motion;
    struct thermodynamics thermodynamics;
};

/// Mean distance of neighbours [λ].
static double find_spacing(const struct export_model *model) {
    const struct box *box = &model->setup.box;
    return pow(mf_box_volume(box) / (double)model->count, 1.0 / box->dimensions);
}

/// Windows of a simulation: at least, at most, and particles × steps that more than the least may
/// take.
struct effort {
    double least, most, cheap;
};
static const struct effort whole_effort = {20, 200, 1e7}, passing_effort = {10, 60, 3e6};

static struct plan make_plan(const struct export_model *model, const struct effort *effort) {
    enum { LAGS = 2 * (EXPORT_TIMES - 1), WINDOWS_BEFORE = 3 };
    const struct simulation_setup *setup = &model->setup;
    const double spacing = find_spacing(model), widest = 1.6 * spacing;
    const double window = 3 * spacing * sqrt(model->mass[0] / setup->temperature);
    const int64_t every = (int64_t)fmax(1, round(window / LAGS / setup->time_step));
    const double windows = effort->cheap / (LAGS * (double)every * (double)model->count);
    double reach = widest;
    for (int d = 0; d < setup->box.dimensions; d++)
        reach = fmin(reach, 0.499 * setup->box.length[d]);
    return (struct plan){
        .etd = {{.r_maximum = reach, .bins = EXPORT_BINS, .times = EXPORT_TIMES},
                {.every = 2 * every, .origin_every = 5}},
        .motion = {.every = every, .lags = LAGS, .origin_every = 5},
        .measure = {.equilibration = WINDOWS_BEFORE * LAGS * every,
                    .samples = LAGS / 2 * (int64_t)fmin(fmax(effort->least, windows), effort->most),
                    .every = 2 * every},
    };
}

static void clear(struct run *run) {
    mf_thermodynamics_clear(&run->thermodynamics);
    mf_motion_clear(&run->motion);
    mf_etd_clear(&run->etd);
    mf_simulation_clear(&run->simulation);
}

static enum status sample(struct run *run, struct plan *plan) {
    double temperature;
    struct observable_use uses[] = {{&mf_thermodynamics_observable, &run->thermodynamics, NULL},
                                    {&mf_etd_observable, &run->etd, &plan->etd},
                                    {&mf_motion_observable, &run->motion, &plan->motion},
                                    {0}};
    TRY(mf_measure_equilibrate(&run->simulation, &plan->measure, &temperature, &plan->half));
    const struct configuration first = mf_configuration_of(&run->simulation);
    for (struct observable_use *use = uses; use->observable; use++)
        TRY(use->observable->begin(use->state, use->settings, &first, &plan->measure));
    return mf_measure_sample(&run->simulation, &plan->measure, uses, &plan->half);
}

static enum status read_results(const struct run *run, struct export_measured *measured) {
    const struct thermodynamics_summary state = mf_thermodynamics_result(&run->thermodynamics, 1);
    const struct motion_summary motion = mf_motion_result(&run->motion, NULL);
    measured->temperature = (struct export_number){state.temperature, state.temperature_error};
    measured->diffusion = (struct export_number){motion.msd, motion.msd_error};
    return mf_etd_result(&(const struct etd *){&run->etd}, 1, measured->survival, measured->error,
                         measured->pairs);
}

/// Friction of a simulation: ω, and what it remembers and is across pairs, or a bath.
struct friction_of_run {
    const struct table *omega;
    struct pair_memory_law memory;
    const struct langevin_parameters *bath;
};

/// A simulation from the model's start; `seed` tells one from another.
static enum status simulate(const struct export_model *model,
                            const struct friction_of_run *friction, uint64_t seed,
                            struct plan *plan, struct export_measured *measured) {
    CLEARED_BY(clear) struct run run = {0};
    struct simulation_setup setup = model->setup;
    struct simulation_start start = {0};
    setup.omega = friction->omega;
    setup.memory = friction->memory;
    if (friction->bath) {
        setup.integrator = &mf_langevin;
        setup.integrator_parameters = friction->bath;
    }
    setup.seed = seed;
    setup.threads = plan->threads;
    setup.placement.kind = PLACEMENT_FILE;
    for (int d = 0; d < setup.box.dimensions; d++) {
        start.position[d] = model->position[d];
        start.velocity[d] = model->velocity[d];
    }
    TRY(mf_simulation_init(&run.simulation, &setup, &start));
    TRY(sample(&run, plan));
    return read_results(&run, measured);
}

static void compare(struct export_projection *projection) {
    const struct export_measured *a = &projection->result, *b = &projection->projected;
    double squares = 0, errors = 0, weights = 0;
    for (int k = EXPORT_BINS; k < EXPORT_TIMES * EXPORT_BINS; k++) {
        if (!isfinite(a->survival[k] + b->survival[k] + a->error[k] + b->error[k]))
            continue;
        const double weight = (double)(a->pairs[k % EXPORT_BINS] + b->pairs[k % EXPORT_BINS]);
        weights += weight;
        squares += weight * pow(b->survival[k] - a->survival[k], 2);
        errors += weight * (a->error[k] * a->error[k] + b->error[k] * b->error[k]);
    }
    projection->rms = weights > 0 ? sqrt(squares / weights) : NAN;
    projection->noise = weights > 0 ? sqrt(errors / weights) : NAN;
}

static enum status check_size(const struct export_model *model, const struct plan *plan) {
    const double steps =
        (double)(plan->measure.equilibration + plan->measure.samples * plan->measure.every);
    return (double)model->count * steps <= EXPORT_IN_PASSING
               ? STATUS_OK
               : mf_status_fail(STATUS_BAD_INPUT,
                                "%zu beads for %.3g steps take more than a minute", model->count,
                                steps);
}

enum status mf_export_project(const struct export_model *model,
                              const struct export_substitute *substitute, bool in_passing,
                              int threads, const struct measure_listener *listener,
                              struct export_projection *projection) {
    const uint64_t seed = model->setup.seed;
    const struct langevin_parameters bath = {substitute->rate};
    struct plan plan = make_plan(model, in_passing ? &passing_effort : &whole_effort);
    struct halves halves = {.listener = listener};
    CLEARED_BY(mf_table_clear) struct table omega = {0};
    CLEARED_BY(mf_table_clear) struct table across = {0};
    struct friction_of_run theirs = {.bath = substitute->power ? NULL : &bath};
    *projection =
        (struct export_projection){.interval = (double)plan.etd.plan.every * model->setup.time_step,
                                   .r_maximum = plan.etd.grid.r_maximum,
                                   .steps = plan.measure.samples * plan.measure.every};
    plan.threads = threads;
    plan.half = (struct measure_listener){.report = report_half, .context = &halves};
    if (in_passing)
        TRY(check_size(model, &plan));
    if (substitute->power) {
        TRY(export_power_table(substitute->power, mf_export_model_pairs(model), &omega));
        theirs.omega = &omega;
    }
    if (substitute->power && export_model_across(model)) {
        TRY(export_power_table(substitute->across, mf_export_model_pairs(model), &across));
        theirs.memory.transverse = &across;
    }
    TRY(simulate(model, &(struct friction_of_run){model->own_omega, model->own_memory, NULL},
                 seed + 1, &plan, &projection->result));
    halves.done = 1;
    TRY(simulate(model, &theirs, seed + 2, &plan, &projection->projected));
    compare(projection);
    return STATUS_OK;
}
