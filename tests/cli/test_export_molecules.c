// SPDX-License-Identifier: GPL-3.0-or-later
//
// Molecules in another program: LAMMPS (Debian's lmp, for ENGINES=1) has the energies
// and forces of the configuration that was exported, law by law, and GROMACS those of its bonds.
#include "base/memory.h"
#include "export/export_bonded.h"
#include "export/export_units.h"
#include "shared/exported_molecules.h"
#include "shared/is_close.h"
#include "shared/lammps_runs.h"
#include "shared/other_engine.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// Chains of all laws that LAMMPS has, dimers that exclude the same pairs, and single beads.
static const char scene[] =
    "{\"seed\": 5, \"box\": [8, 8, 8], \"time_step\": 0.002, \"precision\": \"double\",\n"
    "\"units\": {\"length\": 0.5, \"temperature\": 300, \"mass\": 5e-26},\n"
    "\"bonds\": {\"spring\": {\"law\": \"harmonic\", \"k\": 120, \"length\": 0.7},\n"
    "  \"fene\": {\"law\": \"fene\", \"k\": 2, \"longest\": 3},\n"
    "  \"stiff\": {\"law\": \"harmonic\", \"k\": 300, \"length\": 0.9}},\n"
    "\"angles\": {\"bend\": {\"law\": \"harmonic\", \"k\": 8, \"angle\": 110},\n"
    "  \"straight\": {\"law\": \"cosine\", \"k\": 3},\n"
    "  \"squared\": {\"law\": \"cosine-squared\", \"k\": 30, \"angle\": 120}},\n"
    "\"dihedrals\": {\"butane\": {\"law\": \"ryckaert-bellemans\", \"c0\": 3.7, \"c1\": 4.9,\n"
    "    \"c2\": -5.3, \"c3\": -1.1, \"c4\": 1.3},\n"
    "  \"turn\": {\"law\": \"periodic\", \"k\": 1.7, \"multiplicity\": 3, \"phase\": 60}},\n"
    "\"molecules\": {\"chain\": {\"count\": 80, \"exclude\": 1,\n"
    "    \"beads\": [\"A\", \"B\", \"A\", \"B\", \"A\", \"A\"],\n"
    "    \"bonds\": {\"spring\": [[1, 2], [2, 3]], \"fene\": [[3, 4]], \"stiff\": [[4, 5], [5, "
    "6]]},\n"
    "    \"angles\": {\"bend\": [[1, 2, 3]], \"straight\": [[2, 3, 4]],\n"
    "      \"squared\": [[3, 4, 5], [4, 5, 6]]},\n"
    "    \"dihedrals\": {\"butane\": [[1, 2, 3, 4]], \"turn\": [[2, 3, 4, 5], [3, 4, 5, 6]]}},\n"
    "  \"dimer\": {\"count\": 30, \"exclude\": 3, \"chain\": {\"beads\": [\"B\", \"W\"],\n"
    "    \"bond\": \"stiff\"}}},\n"
    "\"particles\": {\"types\": {\"W\": 40}, \"mass\": {\"A\": 1, \"B\": 2, \"W\": 1.5}},\n"
    "\"conservative\": {\"law\": \"soft-repulsion\", \"a\": 1},\n"
    "\"snapshots\": {\"every\": 300, \"formats\": [\"json\"]},\n"
    "\"measure\": {\"equilibration\": 300, \"samples\": 2, \"every\": 10}}\n";

/// The same with tables in their place, and with laws of which LAMMPS has but tables.
static const struct exported_molecules_table tables[] = {
    {"{\"law\": \"harmonic\", \"k\": 120, \"length\": 0.7}",
     "{\"law\": \"table\", \"file\": \"bond.tsv\"}"},
    {"{\"law\": \"harmonic\", \"k\": 8, \"angle\": 110}",
     "{\"law\": \"table\", \"file\": \"angle.tsv\"}"},
    {"\"c4\": 1.3", "\"c4\": 1.3, \"c5\": 0.4"},
    {"\"phase\": 60", "\"phase\": 70.5"},
};
enum { TABLES = sizeof tables / sizeof *tables };

static void make_result(struct temporary_folder *folder, bool with_tables) {
    exported_molecules_simulate(folder, scene, tables, with_tables ? TABLES : 0);
}

// Ours --------------------------------------------------------------------------------------------

/// Energies of the pairs and of each order of terms, and forces by id, of the exported
/// configuration, as our engine has them.
struct ours {
    struct lammps_runs_ours of;
    double pairs, bonded[BONDED_KINDS];
};

