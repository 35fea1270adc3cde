// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/bench_accuracy_output.h"

#include "io/json_write.h"

#include <math.h>
#include <string.h>

enum { CELL_SIZE = 48 };

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

void mf_bench_number_text(char *text, size_t size, double value, double error) {
    if (!isfinite(value)) {
        snprintf(text, size, "-");
        return;
    }
    if (!isfinite(error) || error <= 0) {
        snprintf(text, size, "%.4g", value);
        return;
    }
    double unit = pow(10, floor(log10(error)));
    if (error / unit < 1.95) // 0.31(14), not 0.3(1)
        unit /= 10;
    const int decimals = (int)fmax(0, -floor(log10(unit) + 0.5));
    const double shown = decimals > 0 ? error / pow(10, -decimals) : error;
    snprintf(text, size, "%.*f(%.0f)", decimals, value, shown);
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
    char cell[CELL_SIZE];
    mf_bench_number_text(cell, sizeof cell, scale * value, scale * error);
    fprintf(stream, "  %*s", width, cell);
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
        char cell[CELL_SIZE];
        if ((q == BENCH_TOTAL && diagram->has_omega) || !isfinite(value[BENCH_VALUES + 2 * q]))
            continue;
        mf_bench_number_text(cell, sizeof cell, value[BENCH_VALUES + 2 * q],
                             value[BENCH_VALUES + 2 * q + 1]);
        fprintf(stream, "%s %s %s", q > 0 ? "," : "", names[q], cell);
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
        char cell[CELL_SIZE];
        const double ratio = usual->cpu / limit->cpu;
        mf_bench_number_text(
            cell, sizeof cell, ratio,
            ratio * hypot(usual->cpu_error / usual->cpu, limit->cpu_error / limit->cpu));
        fprintf(stream, ", %s times less than %s at %.2g tau", cell, usual->method,
                usual->time_step);
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
