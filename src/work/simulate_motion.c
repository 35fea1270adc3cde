// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/simulate_motion.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "report/number_text.h"

void mf_simulate_motion_read(struct simulate_motion *motion, struct json_object *root) {
    struct json_object object = mf_json_child(root, "motion", false);
    motion->on = object.item != NULL;
    mf_json_fields(&object, mf_motion_plan_fields, &motion->plan);
    if (motion->on)
        mf_json_finish(&object);
}

void mf_simulate_motion_write_used(const struct simulate_motion *motion,
                                   struct json_writer *writer) {
    if (!motion->on)
        return;
    mf_json_begin(writer, "motion");
    mf_json_put_fields(writer, mf_motion_plan_fields, &motion->plan);
    mf_json_end(writer);
}

enum status mf_simulate_motion_begin(struct simulate_motion *motion,
                                     const struct simulation *simulation,
                                     const struct measure_plan *measure) {
    if (!motion->on)
        return STATUS_OK;
    return mf_motion_init(&motion->motion, &motion->plan, simulation, measure->equilibration,
                          measure->samples * measure->every);
}

void mf_simulate_motion_clear(struct simulate_motion *motion) {
    mf_motion_clear(&motion->motion);
}

struct motion *mf_simulate_motion_target(struct simulate_motion *motion) {
    return motion->on ? &motion->motion : NULL;
}

size_t mf_simulate_motion_spans(struct simulate_motion *motion, struct memory_span *spans) {
    return motion->on ? mf_motion_spans(&motion->motion, spans) : 0;
}

enum status mf_simulate_motion_write_table(const struct simulate_motion *motion,
                                           const struct units *units, const char *file) {
    enum status status = STATUS_OK;
    const size_t rows = (size_t)motion->plan.lags + 1;
    const bool known = mf_units_known(units);
    const double ps = known ? mf_units_time_ps(units) : 1, nm2 = units->length * units->length;
    double *time = NULL, *values = NULL, *picoseconds = NULL, *physical = NULL;
    if (!motion->on)
        return STATUS_OK;
    NEW_ARRAY(time, rows);
    NEW_ARRAY(values, 4 * rows);
    const struct motion_curves curves = {values, values + rows, values + 2 * rows,
                                         values + 3 * rows};
    mf_motion_result(&motion->motion, &curves);
    for (size_t k = 0; k < rows; k++)
        time[k] = (double)k * (double)motion->plan.every * motion->motion.time_step;
    picoseconds = mf_units_column(time, rows, ps);
    physical = mf_units_column(values, 4 * rows, nm2);
    CHECK(picoseconds && physical ? STATUS_OK : STATUS_NO_MEMORY);
    for (size_t k = 2 * rows; k < 4 * rows; k++)
        physical[k] /= ps * ps;
    const struct data_column columns[] = {{"time[tau]", time, NULL},
                                          {"msd[lambda^2]", curves.msd, "%.8g"},
                                          {"msd_error[lambda^2]", curves.msd_error, "%.3g"},
                                          {"vacf[lambda^2/tau^2]", curves.vacf, "%.8g"},
                                          {"vacf_error[lambda^2/tau^2]", curves.vacf_error, "%.3g"},
                                          {"time[ps]", picoseconds, NULL},
                                          {"msd[nm^2]", physical, "%.8g"},
                                          {"msd_error[nm^2]", physical + rows, "%.3g"},
                                          {"vacf[nm^2/ps^2]", physical + 2 * rows, "%.8g"},
                                          {"vacf_error[nm^2/ps^2]", physical + 3 * rows, "%.3g"}};
    CHECK(mf_data_table_write(file, NULL, columns, known ? 10 : 5, rows));
done:
    mf_memory_free(time);
    mf_memory_free(picoseconds);
    mf_memory_free(physical);
    mf_memory_free(values);
    return status;
}

void mf_simulate_motion_write_summary(const struct simulate_motion *motion,
                                      const struct units *units, struct json_writer *writer) {
    if (!motion->on)
        return;
    const struct motion_summary s = mf_motion_result(&motion->motion, NULL);
    mf_json_begin(writer, "motion");
    if (mf_motion_judge(&s) != STATUS_OK)
        mf_json_put_text(writer, "warning", mf_status_message());
    mf_json_put_number(writer, "diffusion_msd", s.msd);
    mf_json_put_number(writer, "diffusion_msd_error", s.msd_error);
    mf_json_put_number(writer, "diffusion_green_kubo", s.green_kubo);
    const double error = mf_motion_green_kubo_uncertainty(&s);
    mf_json_put_number(writer, "diffusion_green_kubo_error", error);
    mf_json_put_number(writer, "diffusion_green_kubo_sampling", s.green_kubo_sampling);
    mf_json_put_number(writer, "diffusion_green_kubo_truncation", s.green_kubo_truncation);
    if (mf_units_known(units)) {
        const double unit = mf_units_diffusion_cm2_per_s(units);
        mf_json_put_number(writer, "diffusion_msd_cm2_per_s", s.msd * unit);
        mf_json_put_number(writer, "diffusion_msd_error_cm2_per_s", s.msd_error * unit);
        mf_json_put_number(writer, "diffusion_green_kubo_cm2_per_s", s.green_kubo * unit);
        mf_json_put_number(writer, "diffusion_green_kubo_error_cm2_per_s", error * unit);
    }
    mf_json_put_number(writer, "fit_begin", s.fit_begin);
    mf_json_put_number(writer, "fit_end", s.fit_end);
    if (s.maxwell.numbers > 0) {
        mf_json_put_number(writer, "velocities_tested", s.maxwell.numbers);
        mf_json_put_number(writer, "velocities_kolmogorov_smirnov", s.maxwell.statistic);
        mf_json_put_number(writer, "velocities_p_value", s.maxwell.probability);
    }
    mf_json_end(writer);
}

void mf_simulate_motion_say(const struct simulate_motion *motion, struct progress *to) {
    if (!motion->on)
        return;
    char msd[NUMBER_TEXT_SIZE], green_kubo[NUMBER_TEXT_SIZE];
    const struct motion_summary s = mf_motion_result(&motion->motion, NULL);
    mf_number_text(s.msd, s.msd_error, msd);
    mf_number_text(s.green_kubo, mf_motion_green_kubo_uncertainty(&s), green_kubo);
    mf_progress_say(to, "D = %s by the MSD from %.4g to %.4g tau, %s by Green and Kubo", msd,
                    s.fit_begin, s.fit_end, green_kubo);
    if (mf_motion_judge(&s) != STATUS_OK)
        mf_progress_say(to, "mesofit: warning: %s", mf_status_message());
}
