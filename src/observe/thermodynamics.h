// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Temperatures, energy and pressure of a simulation, as series with standard errors.
#pragma once

#include "dynamics/simulation.h"
#include "observe/sample_series.h"

/// Quantities of one sample, in the order of thermodynamics_names.
enum thermodynamics_quantity {
    THERMODYNAMICS_TEMPERATURE,      ///< kinetic, momentum removed            [k_B T_0]
    THERMODYNAMICS_POTENTIAL_ENERGY, ///< of a particle                        [k_B T_0]
    THERMODYNAMICS_PRESSURE,         ///< mf_simulation_pressure                  [k_B T_0/λ^d]
    THERMODYNAMICS_FORCE_SQUARES,    ///< Σ|F|² of the potential, numerator of the configurational
    THERMODYNAMICS_LAPLACIAN,        ///< Σ∇²U, its denominator
    THERMODYNAMICS_TOTAL_ENERGY,     ///< potential and kinetic, of a particle  [k_B T_0]
    THERMODYNAMICS_DENSITY,          ///< number of particles over the volume   [1/λ^d]
    THERMODYNAMICS_QUANTITIES
};

struct thermodynamics {
    struct sample_series series; ///< of THERMODYNAMICS_QUANTITIES
};

void mf_thermodynamics_init(struct thermodynamics *thermodynamics);
void mf_thermodynamics_clear(struct thermodynamics *thermodynamics);

/// Add a sample; the simulation's last step must have wanted its sums. Fails: NO_MEMORY.
enum status mf_thermodynamics_sample(struct thermodynamics *thermodynamics,
                                     const struct simulation *simulation) MUST_USE;

/// The temperature of the simulation as it is now, a ratio above/below whose parts are summed over
/// snapshots each: kinetic over 1, or without velocities configurational; NaN without either.
/// Fails: NO_MEMORY.
enum status mf_thermodynamics_temperature(const struct simulation *simulation, double *above,
                                          double *below) MUST_USE;

/// The series of one quantity, shape [samples].
const double *mf_thermodynamics_series(const struct thermodynamics *thermodynamics,
                                       enum thermodynamics_quantity quantity);

/// Drift of the total energy: the slope of a line through its samples, times the time from the
/// first to the last, relative to their mean. NaN with fewer than two samples.
/// Tested: test_thermodynamics.
double mf_thermodynamics_energy_drift(const struct thermodynamics *thermodynamics);

/// Heat capacity of a particle at constant volume [k_B] with its standard error, from how the
/// energy fluctuates: at the temperature that the setup holds, of the total energy, or without
/// velocities of the potential one and d/2; where the energy is conserved, of the kinetic one (J.
/// L. Lebowitz, J. K. Percus and L. Verlet, Phys. Rev. 153, 250 (1967)). NaN where nothing is
/// thermal or with fewer than five samples. Tested: cli/test_heat_capacity.
struct thermodynamics_capacity {
    double value, error;
};
struct thermodynamics_capacity
mf_thermodynamics_heat_capacity(const struct thermodynamics *thermodynamics,
                                const struct simulation_setup *setup);

/// Means over all replicas with standard errors that see the correlation of each series, by
/// mf_statistics_correlated_error.
struct thermodynamics_summary {
    size_t blocks;                         ///< behind the errors, of all replicas
    double temperature, temperature_error; ///< NaN without velocities
    double temperature_configurational, temperature_configurational_error; ///< NaN without Φ
    double laplacian_error; ///< of ⟨∇²U⟩, relative: what a ratio to it is worth
    double potential_energy, potential_energy_error;
    double pressure, pressure_error;
    double density,
        density_error; ///< of boxes that change; else it is that of the scene, without error
};
struct thermodynamics_summary mf_thermodynamics_result(const struct thermodynamics *replicas,
                                                       size_t count);