static void find_ours(struct ours *ours) {
    lammps_runs_find_ours(&ours->of);
    ours->pairs = ours->of.simulation.sums.energy;
    for (int order = 0; order < BONDED_KINDS; order++) {
        ours->bonded[order] = lammps_runs_energy_of(&ours->of, order);
        ours->pairs -= ours->bonded[order];
    }
}

// Theirs ------------------------------------------------------------------------------------------

/// One configuration, order by order.
static void compare_orders(double per_term) {
    static struct ours ours;
    double energy[4];
    lammps_runs_once("evdwl ebond eangle edihed", energy, 4);
    find_ours(&ours);
    const struct export_units units =
        mf_export_units(EXPORT_REAL, &ours.of.model.scene.units, false);
    print_message("pairs %.9g %.9g", energy[0] / units.energy, ours.pairs);
    for (int order = 0; order < BONDED_KINDS; order++)
        print_message(", %ss %.9g %.9g", mf_bonded_kinds[order]->name,
                      energy[1 + order] / units.energy, ours.bonded[order]);
    print_message("\n");
    assert_true(fabs(energy[0] / units.energy - ours.pairs) < 1e-5 * (double)ours.of.model.count);
    for (int order = 0; order < BONDED_KINDS; order++)
        assert_true(fabs(energy[1 + order] / units.energy - ours.bonded[order]) <
                    per_term *
                        (double)mf_topology_terms(&ours.of.model.molecules->topology, order));
    lammps_runs_clear_ours(&ours.of);
}

static void compare(struct temporary_folder *folder, bool with_tables, double per_term,
                    double force_bound) {
    static struct run_program_result result;
    lammps_runs_skip_without(NULL);
    make_result(folder, with_tables);
    RUN_PROGRAM(&result, "export", "out", "--engine", "lammps", "-o", "lammps");
    run_program_assert_code(&result, 0);
    compare_orders(per_term);
    const struct lammps_runs_apart apart = lammps_runs_compare(100);
    assert_true(apart.energy < 3 * per_term && apart.force < force_bound * apart.largest_force);
    if (system("cd lammps && lmp -in in.mesofit -var steps 200 -var equilibration 100 >lmp.out "
               "2>&1") != 0)
        fail_msg("LAMMPS does not run what was exported: see lammps/lmp.out");
    char *said = temporary_folder_read("lammps/lmp.out");
    assert_null(strstr(said, "image flags"));
    free(said);
}

/// LAMMPS has these laws, so that only digits of the files are lost.
static void test_lammps_has_the_energies_and_forces_of_our_laws(void **state) {
    compare(*state, false, 1e-7, 5e-7);
}

/// Tables are right within 1e-4 k_B T a term, and forces within 1e-3 of the largest slope.
static void test_lammps_has_those_of_our_tables(void **state) {
    compare(*state, true, 1e-4, 5e-5);
}

// GROMACS -----------------------------------------------------------------------------------------

/// A field of md.log is of some order of terms, by its name; −1: of none.
static int order_of(const char *name) {
    static const struct {
        const char *name;
        int order;
    } known[] = {{"Bond", BONDED_BOND},
                 {"FENE Bonds", BONDED_BOND},
                 {"Tab. Bonds", BONDED_BOND},
                 {"Angle", BONDED_ANGLE},
                 {"G96Angle", BONDED_ANGLE},
                 {"Tab. Angles", BONDED_ANGLE},
                 {"Proper Dih.", BONDED_DIHEDRAL},
                 {"Ryckaert-Bell.", BONDED_DIHEDRAL},
                 {"Tab. Dih.", BONDED_DIHEDRAL}};
    while (*name == ' ')
        name++;
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (strncmp(name, known[k].name, strlen(known[k].name)) == 0 &&
            strspn(name + strlen(known[k].name), " \n") == strlen(name + strlen(known[k].name)))
            return known[k].order;
    return -1;
}

/// The next energies of md.log: lines of names and of numbers, fields of 15 letters.
static void read_log(FILE *stream, double energy[BONDED_KINDS]) {
    char names[256], values[256];
    for (int order = 0; order < BONDED_KINDS; order++)
        energy[order] = 0;
    do
        assert_non_null(fgets(names, sizeof names, stream));
    while (strstr(names, "Energies (kJ/mol)") == NULL);
    while (fgets(names, sizeof names, stream) && fgets(values, sizeof values, stream) &&
           strlen(names) > 1)
        for (size_t at = 0; at + 15 < strlen(names) && at + 15 < strlen(values) + 1; at += 15) {
            char name[16] = {0}, value[16] = {0};
            memcpy(name, names + at, 15);
            memcpy(value, values + at, 15);
            if (order_of(name) >= 0)
                energy[order_of(name)] += strtod(value, NULL);
        }
}

