// SPDX-License-Identifier: GPL-3.0-or-later
#include "formulas_state.h"

#include "curves/expression_text.h"
#include "io/output.h"

#include <math.h>

/// Open a file of the run's folder.
static enum status open_in(const struct inverse_folder *folder, const char *name,
                           struct output *output) {
    char path[OUTPUT_PATH_SIZE];
    folder->file(folder->context, name, path);
    return mf_output_open(output, path);
}

/// A formula of the front as its tables tell it, with what it is shifted by.
struct converted {
    struct expression expression;
    double shift;
};

static struct converted convert(const struct formulas_state *state, int nodes,
                                const struct inverse_folder *folder) {
    const double length = mf_units_factor(folder->units, "lambda");
    const double unit = mf_units_factor(folder->units, mf_unknowns_unit(state->kind));
    struct converted converted = {.expression = state->front[nodes].formula.expression};
    if (!isnan(state->points.zero))
        converted.shift =
            unit * mf_expression_value(&converted.expression, state->points.zero, NULL);
    if (length != 1 || unit != 1)
        mf_expression_scale(&converted.expression, length, unit);
    return converted;
}

/// formulas.tsv: a row a formula; the last column is text.
static enum status write_front(const struct formulas_state *state,
                               const struct inverse_folder *folder) {
    struct output output;
    TRY(open_in(folder, "formulas.tsv", &output));
    fprintf(output.stream, "# nodes\tchosen\texpected\terror[1]\terror_error[1]\tformula\n");
    for (int k = 1; k <= PROGRAMMING_MAX_NODES; k++) {
        const struct formulas_member *member = &state->front[k];
        if (member->formula.expression.length == 0)
            continue;
        const bool known = member->measured && member->error < OPTIMISER_FAILED;
        char text[EXPRESSION_TEXT_SIZE];
        const struct converted converted = convert(state, k, folder);
        mf_expression_print(&converted.expression, EXPRESSION_PLAIN, text);
        fprintf(output.stream, "%d\t%d\t%.6g\t%.6g\t%.3g\t%s\n", member->formula.expression.length,
                known && k == state->progress.chosen, member->formula.error,
                known ? member->error : NAN, known ? sqrt(member->variance) : NAN, text);
    }
    return mf_output_commit(&output);
}

/// formulas.tex: an equation a formula.
static enum status write_latex(const struct formulas_state *state,
                               const struct inverse_folder *folder) {
    const char *symbol = state->kind == UNKNOWN_POTENTIAL ? "\\Phi" : "\\omega";
    struct output output;
    TRY(open_in(folder, "formulas.tex", &output));
    for (int k = 1; k <= PROGRAMMING_MAX_NODES; k++) {
        const struct expression *expression = &state->front[k].formula.expression;
        if (expression->length == 0)
            continue;
        const struct converted converted = convert(state, k, folder);
        const double shift = converted.shift;
        char text[EXPRESSION_TEXT_SIZE];
        mf_expression_print(&converted.expression, EXPRESSION_LATEX, text);
        fprintf(output.stream, "%% %d nodes\n\\begin{equation}\n  %s(r) = %s", expression->length,
                symbol, text);
        if (shift != 0)
            fprintf(output.stream, " %s %.10g", shift < 0 ? "+" : "-", fabs(shift));
        fprintf(output.stream, "\n\\end{equation}\n");
    }
    return mf_output_commit(&output);
}

/// formulas.h: a function a formula, named by its nodes.
static enum status write_c(const struct formulas_state *state,
                           const struct inverse_folder *folder) {
    const double last = mf_unknowns_r(
        &state->unknowns, state->kind)[mf_unknowns_points(&state->unknowns, state->kind) - 1];
    const double length = mf_units_factor(folder->units, "lambda");
    struct output output;
    TRY(open_in(folder, "formulas.h", &output));
    fprintf(output.stream, "#include <math.h>\n");
    for (int k = 1; k <= PROGRAMMING_MAX_NODES; k++) {
        const struct expression *expression = &state->front[k].formula.expression;
        if (expression->length == 0)
            continue;
        char text[EXPRESSION_TEXT_SIZE];
        const struct converted converted = convert(state, k, folder);
        mf_expression_print(&converted.expression, EXPRESSION_C, text);
        fprintf(output.stream,
                "\n/* For %.10g <= r < %.10g. */\nstatic inline double formula_%d(double r) {\n"
                "    return %s - (%.17g);\n}\n",
                length * state->points.r[0], length * last, expression->length, text,
                converted.shift);
    }
    return mf_output_commit(&output);
}

enum status mf_formulas_write(const void *memory, const struct inverse_folder *folder) {
    const struct formulas_state *state = memory;
    TRY(write_front(state, folder));
    TRY(write_latex(state, folder));
    return write_c(state, folder);
}
