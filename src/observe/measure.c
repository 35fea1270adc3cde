// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/measure.h"

#define MEMBER(name) .offset = offsetof(struct measure_plan, name)
const struct field mf_measure_plan_fields[] = {
    {"equilibration", FIELD_INTEGER, MEMBER(equilibration), .initial = 1000, .minimum = 0,
     .maximum = 1e12, .unit = "steps", .help = "before the first sample"},
    {"samples", FIELD_INTEGER, MEMBER(samples), .initial = 200, .minimum = 1, .maximum = 1e8,
     .unit = "", .help = "number of samples"},
    {"every", FIELD_INTEGER, MEMBER(every), .initial = 25, .minimum = 1, .maximum = 1e9,
     .unit = "steps", .help = "between samples"},
    FIELD_END,
};

uint64_t mf_measure_steps(const struct measure_plan *plan) {
    return (uint64_t)(plan->equilibration + plan->samples * plan->every);
}

static void tell(const struct measure_listener *listener, const struct simulation *simulation,
                 const struct measure_plan *plan) {
    if (listener)
        listener->tell(listener->context, simulation, simulation->step, mf_measure_steps(plan));
}

/// Bead-steps between two words to the listener: less than a second of one thread, whatever the
/// scene. Who listens looks at the clock and saves now and then; a run of steps in pieces has the
/// same bits.
enum { STEPS_A_WORD = 1 << 21 };

/// Run until `step`, which a restart may already have passed.
static enum status run_until(struct simulation *simulation, int64_t step,
                             const struct measure_plan *plan,
                             const struct measure_listener *listener) {
    const int64_t piece = 1 + STEPS_A_WORD / (int64_t)simulation->particles.count;
    for (int64_t now; (now = (int64_t)simulation->step) < step;) {
        const int64_t steps = step - now <= piece ? step - now : piece;
        TRY(mf_simulation_run(simulation, (uint64_t)steps));
        if (now + steps < step)
            tell(listener, simulation, plan);
    }
    return STATUS_OK;
}

enum status mf_measure_equilibrate(struct simulation *simulation, const struct measure_plan *plan,
                                   double *temperature, const struct measure_listener *listener) {
    // Pieces short enough to tell of progress; their temperatures over the last tenth are averaged.
    enum { PIECES = 100, LAST = 10 };
    double sum = 0;
    for (int64_t piece = 1; piece <= PIECES; piece++) {
        const int64_t end = plan->equilibration * piece / PIECES;
        simulation->wants = PAIR_FORCES;
        TRY(run_until(simulation, end - 1, plan, listener));
        simulation->wants = piece > PIECES - LAST ? PAIR_FORCES_AND_SUMS : PAIR_FORCES;
        TRY(run_until(simulation, end, plan, listener));
        double here = 0;
        if (piece > PIECES - LAST)
            TRY(mf_thermodynamics_temperature(simulation, &here));
        sum += here;
        tell(listener, simulation, plan);
    }
    *temperature = sum / LAST;
    return STATUS_OK;
}

/// Run until `step`, and sample what has an interval of its own whenever it is due.
static enum status run_moving(struct simulation *simulation, int64_t step,
                              const struct measure_observables *observables,
                              const struct measure_plan *plan,
                              const struct measure_listener *listener) {
    for (;;) {
        const int64_t motion = observables->motion ? mf_motion_due(observables->motion) : INT64_MAX;
        const int64_t etd = observables->etd ? mf_etd_due(observables->etd) : INT64_MAX;
        const int64_t due = motion < etd ? motion : etd;
        TRY(run_until(simulation, due < step ? due : step, plan, listener));
        if (due > step)
            return STATUS_OK;
        if (motion == due)
            mf_motion_sample(observables->motion, simulation);
        if (etd == due)
            TRY(mf_etd_sample(observables->etd, simulation));
    }
}

/// Whether the potential alone reaches as far as all forces, so that its pass sees every pair that
/// a histogram wants.
static bool potential_reaches(const struct pair_law *law) {
    return law->potential && law->potential->cutoff >= mf_pair_cutoff(law);
}

/// The last step before a sample. The force pass counts and sums what the sample needs; if that
/// belongs to the middle of the step, a pass of the potential at its end does.
static enum status run_sampled_step(struct simulation *simulation, int64_t due,
                                    struct measure_observables observables,
                                    const struct measure_plan *plan) {
    struct pair_law *law = &simulation->law;
    const bool midway = simulation->setup.integrator->forces_midway;
    const bool counts = observables.rdf && (!midway || potential_reaches(law));
    const struct pair_histogram *histogram = counts ? mf_rdf_histogram(observables.rdf) : NULL;
    simulation->wants = observables.thermodynamics ? PAIR_FORCES_AND_SUMS : PAIR_FORCES;
    law->histogram = midway ? NULL : histogram;
    enum status status = run_moving(simulation, due, &observables, plan, NULL);
    if (midway && status == STATUS_OK) {
        law->histogram = histogram;
        status = mf_simulation_compute_potential(simulation);
    }
    law->histogram = NULL;
    TRY(status);
    if (histogram)
        mf_rdf_sample_counted(observables.rdf);
    else if (observables.rdf)
        TRY(mf_rdf_sample(observables.rdf, &simulation->particles, &simulation->neighbours));
    return STATUS_OK;
}

enum status mf_measure_sample(struct simulation *simulation, const struct measure_plan *plan,
                              struct measure_observables observables,
                              const struct measure_listener *listener) {
    const int64_t begun = (int64_t)simulation->step - plan->equilibration;
    for (int64_t sample = begun / plan->every; sample < plan->samples; sample++) {
        const int64_t due = plan->equilibration + (sample + 1) * plan->every;
        simulation->wants = PAIR_FORCES;
        TRY(run_moving(simulation, due - 1, &observables, plan, listener));
        TRY(run_sampled_step(simulation, due, observables, plan));
        if (observables.force_covariance) // while the forces are still those of the step
            mf_force_covariance_sample(observables.force_covariance, simulation);
        if (observables.rdf_force)
            TRY(mf_rdf_force_sample(observables.rdf_force, &simulation->particles,
                                    &simulation->neighbours));
        if (observables.thermodynamics)
            TRY(mf_thermodynamics_sample(observables.thermodynamics, simulation));
        tell(listener, simulation, plan);
    }
    return STATUS_OK;
}
