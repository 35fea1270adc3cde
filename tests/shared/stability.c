// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/stability.h"

#include "curves/formula.h"
#include "dynamics/dpd_verlet.h"
#include "shared/fluids.h"
#include "shared/watched.h"
#include "shared/testing.h"

enum { SAMPLES = 100 };

static enum status measure(const struct simulation_setup *setup,
                           const struct simulation_start *start, const struct measure_plan *plan,
                           struct thermodynamics_summary *summary) {
    enum status status = STATUS_OK;
    struct simulation simulation = {0};
    struct thermodynamics thermodynamics = {0};
    double temperature;
    mf_thermodynamics_init(&thermodynamics);
    CHECK(mf_simulation_init(&simulation, setup, start));
    CHECK(mf_measure_equilibrate(&simulation, plan, &temperature, NULL));
    CHECK(watched_sample(&simulation, plan, (struct watched){.thermodynamics = &thermodynamics},
                         NULL));
    *summary = mf_thermodynamics_result(&thermodynamics, 1);
done:
    mf_thermodynamics_clear(&thermodynamics);
    mf_simulation_clear(&simulation);
    return status;
}

enum stability stability_run(const struct simulation_setup *setup,
                             const struct simulation_start *start, int64_t equilibration,
                             int64_t every) {
    const struct measure_plan plan = {equilibration, SAMPLES, every};
    struct thermodynamics_summary s;
    const enum status status = measure(setup, start, &plan, &s);
    print_message("%s, time step %g, T %g, N %lld: ", setup->integrator->name, setup->time_step,
                  setup->temperature, (long long)setup->placement.count);
    if (status == STATUS_UNSTABLE) {
        print_message("%s\n", mf_status_message());
        return STABILITY_UNSTABLE;
    }
    assert_ok(status);
    const bool good = mf_thermodynamics_assess(&s, setup) == STATUS_OK;
    print_message("%.3f(%.3f) / %.3f(%.3f)%s\n", s.temperature, s.temperature_error,
                  s.temperature_configurational, s.temperature_configurational_error,
                  good ? "" : ", doubtful");
    return good ? STABILITY_GOOD : STABILITY_DOUBTFUL;
}

enum stability stability_of(const struct stability_case *what, int64_t count) {
    struct fluid fluid;
    struct table omega;
    struct formula_power_omega_parameters parameters = {sqrt(what->friction), 1, 0, 1};
    const struct curve curve = {&mf_formula_power_omega, &parameters};
    fluid_groot_warren(&fluid, count, what->time_step);
    assert_ok(mf_table_init_omega(&omega, &curve));
    fluid.setup.omega = &omega;
    fluid.setup.integrator = what->integrator;
    const struct dpd_verlet_parameters prediction = {.lambda = what->lambda};
    if (what->integrator == &mf_dpd_verlet)
        fluid.setup.integrator_parameters = &prediction;
    fluid.setup.temperature_limit = 20;
    print_message("gamma %g: ", what->friction);
    const enum stability stability =
        stability_run(&fluid.setup, NULL, (int64_t)fmax(300, 10 / what->time_step),
                      (int64_t)fmax(4, 0.05 / what->time_step));
    mf_table_clear(&omega);
    fluid_clear(&fluid);
    return stability;
}
