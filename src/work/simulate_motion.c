// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/simulate_motion.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "report/number_text.h"

void simulate_motion_read(struct simulate_motion *motion, struct json_object *root) {
    struct json_object object = json_child(root, "motion", false);
    motion->on = object.item != NULL;
    json_fields(&object, motion_plan_fields, &motion->plan);
    if (motion->on)
        json_finish(&object);
}

void simulate_motion_write_used(const struct simulate_motion *motion, struct json_writer *writer) {
    if (!motion->on)
        return;
    json_begin(writer, "motion");
    json_put_fields(writer, motion_plan_fields, &motion->plan);
    json_end(writer);
}

enum status simulate_motion_begin(struct simulate_motion *motion,
                                  const struct simulation *simulation,
                                  const struct measure_plan *measure) {
    if (!motion->on)
        return STATUS_OK;
    return motion_init(&motion->motion, &motion->plan, simulation, measure->equilibration,
                       measure->samples * measure->every);
}

void simulate_motion_clear(struct simulate_motion *motion) {
    motion_clear(&motion->motion);
}

struct motion *simulate_motion_target(struct simulate_motion *motion) {
    return motion->on ? &motion->motion : NULL;
}

size_t simulate_motion_spans(struct simulate_motion *motion, struct memory_span *spans) {
    return motion->on ? motion_spans(&motion->motion, spans) : 0;
}

enum status simulate_motion_write_table(const struct simulate_motion *motion,
                                        const struct units *units, const char *file) {
    enum status status = STATUS_OK;
    const size_t rows = (size_t)motion->plan.lags + 1;
    const bool known = units_known(units);
    const double ps = known ? units_time_ps(units) : 1, nm2 = units->length * units->length;
    double *time = NULL, *values = NULL, *picoseconds = NULL, *physical = NULL;
    if (!motion->on)
        return STATUS_OK;
    NEW_ARRAY(time, rows);
    NEW_ARRAY(values, 4 * rows);
    const struct motion_curves curves = {values, values + rows, values + 2 * rows,
                                         values + 3 * rows};
    motion_result(&motion->motion, &curves);
    for (size_t k = 0; k < rows; k++)
        time[k] = (double)k * (double)motion->plan.every * motion->motion.time_step;
    picoseconds = units_column(time, rows, ps);
    physical = units_column(values, 4 * rows, nm2);
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
    CHECK(data_table_write(file, NULL, columns, known ? 10 : 5, rows));
done:
    memory_free(time);
    memory_free(picoseconds);
    memory_free(physical);
    memory_free(values);
    return status;
}

void simulate_motion_write_summary(const struct simulate_motion *motion, const struct units *units,
                                   struct json_writer *writer) {
    if (!motion->on)
        return;
    const struct motion_summary s = motion_result(&motion->motion, NULL);
    json_begin(writer, "motion");
    if (motion_judge(&s) != STATUS_OK)
        json_put_text(writer, "warning", status_message());
    json_put_number(writer, "diffusion_msd", s.msd);
    json_put_number(writer, "diffusion_msd_error", s.msd_error);
    json_put_number(writer, "diffusion_green_kubo", s.green_kubo);
    const double error = motion_green_kubo_uncertainty(&s);
    json_put_number(writer, "diffusion_green_kubo_error", error);
    json_put_number(writer, "diffusion_green_kubo_sampling", s.green_kubo_sampling);
    json_put_number(writer, "diffusion_green_kubo_truncation", s.green_kubo_truncation);
    if (units_known(units)) {
        const double unit = units_diffusion_cm2_per_s(units);
        json_put_number(writer, "diffusion_msd_cm2_per_s", s.msd * unit);
        json_put_number(writer, "diffusion_msd_error_cm2_per_s", s.msd_error * unit);
        json_put_number(writer, "diffusion_green_kubo_cm2_per_s", s.green_kubo * unit);
        json_put_number(writer, "diffusion_green_kubo_error_cm2_per_s", error * unit);
    }
    json_put_number(writer, "fit_begin", s.fit_begin);
    json_put_number(writer, "fit_end", s.fit_end);
    if (s.maxwell.numbers > 0) {
        json_put_number(writer, "velocities_tested", s.maxwell.numbers);
        json_put_number(writer, "velocities_kolmogorov_smirnov", s.maxwell.statistic);
        json_put_number(writer, "velocities_p_value", s.maxwell.probability);
    }
    json_end(writer);
}

void simulate_motion_say(const struct simulate_motion *motion, struct progress *to) {
    if (!motion->on)
        return;
    char msd[NUMBER_TEXT_SIZE], green_kubo[NUMBER_TEXT_SIZE];
    const struct motion_summary s = motion_result(&motion->motion, NULL);
    number_text(s.msd, s.msd_error, msd);
    number_text(s.green_kubo, motion_green_kubo_uncertainty(&s), green_kubo);
    progress_say(to, "D = %s by the MSD from %.4g to %.4g tau, %s by Green and Kubo", msd,
                 s.fit_begin, s.fit_end, green_kubo);
    if (motion_judge(&s) != STATUS_OK)
        progress_say(to, "mesofit: warning: %s", status_message());
}
