// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/measure_output.h"

#include "base/memory.h"
#include "base/number_text.h"
#include "io/units.h"
#include "work/measure_doubts.h"

#include <math.h>
#include <unistd.h>

/// What makes numbers in nm and ps those of the results, with the name of their unit.
static double find_unit(const struct measure_result *result, const char *unit,
                        char name[UNITS_NAME_SIZE]) {
    mf_units_name(&result->units, unit, name);
    return mf_units_factor(&result->units, unit);
}

/// How far beads go, and what is to be known of it: a periodic box slows D.
static void print_diffusion(struct progress *progress, const struct measure_result *result) {
    const struct measured_motion *const motion = &result->measured->motion;
    const struct motion_summary s = mf_motion_result(&motion->motion, NULL);
    char diffusion[UNITS_MEASURED_SIZE], unit[UNITS_NAME_SIZE], of_time[UNITS_NAME_SIZE];
    char early[MOTION_EARLY_SIZE];
    const double time = find_unit(result, "tau", of_time);
    mf_progress_print(
        progress,
        "D = %s by the MSD from %.4g to %.4g %s, for this box: a larger "
        "one has a larger D, by 2.84 k_B T/(6 pi eta L) of a cube",
        mf_units_measured(&result->units, "lambda^2/tau", s.msd, s.msd_error, diffusion),
        time * s.fit_begin, time * s.fit_end, of_time);
    if (mf_motion_is_early(&s))
        mf_progress_print(
            progress, "mesofit: warning: %s; a longer trajectory, or --window, has a D%s",
            mf_motion_early_text(&s, early), result->kinds ? ", that of the molecules" : "");
    const struct measured_path *const path = &motion->path;
    if (path->far > 0)
        mf_progress_print(
            progress,
            "mesofit: warning: from frame to frame %.2g %% of the steps along the "
            "box come near half of it, and the file does not tell which image beads "
            "are in: MSD, D, escape times and VACF of differences are wrong; take "
            "frames closer together, write images (xu yu zu or ix iy iz in LAMMPS, "
            "particles/image in GSD and H5MD), or keep the order of atoms (id in LAMMPS)",
            100 * (double)path->far / (double)path->steps);
    if (motion->path.differences)
        mf_progress_print(progress,
                          "mesofit: warning: the VACF is of differences of positions over %.4g %s: "
                          "it is lower at short times, its integral is right",
                          2 * time * motion->interval, of_time);
    else if (motion->has_vacf && mf_motion_is_coarse(&s))
        mf_progress_print(
            progress,
            "mesofit: warning: frames are too far apart for D by the VACF, %.3g%s: velocities lose "
            "%.0f %% of their correlation from one to the next",
            mf_units_factor(&result->units, "lambda^2/tau") * s.green_kubo,
            mf_units_suffix(&result->units, "lambda^2/tau", unit), 100 * fmin(1, s.vacf_drop));
}

/// A file of the same name beside it, as `simulate` and other programs write it: into `found`.
static bool find_beside(const char *file, char found[OUTPUT_PATH_SIZE]) {
    static const char *const endings[] = {"gro", "pdb", "psf", "lammpstrj", "gsd", NULL};
    const char *const name = strrchr(file, '/'), *const dot = strrchr(name ? name : file, '.');
    for (int k = 0; dot && endings[k]; k++) {
        snprintf(found, OUTPUT_PATH_SIZE, "%.*s.%s", (int)fmin(dot - file, OUTPUT_PATH_SIZE - 16),
                 file, endings[k]);
        if (strcmp(found, file) != 0 && access(found, R_OK) == 0)
            return true;
    }
    return false;
}

void mf_measure_print_nameless(struct progress *progress, const char *file) {
    char beside[OUTPUT_PATH_SIZE];
    const bool found = find_beside(file, beside);
    mf_progress_print(
        progress,
        "%s tells where atoms are and not what: all are taken for one type; give their "
        "types and masses by -s %s",
        file, found ? beside : "FILE, a .gro, .pdb, .top, .psf or data file of LAMMPS");
}

