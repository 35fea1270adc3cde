// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_sanity.h"

#include "base/memory.h"
#include "observe/kirkwood_buff.h"
#include "observe/rdf_observable.h"

#include <math.h>
#include <stdio.h>

/// Measured: the tails of targets/ and of soft fluids, gases and Lennard-Jones near its critical
/// point are within 0.07 of 1, that of a dense Lennard-Jones fluid known up to 1.6 is 0.9(2).
static const double far_from_1 = 0.25;

/// Beads are apart where g is below.
static const double empty = 0.01;

/// A normalisation that is off by so much can be mended by a factor.
static const double normalisation = 1.03;

static const double standard_errors = 3;

/// Layers, and the neighbours that they take up to the second maximum: measured 12 in water, 29 in
/// the Lennard-Jones liquid, 33 in the Gaussian core, and 5 in a model of methanol, whose first
/// layer has only two. With a tenth of the density there are 3.3 at most.
static const double deep = 0.95, few_neighbours = 4;

/// ρ d³ of a gas.
static const double dilute = 0.01;

/// g(r) of one pair type, and how many beads there are.
struct view {
    char name[sizeof "intermolecular_rdf." + COMPOSITION_PAIR_NAME_SIZE];
    const struct target_pairs *all; ///< pair types
    const struct target_rdf *target;
    int kind;    ///< of the target
    double ends; ///< where its file would end [λ]
    const struct rdf_bins *bins;
    const double *g, *error; ///< shape [bins->count]
    const struct scene *scene;
    size_t like;    ///< beads of the type if both of a pair have the same, else 0
    double bound;   ///< of these in the molecule of each, beside itself
    double inside;  ///< what g leaves out of their integral [λ^3]
    double density; ///< of beads of all types [λ^-d]
};

/// What molecules add to the integrals of a pair type, and to those of an ideal gas.
static void add_molecules(struct view *view, const int type[2], size_t pair) {
    const struct topology *topology = &view->scene->molecules.molecules.topology;
    const struct finite_size_fluid fluid = {&view->scene->setup.box,
                                            &view->scene->setup.composition, topology,
                                            view->kind != TARGET_RDF};
    view->inside = mf_finite_size_intramolecular(&fluid, (int)pair);
    if (view->like > 0)
        view->bound = mf_topology_intramolecular_pairs(topology, type, false) / (double)view->like;
}

