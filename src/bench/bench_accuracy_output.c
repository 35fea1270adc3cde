// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench_accuracy_output.h"

#include "base/number_text.h"
#include "io/json_write.h"

#include <math.h>
#include <string.h>

// The reference -----------------------------------------------------------------------------------

static struct bench_number extrapolated(struct bench_number fine, struct bench_number coarse,
                                        double weight) {
    return (struct bench_number){fine.value - weight * (coarse.value - fine.value),
                                 hypot((1 + weight) * fine.error, weight * coarse.error)};
}

static const struct bench_point *find_partner(const struct bench_point *reference,
                                              const struct bench_point *points, size_t count) {
    const struct bench_point *best = NULL;
    for (size_t k = 0; k < count; k++) {
        const struct bench_point *point = &points[k];
        const double ratio = point->time_step / reference->time_step;
        if (strcmp(point->method->name, reference->method->name) != 0 ||
            point->status != STATUS_OK || ratio < 2.5 || ratio > 6)
            continue;
        if (best == NULL ||
            fabs(log(ratio / 4)) < fabs(log(best->time_step / reference->time_step / 4)))
            best = point;
    }
    return best;
}

struct bench_extrapolation mf_bench_extrapolate(struct bench_point *reference,
                                                const struct bench_point *points, size_t count,
                                                size_t bins) {
    const struct bench_point *partner = find_partner(reference, points, count);
    if (partner == NULL)
        return (struct bench_extrapolation){0, 0};
    const double ratio = partner->time_step / reference->time_step;
    const double weight = 1 / (ratio * ratio - 1);
    double moved = 0;
    for (size_t k = 0; k < bins; k++) {
        const struct bench_number before = reference->g[k];
        reference->g[k] = extrapolated(before, partner->g[k], weight);
        moved = fmax(moved, fabs(reference->g[k].value - before.value));
    }
    for (int q = 0; q < BENCH_DRIFT; q++)
        reference->quantity[q] = extrapolated(reference->quantity[q], partner->quantity[q], weight);
    return (struct bench_extrapolation){partner->time_step, moved};
}

// Errors ------------------------------------------------------------------------------------------

double mf_bench_expected_largest(const double *error, size_t count) {
    double max = 0, sum = 0;
    for (size_t k = 0; k < count; k++)
        max = fmax(max, error[k]);
    const double step = max / 50;
    for (int i = 0; i < 400 && max > 0; i++) {
        double below = 1;
        for (size_t k = 0; k < count; k++)
            if (error[k] > 0)
                below *= erf((i + 0.5) * step / (sqrt(2) * error[k]));
        sum += (1 - below) * step;
    }
    return sum;
}

static void find_rdf_errors(const struct bench_point *point, const struct bench_point *reference,
                            size_t bins, struct bench_row *row) {
    double error[BENCH_MAX_BINS], squares = 0, variance = 0;
    double *value = row->value;
    value[BENCH_G_LARGEST] = -1;
    for (size_t k = 0; k < bins; k++) {
        const double change = fabs(point->g[k].value - reference->g[k].value);
        error[k] = hypot(point->g[k].error, reference->g[k].error);
        const double noise = error[k] * error[k];
        squares += change * change - noise;
        variance += 4 * fmax(change * change - noise, 0) * noise + 2 * noise * noise;
        if (change <= value[BENCH_G_LARGEST])
            continue;
        value[BENCH_G_LARGEST] = change;
        value[BENCH_G_LARGEST_ERROR] = error[k];
    }
    const double n = (double)bins;
    value[BENCH_G_NOISE] = mf_bench_expected_largest(error, bins);
    value[BENCH_G_RMS] = sqrt(fmax(squares / n, 0));
    value[BENCH_G_RMS_ERROR] = sqrt(fmax(squares / n, 0) + sqrt(variance) / n) - value[BENCH_G_RMS];
}

