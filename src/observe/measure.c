// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/measure.h"

#include "base/statistics.h"
#include "observe/thermodynamics.h"

#include <math.h>

#define MEMBER(name) .offset = offsetof(struct measure_plan, name)
const struct field mf_measure_plan_fields[] = {
    {"equilibration", FIELD_INTEGER, MEMBER(equilibration), .initial = 1000, .minimum = 0,
     .maximum = 1e12, .unit = "steps", .help = "interval before the first sample"},
    {"samples", FIELD_INTEGER, MEMBER(samples), .initial = 200, .minimum = 1, .maximum = 1e8,
     .unit = "", .help = "number of samples"},
    {"every", FIELD_INTEGER, MEMBER(every), .initial = 25, .minimum = 1, .maximum = 1e9,
     .unit = "steps", .help = "interval between samples"},
    FIELD_END,
};

uint64_t mf_measure_steps(const struct measure_plan *plan) {
    return (uint64_t)(plan->equilibration + plan->samples * plan->every);
}

static void report(const struct measure_listener *listener, const struct simulation *simulation,
                   const struct measure_plan *plan) {
    if (listener)
        listener->report(listener->context, simulation, simulation->step, mf_measure_steps(plan));
}

/// Bead-steps between two words to the listener: less than a second of one thread, whatever the
/// scene. Who listens looks at the clock and saves now and then; a run of steps in pieces has the
/// same bits.
enum { STEPS_A_WORD = 1 << 21 };

static int64_t find_piece(const struct simulation *simulation,
                          const struct measure_listener *listener) {
    const int64_t max = 1 + STEPS_A_WORD / (int64_t)simulation_moved(&simulation->setup);
    const int64_t wanted = listener && listener->steps ? listener->steps(listener->context) : 0;
    return wanted > 0 && wanted < max ? wanted : max;
}

/// Forces, sums and the list of the present configuration, of which sweeps of Monte Carlo compute
/// nothing: for who looks at it.
static enum status look(struct simulation *simulation) {
    return simulation->setup.integrator->samples ? mf_simulation_compute_potential(simulation)
                                                 : STATUS_OK;
}

/// Run until `step`, which a restart may already have passed.
static enum status run_until(struct simulation *simulation, int64_t step,
                             const struct measure_plan *plan,
                             const struct measure_listener *listener) {
    for (int64_t now; (now = (int64_t)simulation->step) < step;) {
        const int64_t piece = find_piece(simulation, listener);
        const int64_t steps = step - now <= piece ? step - now : piece;
        TRY(mf_simulation_run(simulation, (uint64_t)steps));
        if (now + steps < step || piece == 1)
            report(listener, simulation, plan);
    }
    return STATUS_OK;
}

// Pieces short enough to tell of progress; the temperatures after the last of them count.
enum { PIECES = 100, LAST = 10 };

/// Temperatures as ratios, those of velocities over 1.
struct ratios {
    double above[LAST], below[LAST];
};

/// A single snapshot's ratio is biased and may be anything: that of the sums counts. If the wanted
/// temperature T is the true one, squares − T · laplacian is 0 on average: its scatter gives the
/// error, however wild the ratio, with the correlation of one piece's end with the next.
static struct measure_temperature configurational(const struct ratios *ratios, double wanted) {
    struct running_mean above = {0}, below = {0};
    double excess[LAST];
    for (int k = 0; k < LAST; k++) {
        mf_statistics_add(&above, ratios->above[k]);
        mf_statistics_add(&below, ratios->below[k]);
        excess[k] = ratios->above[k] - wanted * ratios->below[k];
    }
    return (struct measure_temperature){above.mean / below.mean,
                                        mf_statistics_correlated_error(excess, LAST, 1) /
                                            fabs(below.mean)};
}

static struct measure_temperature kinetic(const struct ratios *ratios) {
    double sum = 0;
    for (int k = 0; k < LAST; k++)
        sum += ratios->above[k];
    return (struct measure_temperature){sum / LAST, 0};
}

enum status mf_measure_settle(struct simulation *simulation, const struct measure_plan *plan,
                              struct measure_temperature *temperature,
                              const struct measure_listener *listener) {
    struct ratios ratios;
    for (int64_t piece = 1; piece <= PIECES; piece++) {
        const int64_t end = plan->equilibration * piece / PIECES;
        const int64_t last = piece - 1 - (PIECES - LAST);
        simulation->wants = PAIR_FORCES;
        TRY(run_until(simulation, end - 1, plan, listener));
        simulation->wants = last >= 0 ? PAIR_FORCES_AND_SUMS : PAIR_FORCES;
        TRY(run_until(simulation, end, plan, listener));
        if (last >= 0) {
            if ((int64_t)simulation->step == end) // and not of a run that was resumed later
                TRY(look(simulation));
            TRY(mf_thermodynamics_temperature(simulation, &ratios.above[last],
                                              &ratios.below[last]));
        }
        report(listener, simulation, plan);
    }
    const struct simulation_setup *setup = &simulation->setup;
    *temperature = simulation_has_velocities(setup) ? kinetic(&ratios)
                                                    : configurational(&ratios, setup->temperature);
    return STATUS_OK;
}

