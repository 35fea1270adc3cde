// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/simulate_force_covariance.h"

#include "base/memory.h"
#include "io/data_table.h"

void mf_simulate_force_covariance_read(struct simulate_force_covariance *covariance,
                                       struct json_object *root) {
    struct json_object object = mf_json_child(root, "force_covariance", false);
    covariance->on = object.item != NULL;
    mf_json_fields(&object, mf_force_covariance_fields, &covariance->plan);
    if (covariance->on)
        mf_json_finish(&object);
}

void mf_simulate_force_covariance_write_used(const struct simulate_force_covariance *covariance,
                                             struct json_writer *writer) {
    if (!covariance->on)
        return;
    mf_json_begin(writer, "force_covariance");
    mf_json_put_fields(writer, mf_force_covariance_fields, &covariance->plan);
    mf_json_end(writer);
}

enum status mf_simulate_force_covariance_begin(struct simulate_force_covariance *covariance,
                                               const struct simulation *simulation,
                                               const struct measure_plan *measure) {
    if (!covariance->on)
        return STATUS_OK;
    return mf_force_covariance_init(&covariance->covariance, &covariance->plan, simulation,
                                    (size_t)measure->samples);
}

void mf_simulate_force_covariance_clear(struct simulate_force_covariance *covariance) {
    mf_force_covariance_clear(&covariance->covariance);
}

struct force_covariance *
mf_simulate_force_covariance_target(struct simulate_force_covariance *covariance) {
    return covariance->on ? &covariance->covariance : NULL;
}

size_t mf_simulate_force_covariance_spans(struct simulate_force_covariance *covariance,
                                          struct memory_span *spans) {
    return covariance->on ? mf_force_covariance_spans(&covariance->covariance, spans) : 0;
}

enum status
mf_simulate_force_covariance_write_table(const struct simulate_force_covariance *covariance,
                                         const char *file) {
    enum status status = STATUS_OK;
    const size_t bins = (size_t)covariance->plan.bins;
    double *values = NULL;
    if (!covariance->on)
        return STATUS_OK;
    NEW_ARRAY(values, 3 * bins);
    double *r = values, *kappa = r + bins, *error = kappa + bins;
    mf_force_covariance_result(&covariance->covariance, kappa, error);
    for (size_t k = 0; k < bins; k++)
        r[k] = covariance->covariance.width * ((double)k + 0.5);
    const struct data_column columns[] = {{"r[lambda]", r, NULL},
                                          {"kappa[k_B.T_0.mu/tau]", kappa, "%.8g"},
                                          {"kappa_error[k_B.T_0.mu/tau]", error, "%.3g"}};
    status = mf_data_table_write(file, NULL, columns, 3, bins);
done:
    mf_memory_free(values);
    return status;
}