struct bench_row mf_bench_row_of(const struct bench_point *point,
                                 const struct bench_point *reference, size_t bins, double wanted) {
    struct bench_row row = {.method = point->method->name};
    double *value = row.value, worst = 0;
    for (size_t k = 0; k < bins; k++)
        worst = fmax(worst, point->g[k].error);
    value[BENCH_TIME_STEP] = point->time_step;
    value[BENCH_CPU] = point->cpu.value;
    value[BENCH_CPU_ERROR] = point->cpu.error;
    value[BENCH_CPU_TO_ERROR] = point->cpu.value * point->time * pow(worst / wanted, 2);
    find_rdf_errors(point, reference, bins, &row);
    for (int q = 0; q < BENCH_QUANTITIES; q++) {
        const struct bench_number here = point->quantity[q], there = reference->quantity[q];
        value[BENCH_CHANGES + 2 * q] = here.value - there.value;
        value[BENCH_CHANGES + 2 * q + 1] = hypot(here.error, there.error);
        value[BENCH_VALUES + 2 * q] = here.value;
        value[BENCH_VALUES + 2 * q + 1] = here.error;
    }
    return row;
}

// What to recommend -------------------------------------------------------------------------------

struct bench_limit mf_bench_limit_of(const struct bench_row *rows, size_t count, double wanted) {
    size_t good = 0;
    while (good < count && rows[good].value[BENCH_G_LARGEST] <= wanted)
        good++;
    if (good == 0)
        return (struct bench_limit){.method = NULL};
    const double *low = rows[good - 1].value;
    struct bench_limit limit = {.method = rows[good - 1].method,
                                .time_step = low[BENCH_TIME_STEP],
                                .cpu = low[BENCH_CPU],
                                .cpu_error = low[BENCH_CPU_ERROR],
                                .is_bounded = good < count};
    if (good == count)
        return limit;
    const double *high = rows[good].value;
    const double rise = log(high[BENCH_G_LARGEST] / low[BENCH_G_LARGEST]);
    const double steps = log(high[BENCH_TIME_STEP] / low[BENCH_TIME_STEP]);
    const double costs = log(high[BENCH_CPU] / low[BENCH_CPU]);
    const double part = log(wanted / low[BENCH_G_LARGEST]) / rise;
    // What the interpolated error is uncertain by moves the crossing along.
    const double noise = hypot((1 - part) * low[BENCH_G_LARGEST_ERROR] / low[BENCH_G_LARGEST],
                               part * high[BENCH_G_LARGEST_ERROR] / high[BENCH_G_LARGEST]);
    limit.time_step *= exp(part * steps);
    limit.time_step_error = limit.time_step * noise * steps / rise;
    limit.cpu *= exp(part * costs);
    const double timing = hypot((1 - part) * low[BENCH_CPU_ERROR] / low[BENCH_CPU],
                                part * high[BENCH_CPU_ERROR] / high[BENCH_CPU]);
    limit.cpu_error = limit.cpu * hypot(noise * costs / rise, timing);
    return limit;
}

struct column {
    const char *key, *unit; ///< in JSON and TSV
};

#define QUANTITY(name, unit)                                                                       \
    {name, unit}, {                                                                                \
        name "_error", unit                                                                        \
    }

static const struct column columns[BENCH_COLUMNS] = {
    [BENCH_TIME_STEP] = {"time_step", "tau"},
    [BENCH_CPU] = QUANTITY("cpu", "s/tau"),
    [BENCH_CPU_TO_ERROR] = {"cpu_to_error", "s"},
    [BENCH_G_LARGEST] = QUANTITY("g_largest", "1"),
    [BENCH_G_NOISE] = {"g_noise", "1"},
    [BENCH_G_RMS] = QUANTITY("g_rms", "1"),
    [BENCH_CHANGES] = QUANTITY("temperature_change", "T_0"),
    QUANTITY("configurational_change", "T_0"),
    QUANTITY("energy_change", "k_B.T_0"),
    QUANTITY("pressure_change", "k_B.T_0/lambda^d"),
    QUANTITY("diffusion_change", "lambda^2/tau"),
    QUANTITY("total_energy_change", "k_B.T_0"),
    QUANTITY("drift_change", "k_B.T_0/tau"),
    [BENCH_VALUES] = QUANTITY("temperature", "T_0"),
    QUANTITY("temperature_configurational", "T_0"),
    QUANTITY("potential_energy", "k_B.T_0"),
    QUANTITY("pressure", "k_B.T_0/lambda^d"),
    QUANTITY("diffusion", "lambda^2/tau"),
    QUANTITY("total_energy", "k_B.T_0"),
    QUANTITY("drift", "k_B.T_0/tau"),
};

