// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/thermodynamics.h"

#include "base/memory.h"
#include "base/number_text.h"
#include "base/statistics.h"
#include "forces/configurational.h"
#include "forces/interaction.h"

#include <math.h>

/// Longer series are averaged in blocks first, so that their autocovariances stay cheap.
enum { MAX_BLOCKS = 4096 };

void mf_thermodynamics_init(struct thermodynamics *thermodynamics) {
    *thermodynamics = (struct thermodynamics){.series.columns = THERMODYNAMICS_QUANTITIES};
}

void mf_thermodynamics_clear(struct thermodynamics *thermodynamics) {
    mf_sample_series_clear(&thermodynamics->series);
}

static bool knows_laplacian(const struct interaction *kind) {
    return kind->laplacian != NULL;
}

static bool lacks_laplacian(const struct interaction *kind) {
    return kind->laplacian == NULL;
}

/// Numerator and denominator of the configurational temperature; the potentials beside the pairs
/// count, too.
static enum status configurational(const struct simulation *simulation, double *squares,
                                   double *laplacian) {
    enum status status = STATUS_OK;
    const struct particles *particles = &simulation->particles;
    double *known[3] = {NULL}, *others[3] = {NULL};
    const bool alone = simulation->interactions == 1;
    for (int d = 0; d < particles->box.dimensions && !alone; d++) {
        NEW_ARRAY(known[d], particles->count);
        NEW_ARRAY(others[d], particles->count);
    }
    CHECK(mf_simulation_interaction_forces(simulation, lacks_laplacian, others));
    CHECK(mf_simulation_interaction_forces(simulation, knows_laplacian, known));
    CHECK(mf_configurational(simulation->law.potential, &simulation->law.composition,
                             simulation->setup.temperature, particles, &simulation->neighbours,
                             alone ? NULL : known, alone ? NULL : others, squares, laplacian));
    CHECK(mf_simulation_interaction_laplacian(simulation, laplacian));
done:
    for (int d = 0; d < 3; d++) {
        mf_memory_free(known[d]);
        mf_memory_free(others[d]);
    }
    return status;
}

static const struct integrator_told *told_of(const struct simulation *simulation) {
    const struct integrator *integrator = simulation->setup.integrator;
    return integrator->tell ? integrator->tell(simulation->integrator_state) : NULL;
}

enum status mf_thermodynamics_temperature(const struct simulation *simulation, double *above,
                                          double *below) {
    *above = mf_simulation_temperature(simulation);
    *below = 1;
    if (told_of(simulation)) {
        *above = told_of(simulation)->temperature;
        return STATUS_OK;
    }
    if (simulation_has_velocities(&simulation->setup) || simulation->law.potential == NULL)
        return STATUS_OK;
    return configurational(simulation, above, below);
}

enum status mf_thermodynamics_sample(struct thermodynamics *thermodynamics,
                                     const struct simulation *simulation) {
    double here[THERMODYNAMICS_QUANTITIES] = {0};
    const double count = (double)simulation->particles.count;
    const struct integrator_told *told = told_of(simulation);
    here[THERMODYNAMICS_TEMPERATURE] = mf_simulation_temperature(simulation);
    here[THERMODYNAMICS_POTENTIAL_ENERGY] = simulation->sums.energy / count;
    here[THERMODYNAMICS_PRESSURE] = mf_simulation_pressure(simulation);
    here[THERMODYNAMICS_DENSITY] = mf_particles_density(&simulation->particles);
    here[THERMODYNAMICS_TOTAL_ENERGY] =
        (simulation->sums.energy + mf_particles_kinetic_energy(&simulation->particles)) / count;
    if (told) {
        here[THERMODYNAMICS_TEMPERATURE] = told->temperature;
        here[THERMODYNAMICS_PRESSURE] = told->pressure;
    }
    if (simulation->law.potential && !told)
        TRY(configurational(simulation, &here[THERMODYNAMICS_FORCE_SQUARES],
                            &here[THERMODYNAMICS_LAPLACIAN]));
    return mf_sample_series_add(&thermodynamics->series, here);
}

const double *mf_thermodynamics_series(const struct thermodynamics *thermodynamics,
                                       enum thermodynamics_quantity quantity) {
    return sample_series_column(&thermodynamics->series, (size_t)quantity);
}

double mf_thermodynamics_energy_drift(const struct thermodynamics *thermodynamics) {
    const double *energy = mf_thermodynamics_series(thermodynamics, THERMODYNAMICS_TOTAL_ENERGY);
    const double last = (double)thermodynamics->series.count - 1;
    double mean = 0, products = 0, squares = 0;
    for (size_t k = 0; k < thermodynamics->series.count; k++)
        mean += energy[k] / (last + 1);
    for (size_t k = 0; k < thermodynamics->series.count; k++) {
        const double time = (double)k - 0.5 * last;
        products += time * (energy[k] - mean);
        squares += time * time;
    }
    return products / squares * last / fabs(mean);
}