/// The commands that the folder's README begins with, with options of ours behind each.
static void find_commands(char commands[1024]) {
    char *readme = temporary_folder_read("gromacs/README");
    const char *grompp = strstr(readme, "    gmx grompp"), *mdrun = strstr(readme, "    gmx mdrun");
    assert_non_null(grompp);
    assert_true(mdrun == strchr(grompp, '\n') + 1);
    snprintf(commands, 1024,
             "cd gromacs && sed 's/ A 0.0 1.0$/ A 0.0 0.0/' topol.top >once.top && (%.*s -f "
             "once.mdp -p once.top -maxwarn 9 && %.*s -nt 1 -rerun frames.gro) >gmx.out 2>&1 && "
             "gmx dump -f traj.trr >forces.txt 2>/dev/null",
             (int)strcspn(grompp, "\n"), grompp, (int)strcspn(mdrun, "\n"), mdrun);
    free(readme);
}

/// The atoms as the files have them: molecules of each kind, then single beads.
static size_t *find_order(const struct lammps_runs_ours *ours) {
    const struct topology *topology = &ours->model.molecules->topology;
    size_t *id = calloc(ours->model.count, sizeof *id), atoms = 0;
    assert_non_null(id);
    for (int k = 0; k < topology->kinds; k++)
        for (int64_t m = 0; m < topology->kind[k].count; m++)
            for (int bead = 0; bead < topology->kind[k].beads; bead++)
                id[atoms++] = topology_id(&topology->kind[k], m, bead);
    for (size_t bead = 0; bead < ours->model.count; bead++)
        if (topology->molecule[bead] >= (uint64_t)topology->molecules)
            id[atoms++] = bead;
    assert_int_equal(atoms, ours->model.count);
    return id;
}

static void write_frame(const struct lammps_runs_ours *ours, const size_t *id, double length,
                        int frame, FILE *stream) {
    const struct particles *particles = &ours->simulation.particles;
    const double *box = particles->box.length;
    fprintf(stream, "frame t= %d\n%zu\n", frame, particles->count);
    for (size_t k = 0; k < particles->count; k++) {
        const uint32_t place = particles->place[id[k]];
        fprintf(stream, "%5d%-5s%5s%5zu%16.11f%16.11f%16.11f\n", 1, "M", "A", (k + 1) % 100000,
                particles->position[0][place] * length, particles->position[1][place] * length,
                particles->position[2][place] * length);
    }
    fprintf(stream, "%.9f %.9f %.9f\n", box[0] * length, box[1] * length, box[2] * length);
}

/// Root mean square of the difference of the forces of the next frame from ours, over that of
/// the forces.
static double read_forces(const struct lammps_runs_ours *ours, const size_t *id, double unit,
                          FILE *stream) {
    const struct particles *particles = &ours->simulation.particles;
    char line[256];
    double squares = 0, all = 0, f[3];
    for (size_t k = 0; k < particles->count; k++) {
        const uint32_t place = particles->place[id[k]];
        do
            assert_non_null(fgets(line, sizeof line, stream));
        while (sscanf(line, " f[ %*d]={ %lf, %lf, %lf}", &f[0], &f[1], &f[2]) != 3);
        for (int d = 0; d < 3; d++) {
            squares += pow(f[d] / unit - particles->force[d][place], 2);
            all += pow(particles->force[d][place], 2);
        }
    }
    return sqrt(squares / all);
}

static void write_frames(struct ours *ours, double length, int frames) {
    FILE *stream = fopen("gromacs/frames.gro", "w");
    find_ours(ours);
    size_t *id = find_order(&ours->of);
    assert_non_null(stream);
    for (int k = 0; k < frames; k++, lammps_runs_move(&ours->of, (uint32_t)k))
        write_frame(&ours->of, id, length, k, stream);
    fclose(stream);
    free(id);
    lammps_runs_clear_ours(&ours->of);
}