/// Of how far apart pairs, and for how long.
static void print_escapes(struct progress *progress, const struct measure_result *result) {
    const struct measured_motion *const motion = &result->measured->motion;
    const struct etd_grid *const grid = &motion->etd.grid;
    char of_length[UNITS_NAME_SIZE], of_time[UNITS_NAME_SIZE];
    const double length = find_unit(result, "lambda", of_length);
    const double time = find_unit(result, "tau", of_time);
    const double from = length * grid->r_minimum, to = length * grid->r_maximum;
    if (mf_etd_complete(&motion->etd) == 0)
        return;
    if (mf_etd_pairs(&motion->etd) == 0)
        mf_progress_print(progress,
                          "mesofit: warning: no escape times: no pair was between %.4g and %.4g %s",
                          from, to, of_length);
    else
        mf_progress_print(
            progress, "escape times of pairs from %.4g to %.4g %s, in windows of %.4g %s", from, to,
            of_length, time * (double)(grid->times - 1) * motion->interval, of_time);
}

static void print_motion(struct progress *progress, const struct measure_result *result) {
    const struct measured_motion *const motion = &result->measured->motion;
    if (!motion->begun && !motion->plan.leave_out)
        mf_progress_print(progress, "mesofit: warning: no motion, no escape times: %s",
                          result->measured->frames < 2 ? "there is one frame"
                                                       : "frames have no times (--file-time-step)");
    if (!motion->begun)
        return;
    if (result->frames->unsorted)
        mf_progress_print(progress,
                          "mesofit: warning: no ids tell atoms apart: MSD, D, escape times and "
                          "VACF take each row for one atom, as is right where rows are sorted "
                          "(\"dump_modify sort id\"); else dump the column id, too");
    if (mf_motion_blocks(&motion->motion) == 0)
        mf_progress_print(progress,
                          "mesofit: warning: no motion, no escape times: %zu frames are no window "
                          "of %lld intervals (--window)",
                          motion->frames, (long long)motion->motion.plan.lags);
    else
        print_diffusion(progress, result);
    print_escapes(progress, result);
    if (!motion->has_vacf && motion->plan.velocities == MEASURED_VELOCITIES_USUAL)
        mf_progress_print(progress, "no VACF: there are no velocities (--velocities "
                                    "differences makes them of positions)");
}

/// The first atom of each bead of the first molecule of a kind, counted from 1.
static bool list_atoms(const struct measure_result *result, const struct topology_kind *kind,
                       char *text, size_t size) {
    const struct mapping *const mapping = result->mapping;
    bool sorted = true;
    size_t length = 0, last = 0;
    for (int n = 0; n < kind->beads && length < size; n++) {
        const size_t bead = result->measured->molecules.bead[topology_id(kind, 0, n)];
        const size_t atom = mapping->atom[mapping->bead[bead].first] + 1;
        length += (size_t)snprintf(text + length, size - length, n ? ", %zu" : "%zu", atom);
        sorted = sorted && atom > last;
        last = atom;
    }
    return sorted;
}

/// Types in another order than that of the trajectory may be meant, or a slip: bonds show it.
static void print_order(struct progress *progress, const struct measure_result *result) {
    const struct topology *const topology = &result->kinds->molecules.topology;
    char text[256];
    for (int k = 0; result->request->map && k < topology->kinds; k++)
        if (!list_atoms(result, &topology->kind[k], text, sizeof text))
            mf_progress_print(
                progress,
                "%s: its beads are not in the order of the atoms: they begin with the "
                "atoms %s",
                topology->kind[k].name, text);
}

static void print_molecules(struct progress *progress, const struct measure_result *result) {
    const struct observable_results results = {.units = &result->units};
    const struct observable_use *use = result->measured->use;
    char line[256];
    if (result->kinds)
        print_order(progress, result);
    for (; use->observable; use++) {
        if (use->observable->print == NULL)
            continue;
        use->observable->print(use->state, &results, line, sizeof line);
        mf_progress_print(progress, "%s", line);
    }
}

/// Bonds of beads in another order than that of the trajectory join any two, which are half a box
/// apart, in all groups.
static bool joins_any_beads(const struct molecules *molecules, const struct bonded_moments *found,
                            double edge) {
    static const double farthest = 0.4;
    bool any = molecules->groups[BONDED_BOND] > 0;
    for (int g = 0; g < molecules->groups[BONDED_BOND]; g++)
        any = any && found[g].mean > farthest * edge;
    return any;
}

