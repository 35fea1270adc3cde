// SPDX-License-Identifier: GPL-3.0-or-later
/// @file How bond lengths, angles and dihedrals of each group are distributed: p(q), ∫ p dq = 1,
/// and p over its Jacobian, which is exp(−U/k_B T) up to a factor where a term stands alone:
///   r^(d−1) of lengths, (sin θ)^(d−2) of angles, 1 of dihedrals
/// (V. Rühle et al., J. Chem. Theory Comput. 5, 3211 (2009), eqs. 5 to 8). Jacobians are integrated
/// over the bins. Errors by the scatter of blocks of time. Tested: test_molecules.
#include "base/memory.h"
#include "base/statistics.h"
#include "forces/bonded.h"
#include "forces/molecules.h"
#include "io/data_table.h"
#include "observe/measure.h"
#include "observe/sample_blocks.h"

#include <math.h>

enum { COLUMNS = 3 };

struct settings {
    int64_t bins;
};

struct state {
    const struct molecules *molecules;
    int order, dimensions;
    size_t bins;
    struct sample_blocks blocks;
    double low, width;                   ///< of the bins [λ] or [rad]
    size_t terms[MOLECULES_MOST_GROUPS]; ///< of each group
    double *counts;                      ///< shape [blocks, groups, bins]
};

static const struct field fields[] = {
    {"bins", FIELD_INTEGER, .offset = offsetof(struct settings, bins), .initial = 100, .minimum = 1,
     .maximum = 100000, .unit = "",
     .help = "of lengths up to twice those at rest, or to where a bond tears; of angles from 0 to "
             "180 degrees, of dihedrals from -180 to 180"},
    FIELD_END,
};

// Sampling ----------------------------------------------------------------------------------------

/// As far as the lengths of any group are likely to go.
static double longest_of(const struct molecules *molecules) {
    double longest = 0;
    for (int g = 0; g < molecules->groups[TOPOLOGY_BOND]; g++) {
        const struct bonded_curve *curve = &molecules->group[TOPOLOGY_BOND][g].curve;
        longest = fmax(longest, fmin(mf_bonded_longest(curve), 2 * mf_bonded_rest(curve)));
    }
    return longest;
}

static enum status begin(struct state *s, int order, const char *name,
                         const struct settings *settings, const struct simulation *simulation,
                         const struct measure_plan *plan) {
    enum status status = STATUS_OK;
    const struct simulation_setup *setup = &simulation->setup;
    const struct molecules *molecules = mf_molecules_find(setup->interaction, setup->interactions);
    if (molecules == NULL || molecules->groups[order] == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: the scene has no %ss", name,
                              mf_topology_order_names[order]);
    *s = (struct state){.molecules = molecules,
                        .order = order,
                        .dimensions = setup->box.dimensions,
                        .bins = (size_t)settings->bins};
    const double high = order == TOPOLOGY_BOND ? longest_of(molecules) : M_PI;
    s->low = order == TOPOLOGY_DIHEDRAL ? -M_PI : 0;
    s->width = (high - s->low) / (double)s->bins;
    CHECK(mf_sample_blocks_init(&s->blocks, (size_t)plan->samples));
    for (int k = 0; k < molecules->topology.kinds; k++) {
        const struct topology_kind *kind = &molecules->topology.kind[k];
        for (int t = 0; t < kind->terms[order]; t++)
            s->terms[kind->term[order][t].group] += (size_t)kind->count;
    }
    NEW_ARRAY(s->counts, s->blocks.count * (size_t)molecules->groups[order] * s->bins);
done:
    return status;
}

static void clear(void *state) {
    struct state *s = state;
    mf_memory_free(s->counts);
    mf_sample_blocks_clear(&s->blocks);
    *s = (struct state){0};
}

