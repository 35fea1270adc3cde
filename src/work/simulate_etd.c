// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/simulate_etd.h"

#include "base/memory.h"
#include "io/data_table.h"
#include "io/output.h"

void mf_simulate_etd_read(struct simulate_etd *etd, struct json_object *root) {
    struct json_object object = mf_json_child(root, "etd", false);
    etd->on = object.item != NULL;
    mf_json_fields(&object, mf_etd_grid_fields, &etd->grid);
    mf_json_fields(&object, mf_etd_plan_fields, &etd->plan);
    if (etd->on)
        mf_json_finish(&object);
}

void mf_simulate_etd_write_used(const struct simulate_etd *etd, struct json_writer *writer) {
    if (!etd->on)
        return;
    mf_json_begin(writer, "etd");
    mf_json_put_fields(writer, mf_etd_grid_fields, &etd->grid);
    mf_json_put_fields(writer, mf_etd_plan_fields, &etd->plan);
    mf_json_end(writer);
}

enum status mf_simulate_etd_begin(struct simulate_etd *etd, const struct simulation *simulation,
                                  const struct measure_plan *measure) {
    if (!etd->on)
        return STATUS_OK;
    etd->interval = (double)etd->plan.every * simulation->setup.time_step;
    return mf_etd_init(&etd->etd, &etd->grid, &etd->plan, simulation, measure->equilibration,
                       measure->samples * measure->every);
}

void mf_simulate_etd_clear(struct simulate_etd *etd) {
    mf_etd_clear(&etd->etd);
}

struct etd *mf_simulate_etd_target(struct simulate_etd *etd) {
    return etd->on ? &etd->etd : NULL;
}

size_t mf_simulate_etd_spans(struct simulate_etd *etd, struct memory_span *spans) {
    return etd->on ? mf_etd_spans(&etd->etd, spans) : 0;
}

// Tables ------------------------------------------------------------------------------------------

static double centre(const struct etd_grid *grid, size_t bin) {
    const double width = (grid->r_maximum - grid->r_minimum) / (double)grid->bins;
    return grid->r_minimum + width * ((double)bin + 0.5);
}

/// Times, then a column for each bin of the matrix `values`, shape [times, bins].
static enum status write_matrix(const struct simulate_etd *etd, const char *file, const char *what,
                                const double *values, const char *format) {
    enum status status = STATUS_OK;
    const size_t times = (size_t)etd->grid.times, bins = (size_t)etd->grid.bins;
    double *columns = NULL;
    struct data_column *column = NULL;
    char(*name)[48] = NULL;
    NEW_ARRAY(columns, (bins + 1) * times);
    NEW_ARRAY(column, bins + 1);
    NEW_ARRAY(name, bins + 1);
    for (size_t k = 0; k <= bins; k++) {
        column[k] = (struct data_column){name[k], columns + k * times, k ? format : NULL};
        snprintf(name[k], sizeof *name, k ? "%s(r0=%.6g)[1]" : "time[tau]", what,
                 k ? centre(&etd->grid, k - 1) : 0);
        for (size_t t = 0; t < times; t++)
            columns[k * times + t] = k ? values[t * bins + k - 1] : (double)t * etd->interval;
    }
    status = mf_data_table_write(file, NULL, column, bins + 1, times);
done:
    mf_memory_free(columns);
    mf_memory_free(column);
    mf_memory_free(name);
    return status;
}

static enum status write_bins(const struct simulate_etd *etd, const char *file,
                              const uint64_t *pairs) {
    enum status status = STATUS_OK;
    const size_t bins = (size_t)etd->grid.bins;
    double *r = NULL, *n = NULL;
    NEW_ARRAY(r, bins);
    NEW_ARRAY(n, bins);
    for (size_t k = 0; k < bins; k++) {
        r[k] = centre(&etd->grid, k);
        n[k] = (double)pairs[k];
    }
    const struct data_column columns[] = {{"r0[lambda]", r, NULL}, {"pairs[1]", n, "%.0f"}};
    status = mf_data_table_write(file, NULL, columns, 2, bins);
done:
    mf_memory_free(r);
    mf_memory_free(n);
    return status;
}

enum status mf_simulate_etd_write_tables(const struct simulate_etd *etd, const char *folder) {
    enum status status = STATUS_OK;
    const struct etd *const replicas[] = {&etd->etd};
    double *survival = NULL, *error = NULL;
    uint64_t *pairs = NULL;
    char path[OUTPUT_PATH_SIZE + 16];
    if (!etd->on)
        return STATUS_OK;
    NEW_ARRAY(survival, etd_cells(&etd->etd));
    NEW_ARRAY(error, etd_cells(&etd->etd));
    NEW_ARRAY(pairs, (size_t)etd->grid.bins);
    CHECK(mf_etd_result(replicas, 1, survival, error, pairs));
    snprintf(path, sizeof path, "%s/etd.tsv", folder);
    CHECK(write_matrix(etd, path, "E", survival, "%.8g"));
    snprintf(path, sizeof path, "%s/etd_error.tsv", folder);
    CHECK(write_matrix(etd, path, "E_error", error, "%.3g"));
    snprintf(path, sizeof path, "%s/etd_bins.tsv", folder);
    CHECK(write_bins(etd, path, pairs));
done:
    mf_memory_free(survival);
    mf_memory_free(error);
    mf_memory_free(pairs);
    return status;
}

void mf_simulate_etd_write_summary(const struct simulate_etd *etd, struct json_writer *writer) {
    uint64_t pairs = 0;
    if (!etd->on)
        return;
    for (size_t block = 0; block < etd->etd.blocks; block++)
        for (int64_t bin = 0; bin < etd->grid.bins; bin++)
            pairs += etd->etd.counts[block * etd_cells(&etd->etd) + (size_t)bin];
    mf_json_begin(writer, "etd");
    mf_json_put_integer(writer, "origins", (int64_t)etd->etd.origins);
    mf_json_put_integer(writer, "pairs", (int64_t)pairs);
    mf_json_put_number(writer, "interval", etd->interval);
    mf_json_end(writer);
}