// For people --------------------------------------------------------------------------------------

/// A number with its error; "-" if there is none.
static const char *number_text(double value, double error, char text[NUMBER_TEXT_SIZE]) {
    if (isfinite(value))
        mf_number_text(value, error, text);
    return isfinite(value) ? text : "-";
}

size_t mf_bench_cheapest(const struct bench_diagram *diagram) {
    size_t best = diagram->methods;
    for (size_t m = 0; m < diagram->methods; m++)
        if (diagram->limit[m].method &&
            (best == diagram->methods || diagram->limit[m].cpu < diagram->limit[best].cpu))
            best = m;
    return best;
}

static void print_cell(FILE *stream, int width, double value, double error, double scale) {
    char text[NUMBER_TEXT_SIZE];
    fprintf(stream, "  %*s", width, number_text(scale * value, scale * error, text));
}

static void print_change(FILE *stream, const struct bench_row *row, enum bench_quantity quantity,
                         double scale) {
    const double *change = row->value + BENCH_CHANGES + 2 * quantity;
    print_cell(stream, 13, change[0], change[1], scale);
}

static void print_row(FILE *stream, const struct bench_diagram *diagram,
                      const struct bench_row *row) {
    const double *value = row->value;
    const double *there = diagram->reference.value + BENCH_VALUES;
    fprintf(stream, "%-16s  %7.4g", row->method, value[BENCH_TIME_STEP]);
    print_cell(stream, 9, value[BENCH_CPU], value[BENCH_CPU_ERROR], 1e3);
    fprintf(stream, "  %7.3g", value[BENCH_CPU_TO_ERROR]);
    print_cell(stream, 11, value[BENCH_G_LARGEST], value[BENCH_G_LARGEST_ERROR], 1);
    print_cell(stream, 11, value[BENCH_G_RMS], value[BENCH_G_RMS_ERROR], 1);
    print_change(stream, row, BENCH_TEMPERATURE, 100 / there[2 * BENCH_TEMPERATURE]);
    print_change(stream, row, BENCH_CONFIGURATIONAL, 100 / there[2 * BENCH_CONFIGURATIONAL]);
    print_change(stream, row, BENCH_PRESSURE, 1);
    print_change(stream, row, BENCH_ENERGY, 1);
    print_change(stream, row, BENCH_DIFFUSION, 100 / there[2 * BENCH_DIFFUSION]);
    if (!diagram->has_omega) {
        print_change(stream, row, BENCH_TOTAL, 1);
        print_cell(stream, 13, value[BENCH_VALUES + 2 * BENCH_DRIFT],
                   value[BENCH_VALUES + 2 * BENCH_DRIFT + 1], 1);
    }
    fprintf(stream, "\n");
}