/// @param[in] kind  the number of the target
static struct view view_of(const struct target_pairs *all, int kind, const struct scene *scene,
                           size_t pair) {
    const size_t bins = target_pairs_bins(all)->count;
    const struct composition *composition = &scene->setup.composition;
    struct view view = {.kind = kind,
                        .all = all,
                        .target = &all->member[pair],
                        .bins = target_pairs_bins(all),
                        .ends = all->ends[pair],
                        .g = all->given + pair * bins,
                        .error = all->error + pair * bins,
                        .scene = scene};
    int type[2];
    snprintf(view.name, sizeof view.name, "%s", mf_targets_name(kind));
    mf_composition_pair_types(composition, (int)pair, type);
    if (type[0] == type[1])
        view.like = (size_t)composition->count[type[0]];
    view.density = (double)mf_composition_particles(composition) / mf_box_volume(&scene->setup.box);
    if (composition_is_mixed(composition)) {
        char pair_name[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(composition, (int)pair, pair_name);
        snprintf(view.name, sizeof view.name, "%s.%s", mf_targets_name(kind), pair_name);
    }
    if (scene_has_molecules(&scene->molecules))
        add_molecules(&view, type, pair);
    return view;
}

static const char *unit_of(const struct view *view, double *length) {
    return mf_target_sanity_length(view->scene, length);
}

/// "14.66 nm^-3 = 0.780 g/cm^3", without the second if no mass is given, or in λ without units.
static void print_density(const struct view *view, char *text, size_t size) {
    const struct units *units = &view->scene->units;
    const int dimensions = view->scene->setup.box.dimensions;
    double length;
    const char *unit = unit_of(view, &length);
    const double density = view->density / pow(length, dimensions);
    if (mf_units_known(units) && !units->massless && dimensions == 3)
        snprintf(text, size, "%.4g %s^-3 = %.3g g/cm^3", density, unit,
                 mf_scene_mass_density(view->scene));
    else
        snprintf(text, size, "%.4g %s^-%d", density, unit, dimensions);
}

/// ∫ (g − 1) d³r of the pairs of two types.
static double integral_of(const struct view *view, int a, int b) {
    const int pair = mf_composition_pair(&view->scene->setup.composition, a, b);
    const struct view own = view_of(view->all, view->kind, view->scene, (size_t)pair);
    return mf_kirkwood_buff_integrate(own.bins, own.g, own.error, &own.scene->setup.box, 0,
                                      own.inside)
        .integral;
}

/// What a fault goes on with if two types look demixed, else "": each has more beads of its own
/// around it than on the whole, and fewer of the other's, as within the phases of a box with two.
static void print_demixing(const struct view *view, char *text, size_t size) {
    const struct composition *composition = &view->scene->setup.composition;
    double length;
    const char *const unit = unit_of(view, &length);
    const double volume = length * length * length;
    text[0] = '\0';
    for (int b = 1; b < composition->types && view->scene->setup.box.dimensions == 3; b++)
        for (int a = 0; a < b && text[0] == '\0'; a++) {
            const double first = integral_of(view, a, a), second = integral_of(view, b, b);
            const double unlike = integral_of(view, a, b);
            const char *one = composition->name[a], *other = composition->name[b];
            if (first > 0 && second > 0 && unlike < 0)
                snprintf(text, size,
                         "; or have %s and %s demixed? Their integrals of g - 1 are %.3g (%s-%s), "
                         "%.3g (%s-%s) and %.3g (%s-%s) %s^3",
                         one, other, volume * first, one, one, volume * second, other, other,
                         volume * unlike, one, other, unit);
        }
}

static enum status check_tail(const struct view *view, const char *file) {
    const struct target_tail *tail = &view->target->tail;
    const struct target_rdf_parameters *p = &view->target->parameters;
    const bool votca = p->format == TARGET_ROWS_VOTCA;
    const double away = fabs(tail->mean - 1);
    if (away <= fmax(far_from_1, 2 * tail->scatter) && !(tail->grows && away > far_from_1))
        return STATUS_OK;
    char demixing[256];
    print_demixing(view, demixing, sizeof demixing);
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s: target.%s.%s: the mean of g over the last quarter of %s is %.4g, not 1: %s%s", file,
        view->name, votca ? "file" : "g_column", p->file, tail->mean,
        tail->grows ? "it increases from row to row, as a number of neighbours does"
        : away > 1  ? "counts of pairs, or another column than g?"
        : tail->mean < far_from_1 && scene_has_molecules(&view->scene->molecules)
            ? "a potential, another column than g, or g of a single molecule, which ends with it? "
              "Its bonds, angles and dihedrals are found without \"rdf\""
        : tail->mean < far_from_1
            ? "a potential, or another column than g?"
            : "not normalised by the density of the whole system, or another column than g?",
        demixing);
}

/// Upper edge of the bins where g stays below `level` from the first on [λ].
static double edge_below(const struct view *view, double level) {
    size_t k = 0;
    while (k < view->bins->count && view->g[k] <= level)
        k++;
    return mf_rdf_bins_edge(view->bins, k);
}

static enum status check_packing(const struct view *view, const char *file) {
    const struct box *box = &view->scene->setup.box;
    const double closest = box->dimensions == 2 ? 2 / sqrt(3) : sqrt(2);
    const double intermolecular = view->g[0] <= empty ? edge_below(view, empty) : 0;
    const double filled =
        (double)view->like / mf_box_volume(box) * pow(intermolecular, (double)box->dimensions);
    const struct units *units = &view->scene->units;
    char density[80], unit[UNITS_NAME_SIZE];
    if (filled <= closest)
        return STATUS_OK;
    print_density(view, density, sizeof density);
    return mf_status_fail(
        STATUS_BAD_INPUT,
        "%s: target.%s: it has no pairs nearer than %.3g %s, and the scene a "
        "density of %s: rho d^%d = %.3g, while the closest packing has %.3g; is the "
        "unit of length, scene.box or the number of particles wrong?",
        file, view->name, intermolecular * mf_units_factor(units, "lambda"),
        mf_units_name(units, "lambda", unit), density, box->dimensions, filled, closest);
}