/// Whether the temperatures of a summary agree with the set one of a simulation: kinetic and
/// configurational within 10 % and four standard errors, where there are five blocks to know them
/// by. Without friction nothing is set, and the configurational one is held to the kinetic one;
/// without velocities there is no kinetic one to check.
///
/// A time step that is too large, or friction that is, may leave the kinetic temperature right and
/// the structure wrong: velocity Verlet (λ = ½) of the standard fluid with γ = 200 and Δt = 0.01
/// has 1.03 and 0.75. Fails: UNSTABLE with the temperatures in the message. Tested:
/// test_thermodynamics.
enum status mf_thermodynamics_assess(const struct thermodynamics_summary *summary,
                                     const struct simulation_setup *setup) MUST_USE;

/// Whether a temperature that nothing holds is still that of the setup, as above. Fails: UNSTABLE
/// with both in the message. Tested: test_thermodynamics, cli/test_simulate.
enum status mf_thermodynamics_assess_unheld(const struct thermodynamics_summary *summary,
                                            const struct simulation_setup *setup) MUST_USE;

/// A stricter look at what was fitted: one of the temperatures off by more than 2.5 % and three
/// standard errors says that the potential and its time step do not belong together. Without
/// friction the kinetic one must be near that of the setup, too, for which the target holds. Fails:
/// UNSTABLE with the numbers in the message. Tested: test_thermodynamics.
enum status mf_thermodynamics_assess_fit(const struct thermodynamics_summary *summary,
                                         const struct simulation_setup *setup) MUST_USE;

/// Whether positions and velocities tell one temperature, within 2.5 % and five standard errors of
/// fifty blocks: a time step that is long parts them, a bath that is slow does not; for a warning
/// of a simulation; and whether a bath holds that of the setup, as nearly. Without velocities the
/// temperature of the setup stands for theirs. Not of Monte
/// Carlo, nor where a flow may be driven. Fails: UNSTABLE. Tested: test_thermodynamics,
/// cli/test_simulate_dynamics.
enum status mf_thermodynamics_assess_step(const struct thermodynamics_summary *summary,
                                          const struct simulation_setup *setup) MUST_USE;

/// How far off the temperatures of a summary are, relative to the one that they should have: that
/// of the setup or, where nothing holds it, the kinetic one. Of both the one that is farther off by
/// its error, or by 1 % where that is larger. `known` is false with fewer than five blocks, and
/// where nothing is thermal. Tested: test_thermodynamics.
struct thermodynamics_off {
    bool known;
    bool kinetic;        ///< else the configurational one
    double share, error; ///< (T − T_wanted)/T_wanted, and its standard error: 0 of several times
                         ///< T_wanted, or none, which are no chance
    double within;       ///< the larger of both allowances: three errors, or 1 %
};
struct thermodynamics_off mf_thermodynamics_off(const struct thermodynamics_summary *summary,
                                                const struct simulation_setup *setup);

/// What a time step makes of the pressure, as the configurational temperature tells it.
///
/// Where drifts stand about a kick (`aboba`) a short step samples, where the second drift ends, the
/// potential U + Δt²/(12 m) (F² − k_B T ∇²U/2) at a temperature that is higher by the share
/// Δt² ⟨∇²U⟩/(6 d N m): the shadow Hamiltonian of position Verlet (H. Yoshida, Phys. Lett. A 150,
/// 262 (1990)) with the friction where Verlet's steps begin. To first order both temperature and
/// pressure follow from fluctuations of the samples themselves, with the same Δt²/m, which the
/// temperature then gives: friction and higher orders change it.
struct thermodynamics_shift {
    double pressure, error; ///< of P by the step, and its standard error; NaN: not known
};

/// NaN of other integrators, of beads of several masses, of molecules, where something acts whose
/// Laplacian is not known, with inner steps, and with fewer than a hundred samples. Tested:
/// test_time_step_shift.
struct thermodynamics_shift mf_thermodynamics_shift(const struct thermodynamics *replicas,
                                                    size_t count,
                                                    const struct thermodynamics_summary *summary,
                                                    const struct simulation_setup *setup);
