// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/fit_farthest.h"

#include "base/number_text.h"
#include "io/units_text.h"
#include "observe/kirkwood_buff.h"
#include "problem/group_kind.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct fit_farthest mf_fit_farthest_find(const struct fit_file *fit,
                                         const struct verification *verification,
                                         enum fit_judged judged) {
    static const double nothing = 100; // χ² by value
    struct fit_farthest farthest = {0};
    for (size_t s = 0; s <= fit->others; s++)
        for (int kind = 0; kind < TARGETS; kind++) {
            const struct verify_agreement *own = judged == FIT_TARGETS_FITTED
                                                     ? &verification[s].agreement[kind]
                                                     : &verification[s].compared[kind];
            const struct verify_agreement *most = farthest.agreement;
            if (own->probable > 0 && own->probable < nothing && own->distance.noise > 0 &&
                (most == NULL || verify_agreement_off(own) > verify_agreement_off(most)))
                farthest =
                    (struct fit_farthest){judged, s == 0 ? fit : &fit->other[s - 1], kind, own};
        }
    return farthest;
}

// Where it is -------------------------------------------------------------------------------------

enum { RANGE_SIZE = 96, PLACE_SIZE = 2 * RANGE_SIZE };

/// " from 0.1 to 0.2 ps", " for r at 0.1 nm".
static void describe_range(const char *of, double first, double last, const struct units *units,
                           const char *quantity, char text[RANGE_SIZE]) {
    const double factor = mf_units_factor(units, quantity);
    const char *const before = of[0] ? " for " : "";
    char unit[UNITS_NAME_SIZE];
    mf_units_suffix(units, quantity, unit);
    if (first == last)
        snprintf(text, RANGE_SIZE, "%s%.24s at %.3g%.16s", before, of, factor * first, unit);
    else
        snprintf(text, RANGE_SIZE, "%s%.24s from %.3g to %.3g%.16s", before, of, factor * first,
                 factor * last, unit);
}

/// The same of the argument of a curve, "q[1/lambda]".
static void describe_argument(const char *argument, double first, double last,
                              const struct units *units, char text[RANGE_SIZE]) {
    char name[24], quantity[UNITS_NAME_SIZE];
    size_t length;
    const char *const unit = mf_units_text_in_brackets(argument, &length);
    snprintf(name, sizeof name, "%.*s", (int)strcspn(argument, "["), argument);
    snprintf(quantity, sizeof quantity, "%.*s", (int)length, unit);
    describe_range(name, first, last, units, quantity, text);
}

/// " of A-B for r from 0.3 to 0.35 nm": so many bins of g(r) of all pair types.
static void describe_pairs(const struct fit_file *state, size_t first, size_t count,
                           char text[PLACE_SIZE]) {
    const struct rdf_bins *bins = &state->problem.compared.bins;
    const struct composition *composition = &state->scene.setup.composition;
    const size_t pair = bins->count > 0 ? first / bins->count : 0;
    char name[COMPOSITION_PAIR_NAME_SIZE] = "", range[RANGE_SIZE];
    if (composition_is_mixed(composition))
        mf_composition_pair_name(composition, (int)pair, name);
    describe_range("r", mf_rdf_bins_edge(bins, first - pair * bins->count),
                   mf_rdf_bins_edge(bins, first - pair * bins->count + count), &state->scene.units,
                   "lambda", range);
    snprintf(text, PLACE_SIZE, "%s%.64s%s", name[0] ? " of " : "", name, range);
}

/// " of CC for theta from 100 to 110 degrees". Returns whether the kind is one of groups.
static bool describe_group(const struct fit_file *state, int kind, size_t first, size_t count,
                           char text[PLACE_SIZE]) {
    const struct inverse_problem *problem = &state->problem;
    for (size_t g = 0; g < problem->bonded; g++) {
        const struct bonded_unknown *unknown = &problem->group[g];
        const struct bonded_bins *bins = &unknown->bins;
        if (mf_group_kind_target(unknown->order) != kind || first < unknown->first ||
            first >= unknown->first + bins->count)
            continue;
        const double low = bins->low + (double)(first - unknown->first) * bins->width;
        char range[RANGE_SIZE];
        describe_argument(mf_observable_kind(kind).target->argument, low,
                          low + (double)count * bins->width, &state->scene.units, range);
        snprintf(text, PLACE_SIZE, " of %.64s%s", mf_group_kind_group(&state->scene.setup, unknown),
                 range);
        return true;
    }
    return false;
}