/// Bins from one range of an integral to the next shorter one: some fifty ranges are enough.
static size_t step_of_ranges(const struct view *view) {
    return 1 + view->bins->count / 100;
}

/// The largest 1 + ρG that `factor` g allows, by three standard errors and by any range from half
/// of what is known on; NaN where it is not known.
static enum status largest_compressibility(const struct view *view, double factor,
                                           double *largest) {
    OWNED double *g = NULL;
    *largest = NAN;
    if (view->scene->setup.box.dimensions != 3 || view->like < 2)
        return STATUS_OK;
    TRY_ARRAY(g, view->bins->count);
    for (size_t k = 0; k < view->bins->count; k++)
        g[k] = factor * view->g[k];
    for (struct rdf_bins part = *view->bins; 2 * part.count >= view->bins->count;
         part.count -= step_of_ranges(view)) {
        const struct kirkwood_buff kb = mf_kirkwood_buff_integrate(
            &part, g, view->error, &view->scene->setup.box, view->like, 0);
        *largest = fmax(*largest, kb.compressibility + standard_errors * kb.compressibility_error);
    }
    return STATUS_OK;
}

/// "1 + rho G = -8.42(12)": the error is by noise or, where that is more, by the range, half of how
/// far the values up to three quarters of it and more are apart. Of a range beyond the box it is
/// that of the longest within.
static void print_compressibility(const struct view *view, char *text, size_t size) {
    struct rdf_bins part = *view->bins;
    struct kirkwood_buff whole = {.compressibility = NAN};
    double min = INFINITY, largest = -INFINITY;
    for (; 4 * part.count >= 3 * view->bins->count; part.count -= step_of_ranges(view)) {
        const struct kirkwood_buff kb = mf_kirkwood_buff_integrate(
            &part, view->g, view->error, &view->scene->setup.box, view->like, view->inside);
        if (isnan(whole.compressibility))
            whole = kb;
        min = fmin(min, kb.compressibility);
        largest = fmax(largest, kb.compressibility);
    }
    const double ideal = 1 + view->bound;
    const double error = fmax(whole.compressibility_error, 0.5 * (largest - min)) / ideal;
    snprintf(text, size, "1 + rho G%s = %.2f(%.0f)", view->bound > 0 ? " of the molecules" : "",
             whole.compressibility / ideal, ceil(1e2 * error));
}

static enum status check_compressibility(const struct view *view, const char *file) {
    double largest;
    char density[80], value[80], demixing[256];
    TRY(largest_compressibility(view, normalisation, &largest));
    if (!(largest < 0))
        return STATUS_OK;
    print_density(view, density, sizeof density);
    print_compressibility(view, value, sizeof value);
    print_demixing(view, demixing, sizeof demixing);
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: target.%s: at the density of the scene, %s, its integral gives a "
                          "negative compressibility, %s: the density (scene.box, the number of "
                          "particles, the unit of length) or the normalisation of g is wrong%s",
                          file, view->name, density, value, demixing);
}

/// As of a wrong column, or of pairs that a program did not count.
static enum status check_nonzero(const struct view *view, const char *file) {
    for (size_t k = 0; k < view->bins->count; k++)
        if (view->g[k] > 0)
            return STATUS_OK;
    return mf_status_fail(
        STATUS_BAD_INPUT, "%s: target.%s.file: %s: g is 0 in all rows: is it in column %lld?", file,
        view->name, view->target->parameters.file, (long long)view->target->parameters.g_column);
}

/// g(r) of all pairs, then of different molecules.
enum { MAX_VIEWS = 2 * COMPOSITION_MAX_PAIRS };