/// Bonds that are hardly any, and those of two lengths.
static enum status print_doubtful_bonds(struct progress *progress,
                                        const struct measure_result *result) {
    static const char question[] = "are the beads of --molecules in the order of the trajectory?";
    const struct measured *const measured = result->measured;
    const struct molecules *const molecules = measured->molecules.molecules;
    static const double many = 0.04; // springs of no length have 0.017
    enum { MANY_BONDS = 20 };        // whose mean in a frame is that of all
    struct bonded_moments found[MOLECULES_MAX_GROUPS];
    char unit[UNITS_NAME_SIZE];
    if (molecules == NULL || measured->in_vacuum)
        return STATUS_OK;
    const double factor = find_unit(result, "lambda", unit);
    const double edge = cbrt(mf_measured_mean(&measured->volume, NULL));
    for (int g = 0; g < molecules->groups[BONDED_BOND]; g++) {
        struct measured_lengths lengths;
        const char *const name = molecules->group[BONDED_BOND][g].name;
        TRY(mf_measured_moments(measured, BONDED_BOND, g, &found[g]));
        TRY(mf_measured_lengths(measured, g, &lengths));
        if (lengths.beyond > many && lengths.bonds >= MANY_BONDS)
            mf_progress_print(progress,
                              "mesofit: warning: %.0f %% of the bonds \"%s\" are longer than %.3g "
                              "%s, twice the longest mean: %s",
                              100 * lengths.beyond, name, factor * lengths.end, unit, question);
        else if (isfinite(lengths.part[0]))
            mf_progress_print(progress,
                              "mesofit: warning: bonds \"%s\" are either some %.3g or some %.3g %s "
                              "long: %s",
                              name, factor * lengths.part[0], factor * lengths.part[1], unit,
                              question);
    }
    if (joins_any_beads(molecules, found, edge))
        mf_progress_print(progress,
                          "mesofit: warning: bonds \"%s\" are %.3g %s long, as far as any two "
                          "beads of a box of %.3g %s are apart: %s",
                          molecules->group[BONDED_BOND][0].name, factor * found[0].mean, unit,
                          factor * edge, unit, question);
    return STATUS_OK;
}

/// Bonds and angles that a fit takes a law for.
static enum status print_constraints(struct progress *progress,
                                     const struct measure_result *result) {
    const struct molecules *const molecules = result->measured->molecules.molecules;
    for (int order = 0; molecules && order < BONDED_KINDS; order++)
        for (int g = 0; g < molecules->groups[order]; g++) {
            struct bonded_moments found;
            TRY(mf_measured_moments(result->measured, order, g, &found));
            if (!mf_bonded_distribution_is_constrained(order, &found))
                continue;
            char unit[UNITS_NAME_SIZE];
            const double factor =
                find_unit(result, mf_bonded_kinds[order]->is_length ? "lambda" : "degrees", unit);
            mf_progress_print(
                progress,
                "%s \"%s\": a constraint (standard deviation %.2g, mean %.4g %s): a fit replaces "
                "it by a harmonic potential with a standard deviation of %.2g %s",
                mf_bonded_kinds[order]->name, molecules->group[order][g].name,
                factor * found.deviation, factor * found.mean, unit,
                factor * mf_bonded_distribution_narrow(order, found.mean), unit);
        }
    return STATUS_OK;
}

static void print_pairs(struct progress *progress, const struct measure_result *result) {
    const struct measured *const measured = result->measured;
    char unit[UNITS_NAME_SIZE];
    const double length = find_unit(result, "lambda", unit);
    mf_progress_print(progress, "g(r) to %.4g %s in %lld bins%s", length * measured->plan.range,
                      unit, (long long)measured->plan.bins,
                      measured->pairs.within     ? ", without pairs that molecules exclude"
                      : measured->pairs.molecule ? ", without pairs of one molecule or residue"
                                                 : "");
    if (mf_rdf_observable.assess(mf_measured_state(measured, &mf_rdf_observable), NULL) !=
        STATUS_OK)
        mf_progress_print(progress, "mesofit: warning: %s", mf_status_message());
    const double wave_number = find_unit(result, "1/lambda", unit);
    if (measured->plan.waves.q_maximum > 0)
        mf_progress_print(progress, "S(q) to %.4g %s, of at most %lld waves in a bin",
                          wave_number * measured->plan.waves.q_maximum, unit,
                          (long long)measured->plan.waves.waves);
}