/// E(t, r_0) of a range of times and one of r_0.
static void describe_escapes(const struct targets *targets, const struct verify_part *part,
                             const struct units *units, char text[PLACE_SIZE]) {
    const struct etd_grid *grid = &targets->etd;
    const double width = (grid->r_maximum - grid->r_minimum) / (double)grid->bins;
    char times[RANGE_SIZE], lengths[RANGE_SIZE];
    describe_range("", targets->etd_interval * (double)part->row,
                   targets->etd_interval * (double)(part->row + part->rows - 1), units, "tau",
                   times);
    describe_range("r_0", grid->r_minimum + width * (double)part->column,
                   grid->r_minimum + width * (double)(part->column + part->columns), units,
                   "lambda", lengths);
    snprintf(text, PLACE_SIZE, "%s%s", times, lengths);
}

/// Of any other curve, by its points; of integrals of Kirkwood and Buff the pair; of a number "".
static void describe_values(const struct fit_file *state, int kind, const struct verify_part *part,
                            char text[PLACE_SIZE]) {
    const struct targets *targets = &state->problem.compared;
    const struct target *target = &targets->target[kind];
    const struct units *units = &state->scene.units;
    const size_t first = part->column, last = part->column + part->columns - 1;
    text[0] = '\0';
    if (kind == TARGET_VACF || kind == TARGET_MSD)
        describe_range("", targets->motion_interval * (double)first,
                       targets->motion_interval * (double)last, units, "tau", text);
    else if (target->x)
        describe_argument(mf_observable_kind(kind).target->argument, target->x[first],
                          target->x[last], units, text);
    else if (kind == mf_kirkwood_buff_kind() && target->count > 1 && first == last) {
        const struct target_kirkwood_buff *integrals = state->files.own[kind];
        char name[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(&integrals->components, (int)first, name);
        snprintf(text, PLACE_SIZE, " of %s", name);
    }
}

static void describe_place(const struct fit_farthest *farthest, bool whole, char text[PLACE_SIZE]) {
    const struct fit_file *state = farthest->state;
    const struct verify_part *part = &farthest->agreement->part;
    const struct verify_stretch *stretch = &farthest->agreement->stretch;
    const size_t first = whole ? part->column : stretch->first;
    const size_t count = whole ? part->columns : stretch->count;
    if (farthest->kind == TARGET_RDF)
        describe_pairs(state, first, count, text);
    else if (farthest->kind == TARGET_ETD)
        describe_escapes(&state->problem.compared, part, &state->scene.units, text);
    else if (!describe_group(state, farthest->kind, first, count, text))
        describe_values(state, farthest->kind, part, text);
}

// How far it is off -------------------------------------------------------------------------------

/// Two digits of each of two numbers, or as many as tell them apart.
static void print_apart(const double number[2], char text[2][NUMBER_TEXT_SIZE]) {
    static const int most = 6;
    for (int digits = 2; digits <= most; digits++) {
        for (int k = 0; k < 2; k++)
            snprintf(text[k], NUMBER_TEXT_SIZE, "%.*g", digits, number[k]);
        if (strcmp(text[0], text[1]) != 0)
            return;
    }
}

void mf_fit_farthest_describe(const struct fit_farthest *farthest, char text[FIT_FARTHEST_SIZE]) {
    const struct verify_agreement *own = farthest->agreement;
    const bool whole = own->misfit / own->probable >= verify_agreement_off(own);
    const double off[2] = {sqrt(whole ? own->misfit : own->stretch.misfit),
                           sqrt(whole ? own->probable : own->stretch.probable)};
    char number[2][NUMBER_TEXT_SIZE], place[PLACE_SIZE];
    print_apart(off, number);
    describe_place(farthest, whole, place);
    snprintf(
        text, FIT_FARTHEST_SIZE, "%.24s%s by %.12s times its statistical error (by %s up to %.12s)",
        mf_targets_name(farthest->kind), place, number[0],
        farthest->judged == FIT_TARGETS_FITTED ? "chance" : "the noise of target and simulations",
        number[1]);
}