/// False where there is none: of a target that is not given, and of a single bead.
static bool find_view(const struct target_files *files, const struct scene *scene, size_t n,
                      struct view *view) {
    const int kind = n < COMPOSITION_MAX_PAIRS ? TARGET_RDF : mf_rdf_intermolecular_kind();
    const struct target_pairs *all = files->own[kind];
    const size_t pair = n % COMPOSITION_MAX_PAIRS;
    if (pair >= all->pairs || !all->has_g[pair])
        return false;
    *view = view_of(all, kind, scene, pair);
    return true;
}

enum status mf_target_sanity_check(const struct target_files *files, const struct scene *scene,
                                   const char *file) {
    struct view view;
    for (size_t n = 0; n < MAX_VIEWS; n++) {
        if (!find_view(files, scene, n, &view))
            continue;
        TRY(check_nonzero(&view, file));
        TRY(check_tail(&view, file));
        if (scene_has_molecules(&scene->molecules))
            continue; // beads of a molecule are no particles of a fluid
        TRY(check_packing(&view, file));
        TRY(check_compressibility(&view, file));
    }
    return STATUS_OK;
}

static size_t highest_bin(const struct view *view) {
    size_t highest = 0;
    for (size_t k = 0; k < view->bins->count; k++)
        if (view->g[k] > view->g[highest])
            highest = k;
    return highest;
}

/// "target rdf: g from 0.005 to 0.995 nm, peak 2.79 at 0.275 nm, tail 0.998(6); density …".
static void report_view(const struct view *view, const struct target_sanity_listener *listener) {
    const struct rdf_bins *bins = view->bins;
    const struct target_tail *tail = &view->target->tail;
    const size_t peak = highest_bin(view);
    double length;
    const char *unit = unit_of(view, &length);
    char density[80], compressibility[80] = "";
    print_density(view, density, sizeof density);
    if (view->like > 1 && view->scene->setup.box.dimensions == 3)
        print_compressibility(view, compressibility, sizeof compressibility);
    mf_target_sanity_warn(
        listener,
        "target %s: g from %.4g to %.4g %s, peak %.3g at %.4g %s, tail %.3f(%.0f); density %s%s%s",
        view->name, mf_rdf_bins_centre(bins, 0) * length,
        mf_rdf_bins_centre(bins, bins->count - 1) * length, unit, view->g[peak],
        mf_rdf_bins_centre(bins, peak) * length, unit, tail->mean, ceil(1e3 * tail->scatter),
        density, compressibility[0] ? ", " : "", compressibility);
}

static void report_origin(const struct view *view, const struct target_sanity_listener *listener) {
    const struct target_rdf *target = view->target;
    double length;
    const char *unit = unit_of(view, &length);
    if (view->ends > mf_rdf_bins_edge(view->bins, view->bins->count) * (1 + 1e-9))
        mf_target_sanity_warn(listener,
                              "target %s: it extends to %.4g %s and is cut at %.4g %s, the end of "
                              "the shortest: all g(r) of a mixture need the same range",
                              view->name, view->ends * length, unit,
                              mf_rdf_bins_edge(view->bins, view->bins->count) * length, unit);
    mf_target_sanity_report_reading(target, view->name, view->scene, listener);
    if (target->joined > 1)
        mf_target_sanity_warn(listener, "target %s: %zu rows of the file make a bin of %.4g %s",
                              view->name, target->joined, view->bins->width * length, unit);
    if (target->assumed)
        mf_target_sanity_warn(
            listener,
            "target %s: no errors given, and no scatter to estimate them: %.2g at "
            "g = 1 in the last bin is assumed",
            view->name, target->estimated_error);
    else if (target->estimated_error > 0)
        mf_target_sanity_warn(
            listener,
            "target %s: no errors given: %.2g at g = 1 in the last bin, from the scatter of the "
            "rows",
            view->name, target->estimated_error);
}