static void print_reference(FILE *stream, const struct bench_diagram *diagram) {
    static const char *const names[] = {
        "kinetic temperature",   "configurational", "energy", "pressure",
        "diffusion coefficient", "total energy"};
    const double *value = diagram->reference.value;
    fprintf(stream, "%s: %zu particles, %.4g tau a point\nreference: %s at %.4g tau",
            diagram->scene, diagram->particles, diagram->time, diagram->reference.method,
            value[BENCH_TIME_STEP]);
    if (diagram->extrapolation.partner > 0)
        fprintf(stream, " (with %.4g tau, extrapolated to 0, which moves g by up to %.2g)",
                diagram->extrapolation.partner, diagram->extrapolation.moved);
    fprintf(stream, ", %.4g tau:\n ", diagram->reference_time);
    for (int q = 0; q < BENCH_DRIFT; q++) {
        char text[NUMBER_TEXT_SIZE];
        if ((q == BENCH_TOTAL && diagram->has_omega) || !isfinite(value[BENCH_VALUES + 2 * q]))
            continue;
        fprintf(stream, "%s %s %s", q > 0 ? "," : "", names[q],
                number_text(value[BENCH_VALUES + 2 * q], value[BENCH_VALUES + 2 * q + 1], text));
    }
    double noise = 0;
    for (size_t k = 0; k < diagram->rows; k++)
        noise += diagram->row[k].value[BENCH_G_NOISE] / (double)diagram->rows;
    fprintf(stream, "\n  changes against it; noise alone would make a largest |dg| of %.2g\n\n",
            noise);
}

static void print_limits(FILE *stream, const struct bench_diagram *diagram) {
    fprintf(stream, "\nlargest time step with |dg| <= %g:\n", diagram->wanted);
    for (size_t m = 0; m < diagram->methods; m++) {
        const struct bench_limit *limit = &diagram->limit[m];
        fprintf(stream, "%-16s", diagram->method[m]);
        if (limit->method == NULL) {
            fprintf(stream, "  none\n");
            continue;
        }
        print_cell(stream, 12, limit->time_step, limit->time_step_error, 1);
        fprintf(stream, " tau");
        print_cell(stream, 9, limit->cpu, limit->cpu_error, 1e3);
        fprintf(stream, " ms/tau%s\n",
                limit->is_bounded ? "" : "  (the largest that was run and is stable)");
    }
}

/// The method that the others are measured against: the one that the program takes by itself.
static const struct bench_limit *find_usual(const struct bench_diagram *diagram) {
    for (size_t m = 0; m < diagram->methods; m++)
        if (diagram->limit[m].method && strcmp(diagram->method[m], "dpd-verlet(0.5)") == 0)
            return &diagram->limit[m];
    return NULL;
}

static void print_recommendation(FILE *stream, const struct bench_diagram *diagram) {
    const size_t best = mf_bench_cheapest(diagram);
    if (best == diagram->methods) {
        fprintf(stream,
                "\nno time step here has |dg| <= %g for certain; try smaller ones "
                "(--time-steps) or longer runs (--time)\n",
                diagram->wanted);
        return;
    }
    const struct bench_limit *limit = &diagram->limit[best], *usual = find_usual(diagram);
    fprintf(stream, "\nfor |dg| <= %g take %s with a time step of %.2g tau: %.3g ms/tau",
            diagram->wanted, limit->method, limit->time_step, 1e3 * limit->cpu);
    if (usual && usual != limit) {
        char text[NUMBER_TEXT_SIZE];
        const double ratio = usual->cpu / limit->cpu;
        const double error =
            ratio * hypot(usual->cpu_error / usual->cpu, limit->cpu_error / limit->cpu);
        fprintf(stream, ", %s times less than %s at %.2g tau", number_text(ratio, error, text),
                usual->method, usual->time_step);
    }
    fprintf(stream, "\n");
}

void mf_bench_accuracy_table(FILE *stream, const struct bench_diagram *diagram) {
    print_reference(stream, diagram);
    fprintf(stream, "%-16s  %7s  %9s  %7s  %11s  %11s  %13s  %13s  %13s  %13s  %13s", "integrator",
            "step", "cpu", "to err.", "|dg|", "rms dg", "dT kinetic", "dT config.", "dP", "dU",
            "dD");
    fprintf(stream, diagram->has_omega ? "\n" : "  %13s  %13s\n", "dE", "drift of E");
    fprintf(stream, "%-16s  %7s  %9s  %7s  %11s  %11s  %13s  %13s  %13s  %13s  %13s", "", "tau",
            "ms/tau", "s", "largest", "", "%", "%", "kT/lambda^d", "kT", "%");
    fprintf(stream, diagram->has_omega ? "\n" : "  %13s  %13s\n", "kT", "kT/tau");
    for (size_t k = 0; k < diagram->rows; k++)
        print_row(stream, diagram, &diagram->row[k]);
    print_limits(stream, diagram);
    print_recommendation(stream, diagram);
}