/// Mean of a quantity over the samples begin … end − 1 of one replica.
static double block_mean(const struct thermodynamics *replica,
                         enum thermodynamics_quantity quantity, size_t begin, size_t end) {
    const double *series = mf_thermodynamics_series(replica, quantity);
    double sum = 0;
    for (size_t k = begin; k < end; k++)
        sum += series[k];
    return sum / (double)(end - begin);
}

/// Mean of a quantity over all samples of all replicas; 1 without a quantity.
static double mean_of(const struct thermodynamics *replicas, size_t count, int quantity) {
    struct running_mean mean = {0};
    for (size_t r = 0; quantity >= 0 && r < count; r++)
        for (size_t k = 0; k < replicas[r].series.count; k++)
            mf_statistics_add(&mean, mf_thermodynamics_series(
                                         &replicas[r], (enum thermodynamics_quantity)quantity)[k]);
    return quantity < 0 ? 1 : mean.mean;
}

/// Mean and standard error of numerator/denominator. To first order in the scatter the error is
/// that of the mean of (numerator − ratio · denominator) / ⟨denominator⟩; of replicas of different
/// lengths the shortest counts. Returns the number of values that the error is from.
static size_t ratio(const struct thermodynamics *replicas, size_t count,
                    enum thermodynamics_quantity numerator, int denominator, double *mean,
                    double *error) {
    double deviations[MAX_BLOCKS];
    const double below = mean_of(replicas, count, denominator);
    *mean = mean_of(replicas, count, numerator) / below;
    size_t shortest = replicas[0].series.count;
    for (size_t r = 1; r < count; r++)
        shortest = replicas[r].series.count < shortest ? replicas[r].series.count : shortest;
    const size_t each = (shortest * count + MAX_BLOCKS - 1) / MAX_BLOCKS;
    const size_t blocks = each ? shortest / each : 0;
    for (size_t r = 0; r < count; r++)
        for (size_t b = 0; b < blocks; b++) {
            const size_t begin = b * each, end = begin + each;
            const double top = block_mean(&replicas[r], numerator, begin, end);
            const double bottom =
                denominator < 0 ? 1
                                : block_mean(&replicas[r],
                                             (enum thermodynamics_quantity)denominator, begin, end);
            deviations[r * blocks + b] = (top - *mean * bottom) / below;
        }
    *error = mf_statistics_correlated_error(deviations, blocks, count);
    return blocks * count;
}

struct thermodynamics_summary mf_thermodynamics_result(const struct thermodynamics *replicas,
                                                       size_t count) {
    struct thermodynamics_summary s;
    s.blocks = ratio(replicas, count, THERMODYNAMICS_TEMPERATURE, -1, &s.temperature,
                     &s.temperature_error);
    ratio(replicas, count, THERMODYNAMICS_POTENTIAL_ENERGY, -1, &s.potential_energy,
          &s.potential_energy_error);
    ratio(replicas, count, THERMODYNAMICS_PRESSURE, -1, &s.pressure, &s.pressure_error);
    ratio(replicas, count, THERMODYNAMICS_DENSITY, -1, &s.density, &s.density_error);
    ratio(replicas, count, THERMODYNAMICS_FORCE_SQUARES, THERMODYNAMICS_LAPLACIAN,
          &s.temperature_configurational, &s.temperature_configurational_error);
    double laplacian, error;
    ratio(replicas, count, THERMODYNAMICS_LAPLACIAN, -1, &laplacian, &error);
    s.laplacian_error = fabs(error / laplacian);
    return s;
}

/// What a temperature may be off besides its error, relative: beyond the 6 % that the standard
/// fluid heats at the customary Δt = 0.04.
static const double band = 0.1;
static const double deviations = 4;

/// Blocks to know a temperature by.
enum { MIN_BLOCKS = 5 };

/// So many times the temperature, or none at all, is no chance, however large the error that goes
/// with it: steps that are far too long give -613(242) and 3625(9341) for 1.
static const double absurd = 3;

static bool agrees(double temperature, double error, double wanted) {
    return fabs(temperature - wanted) <= band * wanted + deviations * error;
}

static bool is_absurd(double temperature, double wanted) {
    return temperature <= 0 || temperature > absurd * wanted;
}