/// Neighbours of a bead, of any type, up to the second maximum of g, if there are layers; else +∞.
static double neighbours_in_layers(const struct view *view) {
    const struct rdf_bins *bins = view->bins;
    size_t k = highest_bin(view), lowest, second;
    while (k < bins->count && view->g[k] >= 1)
        k++;
    for (lowest = k; k < bins->count && view->g[k] < 1; k++)
        if (view->g[k] < view->g[lowest])
            lowest = k;
    if (k == bins->count || view->g[lowest] + standard_errors * view->error[lowest] > deep)
        return INFINITY;
    for (second = k; k < bins->count && view->g[k] >= 1; k++)
        if (view->g[k] > view->g[second])
            second = k;
    double sum = 0;
    for (size_t n = 0; n <= second; n++)
        sum += view->density * view->g[n] *
               mf_box_shell_volume(&view->scene->setup.box, mf_rdf_bins_edge(bins, n),
                                   mf_rdf_bins_edge(bins, n + 1));
    return sum;
}

static enum status warn_of_normalisation(const struct view *view,
                                         const struct target_sanity_listener *listener) {
    double largest;
    char value[80];
    TRY(largest_compressibility(view, 1, &largest));
    if (!(largest < 0))
        return STATUS_OK;
    print_compressibility(view, value, sizeof value);
    mf_target_sanity_warn(
        listener,
        "mesofit: warning: target.%s: its integral gives a negative compressibility, %s; a "
        "normalisation or density that is off by up to 3 %% would explain it",
        view->name, value);
    return STATUS_OK;
}

static void warn_of_state(const struct view *view, const struct target_sanity_listener *listener) {
    const struct target_state state = {.bins = view->bins,
                                       .g = view->g,
                                       .error = view->error,
                                       .box = &view->scene->setup.box,
                                       .count = view->like,
                                       .bound = view->bound,
                                       .inside = view->inside,
                                       .tail = view->target->tail.mean};
    char line[TARGET_STATE_LINE];
    if (mf_target_state_print(&state, line) ||
        mf_target_state_print_whole(&state, &view->target->whole, line))
        mf_target_sanity_warn(listener, "mesofit: warning: target.%s: %s", view->name, line);
}

static void warn_of_density(const struct view *view,
                            const struct target_sanity_listener *listener) {
    const double neighbours = neighbours_in_layers(view);
    const double core = view->g[0] <= 0.5 ? edge_below(view, 0.5) : INFINITY;
    const double filled = view->density * pow(core, view->scene->setup.box.dimensions);
    const struct units *units = &view->scene->units;
    char density[80], unit[UNITS_NAME_SIZE];
    print_density(view, density, sizeof density);
    if (neighbours < few_neighbours)
        mf_target_sanity_warn(
            listener,
            "mesofit: warning: target.%s: it has the layers of a liquid, but at the density of the "
            "scene, %s, a bead has only %.2g neighbours up to the second one: is the unit of "
            "length, scene.box or the number of particles wrong? (solutes in an implicit solvent "
            "look so, too)",
            view->name, density, neighbours);
    else if (filled < dilute)
        mf_target_sanity_warn(
            listener,
            "mesofit: warning: target.%s: a dilute gas: the density of the scene is %s, and the "
            "beads are %.3g %s wide",
            view->name, density, core * mf_units_factor(units, "lambda"),
            mf_units_name(units, "lambda", unit));
}

enum status mf_target_sanity_report(const struct target_files *files, const struct scene *scene,
                                    const struct target_sanity_listener *listener) {
    struct view view;
    for (size_t n = 0; n < MAX_VIEWS; n++) {
        if (!find_view(files, scene, n, &view))
            continue;
        report_view(&view, listener);
        report_origin(&view, listener);
        TRY(mf_target_sanity_report_errors(view.target, view.name, listener));
        warn_of_state(&view, listener);
        if (scene_has_molecules(&scene->molecules))
            continue;
        TRY(warn_of_normalisation(&view, listener));
        warn_of_density(&view, listener);
        mf_target_sanity_report_end(view.target, view.name, &files->normalisation, scene, listener);
    }
    mf_target_sanity_report_groups(files, scene, listener);
    mf_target_sanity_report_pressure(files, scene, listener);
    mf_target_sanity_report_normalisation(&files->normalisation, listener);
    mf_target_sanity_report_scales(files, scene, listener);
    mf_target_sanity_report_measured(files, scene, listener);
    return STATUS_OK;
}