// For programs ------------------------------------------------------------------------------------

static void write_row(struct json_writer *writer, const char *role, const struct bench_row *row) {
    const bool has_changes = strcmp(role, "reference") != 0;
    mf_json_begin(writer, NULL);
    mf_json_write_text(writer, "role", role);
    mf_json_write_text(writer, "integrator", row->method);
    for (int k = 0; k < BENCH_COLUMNS; k++)
        if (isfinite(row->value[k]) && (has_changes || k < BENCH_G_LARGEST || k >= BENCH_VALUES))
            mf_json_write_number(writer, columns[k].key, row->value[k]);
    mf_json_end(writer);
}

static void write_limit(struct json_writer *writer, const char *role,
                        const struct bench_limit *limit) {
    mf_json_begin(writer, NULL);
    mf_json_write_text(writer, "role", role);
    mf_json_write_text(writer, "integrator", limit->method);
    mf_json_put_measured(writer, "time_step", "1", limit->time_step, limit->time_step_error);
    mf_json_put_measured(writer, "cpu", "1", limit->cpu, limit->cpu_error);
    mf_json_end(writer);
}

enum status mf_bench_accuracy_json(FILE *stream, const struct bench_diagram *diagram) {
    struct json_writer *writer = mf_json_writer_create_list();
    if (writer == NULL)
        return STATUS_NO_MEMORY;
    write_row(writer, "reference", &diagram->reference);
    for (size_t k = 0; k < diagram->rows; k++)
        write_row(writer, "point", &diagram->row[k]);
    for (size_t m = 0; m < diagram->methods; m++)
        if (diagram->limit[m].method)
            write_limit(writer, "limit", &diagram->limit[m]);
    const size_t best = mf_bench_cheapest(diagram);
    if (best < diagram->methods)
        write_limit(writer, "recommendation", &diagram->limit[best]);
    const enum status status = mf_json_write_stream(writer, stream, "the results");
    mf_json_writer_free(writer);
    return status;
}

static void write_line(FILE *stream, const struct bench_row *row) {
    fprintf(stream, "%s", row->method);
    for (int k = 0; k < BENCH_COLUMNS; k++)
        fprintf(stream, "\t%.6g", row->value[k]);
    fprintf(stream, "\n");
}

void mf_bench_accuracy_tsv(FILE *stream, const struct bench_diagram *diagram) {
    fprintf(stream, "# %s: %zu particles, %.6g tau a point; reference: ", diagram->scene,
            diagram->particles, diagram->time);
    write_line(stream, &diagram->reference);
    fprintf(stream, "# extrapolated with a time step of %.6g\n# wanted %.6g\n",
            diagram->extrapolation.partner, diagram->wanted);
    for (size_t m = 0; m < diagram->methods; m++)
        if (diagram->limit[m].method)
            fprintf(stream, "# limit %s %.6g %.6g tau %.6g %.6g s/tau\n", diagram->method[m],
                    diagram->limit[m].time_step, diagram->limit[m].time_step_error,
                    diagram->limit[m].cpu, diagram->limit[m].cpu_error);
    fprintf(stream, "# integrator");
    for (int k = 0; k < BENCH_COLUMNS; k++)
        fprintf(stream, "\t%s[%s]", columns[k].key, columns[k].unit);
    fprintf(stream, "\n");
    for (size_t k = 0; k < diagram->rows; k++) {
        if (k > 0 && strcmp(diagram->row[k].method, diagram->row[k - 1].method) != 0)
            fprintf(stream, "\n\n");
        write_line(stream, &diagram->row[k]);
    }
}