enum status mf_measure_equilibrate(struct simulation *simulation, const struct measure_plan *plan,
                                   double *temperature, const struct measure_listener *listener) {
    struct measure_temperature settled;
    TRY(mf_measure_settle(simulation, plan, &settled, listener));
    *temperature = settled.mean;
    return STATUS_OK;
}

/// The nearest step at which something with an interval of its own is due.
static int64_t next_due(const struct observable_use *uses) {
    int64_t next = INT64_MAX;
    for (; uses->observable; uses++) {
        const int64_t due = uses->observable->due ? uses->observable->due(uses->state) : INT64_MAX;
        next = due < next ? due : next;
    }
    return next;
}

/// Run until `step`, and sample what has an interval of its own whenever it is due.
static enum status run_moving(struct simulation *simulation, int64_t step,
                              const struct observable_use *uses, const struct measure_plan *plan,
                              const struct measure_listener *listener) {
    for (;;) {
        const int64_t due = next_due(uses);
        TRY(run_until(simulation, due < step ? due : step, plan, listener));
        if (due > step)
            return STATUS_OK;
        TRY(look(simulation));
        const struct configuration now = mf_configuration_of(simulation);
        for (const struct observable_use *use = uses; use->observable; use++)
            if (use->observable->due && use->observable->due(use->state) == due)
                TRY(use->observable->sample(use->state, &now));
    }
}

/// Whether the potential alone reaches as far as all forces, so that its pass sees every pair that
/// a histogram wants.
static bool potential_reaches(const struct pair_law *law) {
    return law->potential && law->potential->cutoff >= mf_pair_cutoff(law);
}

/// What the force pass of the next sample is to count, and for which observable; NULL for none.
static const struct pair_histogram *find_histogram(const struct observable_use *uses,
                                                   const struct observable_use **counted) {
    const struct pair_histogram *histogram = NULL;
    for (*counted = NULL; uses->observable && histogram == NULL; uses++)
        if (uses->observable->histogram) {
            histogram = uses->observable->histogram(uses->state);
            *counted = histogram ? uses : NULL;
        }
    return histogram;
}

static bool wants_sums(const struct observable_use *uses) {
    bool sums = false;
    for (; uses->observable; uses++)
        sums = sums || uses->observable->sums;
    return sums;
}

/// The last step before a sample. The force pass counts and sums what the sample needs; if that
/// belongs to the middle of the step, or the step has none, a pass of the potential at its end
/// does.
/// @param[out] counted  the observable that a force pass has counted for, or NULL
static enum status run_sampled_step(struct simulation *simulation, int64_t due,
                                    const struct observable_use *uses,
                                    const struct measure_plan *plan,
                                    const struct observable_use **counted) {
    struct pair_law *law = &simulation->law;
    const struct integrator *integrator = simulation->setup.integrator;
    const bool midway = integrator->forces_midway || integrator->samples;
    *counted = NULL;
    const struct pair_histogram *histogram =
        !midway || potential_reaches(law) ? find_histogram(uses, counted) : NULL;
    simulation->wants = wants_sums(uses) ? PAIR_FORCES_AND_SUMS : PAIR_FORCES;
    law->histogram = midway ? NULL : histogram;
    enum status status = run_moving(simulation, due, uses, plan, NULL);
    if (midway && status == STATUS_OK) {
        law->histogram = histogram;
        status = mf_simulation_compute_potential(simulation);
    }
    law->histogram = NULL;
    return status;
}

/// The first that wants the momentum transfer has it.
static struct transfer *find_transfer(const struct observable_use *uses) {
    struct transfer *transfer = NULL;
    for (; uses->observable && transfer == NULL; uses++)
        if (uses->observable->transfer)
            transfer = uses->observable->transfer(uses->state);
    return transfer;
}

static enum status take_samples(struct simulation *simulation, const struct measure_plan *plan,
                                const struct observable_use *uses,
                                const struct measure_listener *listener) {
    const int64_t begun = (int64_t)simulation->step - plan->equilibration;
    const struct observable_use *counted;
    for (int64_t sample = begun / plan->every; sample < plan->samples; sample++) {
        const int64_t due = plan->equilibration + (sample + 1) * plan->every;
        simulation->wants = PAIR_FORCES;
        TRY(run_moving(simulation, due - 1, uses, plan, listener));
        TRY(run_sampled_step(simulation, due, uses, plan, &counted));
        const struct configuration now = mf_configuration_of(simulation);
        for (const struct observable_use *use = uses; use->observable; use++) {
            const struct observable *observable = use->observable;
            if (use == counted)
                TRY(observable->counted(use->state, &now));
            else if (observable->due == NULL)
                TRY(observable->sample(use->state, &now));
        }
        report(listener, simulation, plan);
    }
    return STATUS_OK;
}

enum status mf_measure_sample(struct simulation *simulation, const struct measure_plan *plan,
                              const struct observable_use *uses,
                              const struct measure_listener *listener) {
    const struct integrator *integrator = simulation->setup.integrator;
    if (integrator->settle)
        integrator->settle(simulation->integrator_state);
    simulation->transfer = find_transfer(uses);
    const enum status status = take_samples(simulation, plan, uses, listener);
    simulation->transfer = NULL;
    return status;
}