/// What is kept of forces: memory for all blocks, however many frames there are.
static void print_forces(struct progress *progress, const struct measure_result *result) {
    const struct force_equations *const equations = &result->measured->forces.equations;
    const size_t numbers = force_equations_entries(equations) + 2 * equations->size;
    if (equations->size > 0)
        mf_progress_print(progress,
                          "forces: %zu unknowns of %zu curve%s, in %zu blocks of %zu frames; their "
                          "equations take %.2g MB, however many the frames",
                          equations->size, equations->curves, equations->curves > 1 ? "s" : "",
                          force_equations_blocks(equations), equations->each,
                          1e-6 * (double)(FORCES_BLOCKS * numbers * sizeof(double)));
}

/// Why velocities do not tell the temperature.
static const char *without_temperature(const struct measure_result *result) {
    const struct measured_motion *const motion = &result->measured->motion;
    if (result->measured->in_vacuum)
        return "there is no box";
    if (!motion->has_velocities)
        return "there are no velocities";
    if (result->mapping->broken)
        return "velocities of parts of molecules do not tell it where bonds of fixed length hold "
               "them";
    return motion->mass == NULL            ? "masses are not known"
           : motion->temperature.count > 0 ? "the velocities of one frame do not tell it within 3 %"
                                           : "one bead does not tell it";
}

/// A temperature that is given, and that of the velocities: they are those of whole beads, so that
/// constraints within beads do no harm, but those between beads make it too low, and of parts of
/// molecules any.
static void print_temperature(struct progress *progress, const struct measure_result *result) {
    static const double tolerance = 0.03, errors = 4, held = 0.1;
    const struct measured_motion *const motion = &result->measured->motion;
    const struct sample_series *const kinetic = &motion->temperature;
    double error;
    const double given = result->request->temperature, mean = mf_measured_mean(kinetic, &error);
    // Few frames may agree by chance: no less than by equipartition.
    const double least = mean * mf_measure_output_temperature_scatter(result);
    const bool off = kinetic->count > 0 && fabs(given - mean) > tolerance * given &&
                     !(fabs(given - mean) <= errors * fmax(error, least));
    char text[NUMBER_TEXT_SIZE];
    mf_number_text(mean, isnan(error) ? least : error, text);
    if (isnan(mf_measure_output_temperature(result)))
        mf_progress_print(
            progress,
            "unknown temperature (%s): give it by --temperature, or in \"scene\" of target.json",
            without_temperature(result));
    else if (isnan(given))
        mf_progress_print(progress,
                          "T = %s K by the velocities of the beads; one that is known is given by "
                          "--temperature",
                          text);
    else if (!motion->is_thermal && off && (mean > given || mean < held * given))
        mf_progress_print(
            progress,
            "mesofit: warning: --temperature %g, but the velocities of the beads have %s K, which "
            "bonds of fixed length can only make less: is it in kelvin, and are the file's units "
            "right?",
            given, text);
    else if (motion->is_thermal && off)
        mf_progress_print(
            progress,
            "mesofit: warning: --temperature %g, but the velocities of the beads have "
            "%s K: another temperature, other units, or constraints between beads, "
            "each of which takes a degree of freedom of 3 a bead; give that of the simulation",
            given, text);
}

/// What cools or heats up all along has no temperature.
static void print_heating(struct progress *progress, const struct measure_result *result) {
    const struct sample_series *const kinetic = &result->measured->motion.temperature;
    const struct equilibration_drift drift =
        mf_equilibration_drift(kinetic->values, kinetic->count);
    if (equilibration_drifts(&drift, 1))
        mf_progress_print(
            progress,
            "mesofit: warning: the velocities have %.4g +- %.1g K in the first %.0f %% of the "
            "frames, %.4g +- %.1g K in the rest: use frames from where nothing changes any more "
            "(--begin), or simulate for longer",
            drift.before, drift.before_error, 100 * drift.part, drift.after, drift.after_error);
}