/// Count one term in all molecules of a kind; the longest bonds are beyond all bins.
static void count_term(const struct state *s, const struct particles *particles,
                       const struct topology_kind *kind, const struct topology_term *term,
                       double *counts) {
    const int beads = topology_beads(s->order);
    for (int64_t m = 0; m < kind->count; m += BONDED_BATCH) {
        int32_t place[TOPOLOGY_MOST_BEADS * BONDED_BATCH];
        double q[BONDED_BATCH];
        const int64_t left = kind->count - m;
        const size_t some = left < BONDED_BATCH ? (size_t)left : BONDED_BATCH;
        for (size_t n = 0; n < some; n++)
            for (int k = 0; k < beads; k++)
                place[n * (size_t)beads + (size_t)k] =
                    (int32_t)particles->place[topology_id(kind, m + (int64_t)n, term->bead[k])];
        mf_bonded_measure(s->order, some, place, particles, q);
        for (size_t n = 0; n < some; n++) {
            const double bin = (q[n] - s->low) / s->width;
            if (bin >= 0 && bin < (double)s->bins)
                counts[(size_t)bin] += 1;
            else if (s->order != TOPOLOGY_BOND) // the end of the circle, rounded
                counts[s->bins - 1] += 1;
        }
    }
}

static enum status sample(void *state, struct simulation *simulation) {
    struct state *s = state;
    const struct topology *topology = &s->molecules->topology;
    const size_t row = (size_t)s->molecules->groups[s->order] * s->bins;
    if (mf_sample_blocks_are_full(&s->blocks)) {
        mf_sample_blocks_join(&s->blocks, s->counts, row);
        mf_sample_blocks_double(&s->blocks);
    }
    double *counts = s->counts + mf_sample_blocks_take(&s->blocks) * row;
    for (int k = 0; k < topology->kinds; k++)
        for (int t = 0; t < topology->kind[k].terms[s->order]; t++) {
            const struct topology_term *term = &topology->kind[k].term[s->order][t];
            count_term(s, &simulation->particles, &topology->kind[k], term,
                       counts + (size_t)term->group * s->bins);
        }
    return STATUS_OK;
}

static size_t spans(void *state, struct memory_span *spans) {
    struct state *s = state;
    const size_t numbers = s->blocks.count * (size_t)s->molecules->groups[s->order] * s->bins;
    spans[0] = (struct memory_span){s->counts, numbers * sizeof *s->counts};
    return 1 + mf_sample_blocks_spans(&s->blocks, spans + 1);
}

// Results -----------------------------------------------------------------------------------------

/// ∫ of the Jacobian over a bin.
static double jacobian(const struct state *s, size_t bin) {
    const double from = s->low + (double)bin * s->width, to = from + s->width;
    if (s->order == TOPOLOGY_BOND)
        return s->dimensions == 3 ? (pow(to, 3) - pow(from, 3)) / 3 : (to * to - from * from) / 2;
    return s->order == TOPOLOGY_ANGLE && s->dimensions == 3 ? cos(from) - cos(to) : s->width;
}

/// p, its error and p over the Jacobian with a largest value of 1; shape [COLUMNS, bins].
static void find_columns(const struct state *s, int group, double unit, double *values) {
    const size_t groups = (size_t)s->molecules->groups[s->order];
    const size_t whole = mf_sample_blocks_whole(&s->blocks);
    const double terms = (double)s->terms[group];
    double largest = 0;
    for (size_t bin = 0; bin < s->bins; bin++) {
        struct running_mean mean = {0};
        double all = 0;
        for (size_t block = 0; block < s->blocks.count; block++) {
            const double counted = s->counts[(block * groups + (size_t)group) * s->bins + bin];
            all += counted / ((double)s->blocks.taken * terms);
            if (block < whole)
                mf_statistics_add(&mean, counted / (s->blocks.samples[block] * terms));
        }
        values[bin] = all / (unit * s->width);
        values[s->bins + bin] = mf_statistics_standard_error(&mean) / (unit * s->width);
        values[2 * s->bins + bin] = all / jacobian(s, bin);
        largest = fmax(largest, values[2 * s->bins + bin]);
    }
    for (size_t bin = 0; bin < s->bins && largest > 0; bin++)
        values[2 * s->bins + bin] /= largest;
    mf_statistics_forget_errors(values + s->bins, s->bins);
}