/// Forces that hardly act have a ⟨∇²U⟩ that is not known from 0, and a ratio to it that says
/// nothing; without velocities, where there is nothing else to ask, it counts.
static bool knows_positions(const struct thermodynamics_summary *s, bool has_velocities) {
    static const double known = 0.25;
    return !isnan(s->temperature_configurational) &&
           !(has_velocities && s->laplacian_error > known);
}

static bool acts(const struct simulation_setup *setup, const struct interaction *kind) {
    bool found = false;
    for (int k = 0; k < setup->interactions; k++)
        found = found || setup->interaction[k].kind == kind;
    return found;
}

/// Walls and obstacles of a solvent push beads by no force that the positions would tell of, and a
/// uniform force by one that they tell nothing of.
static bool shows_forces(const struct simulation_setup *setup) {
    return setup->integrator->solvent_particles == NULL && !acts(setup, &mf_uniform_force);
}

/// Whether a flow that is driven may be in the velocities: of what carries beads along, or does
/// work, or pulls at beads of unlike masses.
static bool flows(const struct simulation_setup *setup) {
    const struct attributes_range masses = mf_attributes_span(&setup->attribute[ATTRIBUTES_MASS]);
    bool driven = setup->integrator->solvent_particles != NULL ||
                  (acts(setup, &mf_uniform_force) && masses.maximum > masses.minimum);
    for (int k = 0; k < setup->interactions; k++)
        driven = driven || setup->interaction[k].kind->does_work;
    return driven;
}

/// Whether a temperature is off by more than little and by more than chance.
static bool is_off(double temperature, double error, double wanted) {
    static const double min = 0.025, errors = 3;
    return fabs(temperature - wanted) > fmax(min * wanted, errors * error);
}

enum status mf_thermodynamics_assess(const struct thermodynamics_summary *summary,
                                     const struct simulation_setup *setup) {
    const struct thermodynamics_summary *s = summary;
    const bool has_velocities = simulation_has_velocities(setup);
    const bool positions = knows_positions(s, has_velocities) && shows_forces(setup);
    const double wanted = simulation_holds_temperature(setup) ? setup->temperature : s->temperature;
    const bool nobody =
        setup->integrator->solvent_particles && isnan(s->temperature); // a solvent alone
    const bool driven = setup->integrator->solvent_particles == NULL && flows(setup);
    if (s->blocks < MIN_BLOCKS || nobody || !mf_simulation_is_thermal(setup))
        return STATUS_OK;
    if ((!has_velocities || driven || agrees(s->temperature, s->temperature_error, wanted)) &&
        (!positions ||
         (agrees(s->temperature_configurational, s->temperature_configurational_error, wanted) &&
          (has_velocities || !is_absurd(s->temperature_configurational, wanted)))))
        return STATUS_OK;
    if (!has_velocities)
        return mf_status_fail(STATUS_UNSTABLE,
                              "the temperature is %.3g" STATUS_TEMPERATURE
                              " by the positions, not %.3g" STATUS_TEMPERATURE ": %sequilibrate "
                              "for longer",
                              s->temperature_configurational, wanted,
                              setup->integrator->samples ? "" : "lower \"time_step\", or ");
    // A step that is too long parts the two.
    const bool together =
        positions &&
        !is_off(s->temperature_configurational,
                hypot(s->temperature_configurational_error, s->temperature_error), s->temperature);
    return mf_status_fail(STATUS_UNSTABLE,
                          "the temperature is %.3g" STATUS_TEMPERATURE
                          " by the velocities and %.3g" STATUS_TEMPERATURE " by the positions, not "
                          "%.3g" STATUS_TEMPERATURE ": %s",
                          s->temperature, s->temperature_configurational, wanted,
                          together ? "equilibrate for longer, or with more friction"
                                   : "lower \"time_step\", or equilibrate for longer");
}

/// @param[in] why  and what is to be done
static enum status fail_temperature(const struct thermodynamics_summary *s,
                                    const struct simulation_setup *setup, const char *why) {
    return mf_status_fail(STATUS_UNSTABLE,
                          "the temperature is %.3g" STATUS_TEMPERATURE
                          ", not %.3g" STATUS_TEMPERATURE ": %s",
                          s->temperature, setup->temperature, why);
}

enum status mf_thermodynamics_assess_unheld(const struct thermodynamics_summary *s,
                                            const struct simulation_setup *setup) {
    if (simulation_holds_temperature(setup) || !mf_simulation_is_thermal(setup) ||
        s->blocks < MIN_BLOCKS || isnan(s->temperature) ||
        agrees(s->temperature, s->temperature_error, setup->temperature))
        return STATUS_OK;
    return fail_temperature(
        s, setup, "there is no thermostat; give the scene \"dissipative\", friction and noise");
}