/// Units are wrong more often than matter is so hot or cold.
static void print_speeds(struct progress *progress, const struct measure_result *result) {
    static const double hottest = 5000, coldest = 10;
    const char *const units = result->request->frames.options.units;
    const struct sample_series *const kinetic = &result->measured->motion.temperature;
    const double kelvin = mf_measured_mean(kinetic, NULL);
    if (kinetic->count == 0 || (kelvin >= coldest && kelvin <= hottest))
        return;
    if (units)
        mf_progress_print(progress,
                          "mesofit: warning: --file-units %s make velocities of %.3g K: is the "
                          "file in other units?",
                          units, kelvin);
    else
        mf_progress_print(progress,
                          "mesofit: warning: velocities and masses make %.4g K: are they, or "
                          "places, in other units?",
                          kelvin);
}

/// Why motion is no target of the fit, where masses are the reason.
static void print_masses(struct progress *progress, const struct measure_result *result) {
    const struct measured *const measured = result->measured;
    bool known = true;
    if (!measured->motion.begun || !mf_measure_output_masses_may_differ(result))
        return;
    for (int type = 0; type < measured->pairs.composition.types; type++)
        known = known && !isnan(mf_measure_output_mass(result, type));
    mf_progress_print(progress,
                      "masses of beads %s: target.json has motion compared with and not fitted, "
                      "since friction is for one mass",
                      known ? "differ" : "are not known, -s gives them");
}

/// What a person is to know.
static void print_all(struct progress *progress, const struct measure_result *result) {
    const struct measured *const measured = result->measured;
    if (mf_measure_output_is_alone(result))
        mf_progress_print(progress,
                          measured->in_vacuum
                              ? "there is no box: molecules alone are measured, no g(r), no motion"
                              : "a single molecule: its g(r) is intramolecular and no target; "
                                "bonds, angles and dihedrals are");
    if (!measured->in_vacuum)
        print_pairs(progress, result);
    print_forces(progress, result);
    if (measured->pairs.molecule && result->kinds == NULL)
        mf_progress_print(
            progress,
            "mesofit: warning: molecules have several beads: without --molecules a fit has no "
            "bonds; g(r) is of different molecules alone, no target of a fit that has them");
    print_molecules(progress, result);
    if (!measured->in_vacuum)
        print_motion(progress, result);
    print_masses(progress, result);
    print_speeds(progress, result);
    print_temperature(progress, result);
    print_heating(progress, result);
}

enum status mf_measure_print(struct progress *progress, const struct measure_result *result) {
    print_all(progress, result);
    TRY(mf_measure_doubt_results(progress, result));
    TRY(print_doubtful_bonds(progress, result));
    return print_constraints(progress, result);
}

/// What a fit of target.json finds.
static void describe_fit(const struct measure_result *result, char *text, size_t size) {
    const bool alone = mf_measure_output_is_alone(result);
    const bool moves = mf_measure_tables_have_motion(result) && result->kinds == NULL &&
                       !mf_measure_output_masses_may_differ(result);
    snprintf(text, size, "%s%s%s", alone ? "" : "the potential of pairs",
             result->kinds == NULL ? ""
             : alone               ? "the potentials of the molecules"
                                   : " and those of the molecules",
             moves ? ", then omega, the friction (measured with --static: no omega)" : "");
}

void mf_measure_print_next(struct progress *progress, const struct measure_result *result) {
    const bool in_parts = result->measured->pairs.molecule && result->kinds == NULL;
    char finds[160];
    if (in_parts || (mf_measure_output_is_alone(result) && result->kinds == NULL))
        return; // no target of a fit, or none that is whole
    describe_fit(result, finds, sizeof finds);
    const bool lacks = isnan(mf_measure_output_temperature(result));
    mf_progress_print(progress, "next: mesofit fit --target %s%s finds %s", result->folder,
                      lacks ? " --temperature T" : "", finds);
}