/// Energies of each order and forces of all frames. In single precision the force of a dihedral
/// with an angle that is nearly straight is rough, which few frames have.
static void compare_frames(struct ours *ours, const struct export_units *units, int frames,
                           double per_term) {
    FILE *log = fopen("gromacs/md.log", "r"), *forces = fopen("gromacs/forces.txt", "r");
    double away[BONDED_KINDS] = {0}, force = 0, energy[BONDED_KINDS];
    int rough = 0;
    find_ours(ours);
    size_t *id = find_order(&ours->of);
    assert_true(log && forces);
    for (int k = 0; k < frames; k++, lammps_runs_move(&ours->of, (uint32_t)k)) {
        read_log(log, energy);
        for (int order = 0; order < BONDED_KINDS; order++)
            away[order] = fmax(away[order], fabs(energy[order] / units->energy -
                                                 lammps_runs_energy_of(&ours->of, order)));
        const double off = read_forces(&ours->of, id, export_units_force(units), forces);
        force = fmax(force, off);
        rough += off > 5e-5;
    }
    print_message(
        "%d configurations: bonds %.2g, angles %.2g, dihedrals %.2g, forces %.2g of their "
        "rms apart at most, and more than 5e-5 in %d\n",
        frames, away[0], away[1], away[2], force, rough);
    for (int order = 0; order < BONDED_KINDS; order++)
        assert_true(away[order] < per_term * (double)mf_topology_terms(
                                                 &ours->of.model.molecules->topology, order));
    assert_true(force < 2e-3 && rough <= frames / 10);
    fclose(log);
    fclose(forces);
    free(id);
    lammps_runs_clear_ours(&ours->of);
}

/// Debian's GROMACS has no tables of pairs, whose energies are left out: the terms alone.
static void compare_gromacs(struct temporary_folder *folder, bool with_tables, double per_term) {
    enum { FRAMES = 100 };
    static struct run_program_result result;
    static struct ours ours;
    char commands[1024];
    other_engine_skip_without("gmx");
    make_result(folder, with_tables);
    small_inputs_change(folder, "scene.json", "\"a\": 1}", "\"a\": 1e-6}");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "out", "--force");
    RUN_PROGRAM(&result, "export", "out", "--engine", "gromacs", "-o", "gromacs");
    run_program_assert_code(&result, 0);
    small_inputs_write(folder, "gromacs/once.mdp",
                       "integrator = md\nnsteps = 0\nnstenergy = 1\nnstlog = 1\nnstfout = 1\n"
                       "rcoulomb = 0.9\nrvdw = 0.9\ncontinuation = yes\n",
                       NULL, NULL);
    find_commands(commands);
    find_ours(&ours);
    const struct export_units units =
        mf_export_units(EXPORT_NANOMETRES, &ours.of.model.scene.units, true);
    lammps_runs_clear_ours(&ours.of);
    write_frames(&ours, units.length, FRAMES);
    if (system(commands) != 0)
        fail_msg("GROMACS failed: %s", temporary_folder_read("gromacs/gmx.out"));
    compare_frames(&ours, &units, FRAMES, per_term);
}

/// In single precision, of coordinates with seven decimals.
static void test_gromacs_has_the_energies_of_our_laws(void **state) {
    compare_gromacs(*state, false, 1e-5);
}

static void test_gromacs_has_those_of_our_tables(void **state) {
    compare_gromacs(*state, true, 1e-4);
}

/// special_bonds is one for all molecules.
static void test_what_an_engine_has_not_is_refused(void **state) {
    static struct run_program_result result;
    make_result(*state, false);
    RUN_PROGRAM(&result, "export", "out", "--engine", "dl_poly", "-o", "dl_poly");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "DL_POLY is of single beads, and there are molecules");
    small_inputs_write(*state, "scene.json", scene, "\"count\": 80, \"exclude\": 1",
                       "\"count\": 80, \"exclude\": 0");
    RUN_PROGRAM(&result, "simulate", "scene.json", "-o", "other");
    run_program_assert_code(&result, 0);
    RUN_PROGRAM(&result, "export", "other", "--engine", "lammps", "-o", "lammps");
    run_program_assert_code(&result, 2);
    assert_contains(result.err, "different \"exclude\"");
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, small_inputs_enter, small_inputs_leave)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_lammps_has_the_energies_and_forces_of_our_laws),
        TEST(test_lammps_has_those_of_our_tables),
        TEST(test_gromacs_has_the_energies_of_our_laws),
        TEST(test_gromacs_has_those_of_our_tables),
        TEST(test_what_an_engine_has_not_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