/// q, then p, error and p over the Jacobian of each group under its name.
static enum status write_table(const struct state *s, const char *file,
                               const struct observable_results *results) {
    enum { MOST = 1 + COLUMNS * MOLECULES_MOST_GROUPS };
    static const char *const endings[COLUMNS] = {"", "_error", "_boltzmann"};
    static const char *const heads[TOPOLOGY_ORDERS] = {"r[lambda]", "theta[degrees]",
                                                       "phi[degrees]"};
    enum status status = STATUS_OK;
    const int groups = s->molecules->groups[s->order];
    const bool is_length = s->order == TOPOLOGY_BOND;
    const double unit = is_length ? 1 : 1 / BONDED_RADIANS;
    struct data_column columns[MOST];
    char names[MOST][TOPOLOGY_NAME_SIZE + 32], path[OUTPUT_PATH_SIZE];
    double *values = NULL;
    NEW_ARRAY(values, (1 + COLUMNS * (size_t)groups) * s->bins);
    for (size_t bin = 0; bin < s->bins; bin++)
        values[bin] = unit * (s->low + ((double)bin + 0.5) * s->width);
    columns[0] = (struct data_column){heads[s->order], values, NULL};
    for (int g = 0; g < groups; g++) {
        double *own = values + (1 + COLUMNS * (size_t)g) * s->bins;
        find_columns(s, g, unit, own);
        for (int c = 0; c < COLUMNS; c++) {
            const int n = 1 + COLUMNS * g + c;
            snprintf(names[n], sizeof names[n], "%s%s[%s]", s->molecules->group[s->order][g].name,
                     endings[c],
                     c == 2      ? "1"
                     : is_length ? "1/lambda"
                                 : "1/degrees");
            columns[n] =
                (struct data_column){names[n], own + (size_t)c * s->bins, c == 1 ? "%.3g" : "%.8g"};
        }
    }
    mf_observable_file(results, file, path);
    CHECK(mf_data_table_write_in(path, results->units, NULL, columns,
                                 (size_t)(1 + COLUMNS * groups), s->bins));
done:
    mf_memory_free(values);
    return status;
}

/// Nanoseconds of a term and sample.
static void explain(const struct simulation_setup *setup, int order, const char *what, double every,
                    struct stages *stages) {
    static const double cost[TOPOLOGY_ORDERS] = {15, 40, 60};
    const struct molecules *molecules = mf_molecules_find(setup->interaction, setup->interactions);
    double terms = 0;
    for (int k = 0; molecules && k < molecules->topology.kinds; k++)
        terms += (double)molecules->topology.kind[k].terms[order] *
                 (double)molecules->topology.kind[k].count;
    mf_stages_add(stages, what, true,
                  cost[order] * terms / (every * fmax(1, (double)setup->placement.count)),
                  "%.0f of them, one step in %.0f", terms, every);
}

// Records -----------------------------------------------------------------------------------------

#define DISTRIBUTION(record, of, key, what, table)                                                 \
    static enum status record##_begin(void *state, const void *settings,                           \
                                      const struct simulation *simulation,                         \
                                      const struct measure_plan *plan) {                           \
        return begin(state, of, key, settings, simulation, plan);                                  \
    }                                                                                              \
    static enum status record##_write(const void *state,                                           \
                                      const struct observable_results *results) {                  \
        return write_table(state, table, results);                                                 \
    }                                                                                              \
    static void record##_explain(const void *settings, const struct simulation_setup *setup,       \
                                 double every, struct stages *stages) {                            \
        (void)settings;                                                                            \
        explain(setup, of, what, every, stages);                                                   \
    }                                                                                              \
    static const char *const record##_files[] = {table, NULL};                                     \
    const struct observable record = {                                                             \
        .name = key,                                                                               \
        .summary = "distribution of the " what " of each group",                                   \
        .fields = fields,                                                                          \
        .settings_size = sizeof(struct settings),                                                  \
        .state_size = sizeof(struct state),                                                        \
        .begin = record##_begin,                                                                   \
        .clear = clear,                                                                            \
        .sample = sample,                                                                          \
        .spans = spans,                                                                            \
        .write = record##_write,                                                                   \
        .explain = record##_explain,                                                               \
        .stage = what,                                                                             \
        .files = record##_files,                                                                   \
        .figure = OBSERVABLE_FIGURE_OF_GROUPS,                                                     \
    }

DISTRIBUTION(mf_bonded_lengths, TOPOLOGY_BOND, "bond_lengths", "bond lengths", "bond_lengths.tsv");
DISTRIBUTION(mf_bonded_angles, TOPOLOGY_ANGLE, "bond_angles", "bond angles", "bond_angles.tsv");
DISTRIBUTION(mf_bonded_dihedrals, TOPOLOGY_DIHEDRAL, "dihedral_angles", "dihedral angles",
             "dihedral_angles.tsv");