/// What is wrong with a step, as a temperature tells that is so many per cent off.
static enum status fail_step(bool kinetic, double found, double error, double wanted,
                             const char *remedy) {
    char off[NUMBER_TEXT_SIZE];
    mf_number_text(100 * (found / wanted - 1), 100 * error / wanted, off);
    return mf_status_fail(STATUS_UNSTABLE,
                          "the %s temperature is %s %% off: the time step is long for this "
                          "potential, or its force ends abruptly; %s",
                          kinetic ? "kinetic" : "configurational", off, remedy);
}

enum status mf_thermodynamics_assess_fit(const struct thermodynamics_summary *s,
                                         const struct simulation_setup *setup) {
    const char *const remedy = "test it by a shorter \"verification.time_step\"";
    TRY(mf_thermodynamics_assess(s, setup));
    TRY(mf_thermodynamics_assess_unheld(s, setup));
    if (!mf_simulation_is_thermal(setup) || s->blocks < MIN_BLOCKS)
        return STATUS_OK;
    const double wanted = simulation_holds_temperature(setup) ? setup->temperature : s->temperature;
    if (is_off(s->temperature, s->temperature_error, wanted))
        return fail_step(true, s->temperature, s->temperature_error, wanted, remedy);
    if (shows_forces(setup) &&
        is_off(s->temperature_configurational, s->temperature_configurational_error, wanted))
        return fail_step(false, s->temperature_configurational,
                         s->temperature_configurational_error, wanted, remedy);
    return STATUS_OK;
}

/// A bath that does not hold the temperature leaves positions and velocities at another one.
static enum status assess_bath(const struct thermodynamics_summary *s,
                               const struct simulation_setup *setup, double certain) {
    if (!simulation_has_velocities(setup) || !simulation_holds_temperature(setup) ||
        !is_off(s->temperature, certain * s->temperature_error, setup->temperature))
        return STATUS_OK;
    return fail_temperature(s, setup,
                            "friction hardly holds it; more of it, or with a longer cutoff, or a "
                            "longer run, does");
}

enum status mf_thermodynamics_assess_step(const struct thermodynamics_summary *s,
                                          const struct simulation_setup *setup) {
    enum { MANY_BLOCKS = 50 };
    static const double certain = 5.0 / 3; // of errors, as neighbours of few samples remember
    const bool moves = simulation_has_velocities(setup);
    if (setup->integrator->samples || flows(setup) || !mf_simulation_is_thermal(setup) ||
        s->blocks < MANY_BLOCKS) // in no time, hot by the flow, unknown
        return STATUS_OK;
    const double positions = s->temperature_configurational,
                 of_positions = s->temperature_configurational_error;
    const double wanted = moves ? s->temperature : setup->temperature;
    const double error = moves ? hypot(of_positions, s->temperature_error) : of_positions;
    if (!shows_forces(setup) || !knows_positions(s, moves) ||
        !is_off(positions, certain * error, wanted))
        return assess_bath(s, setup, certain);
    const double kinetic_off = moves ? fabs(s->temperature / setup->temperature - 1) : 0;
    const bool kinetic = simulation_holds_temperature(setup) &&
                         kinetic_off > fabs(positions / setup->temperature - 1);
    return kinetic ? fail_step(true, s->temperature, s->temperature_error, setup->temperature,
                               "lower \"time_step\", or run for longer")
                   : fail_step(false, positions, error, wanted,
                               "lower \"time_step\", or run for longer");
}

struct thermodynamics_off mf_thermodynamics_off(const struct thermodynamics_summary *summary,
                                                const struct simulation_setup *setup) {
    static const double little = 0.01, errors = 3;
    const struct thermodynamics_summary *s = summary;
    const double wanted = simulation_holds_temperature(setup) ? setup->temperature : s->temperature;
    const struct thermodynamics_off each[2] = {
        {true, true, s->temperature / wanted - 1, s->temperature_error / wanted, 0},
        {true, false, s->temperature_configurational / wanted - 1,
         s->temperature_configurational_error / wanted, 0}};
    struct thermodynamics_off off = {.known = false};
    double farthest = -1, within = 0;
    if (s->blocks < MIN_BLOCKS || !mf_simulation_is_thermal(setup))
        return off;
    for (int k = 0; k < (shows_forces(setup) ? 2 : 1); k++) {
        const double error = is_absurd(each[k].share + 1, 1) ? 0 : each[k].error; // no chance
        const double allowed = fmax(little, errors * error);
        const double far = fabs(each[k].share) / allowed;
        within = isfinite(far) ? fmax(within, allowed) : within;
        if (!(far > farthest)) // it is not known
            continue;
        farthest = far;
        off = each[k];
        off.error = error;
    }
    off.within = within;
    return off;
}
