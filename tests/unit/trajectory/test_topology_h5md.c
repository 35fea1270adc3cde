// SPDX-License-Identifier: GPL-3.0-or-later
//
// H5MD with what GROMACS 2026 adds (its src/gromacs/fileio/h5md: blocks of molecules whose kinds
// have names by tables), and with bonds alone.
#include "shared/is_close.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"
#include "trajectory/trajectory.h"

#include <hdf5.h>
#include <stdio.h>

enum { ATOMS = 8 }; // water, water, a dimer of two residues

static char path[1024];
static hid_t file;
static struct trajectory trajectory;

static hid_t make_group(hid_t place, const char *name) {
    return H5Gcreate(place, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
}

static void put(hid_t place, const char *name, hid_t type, int rank, const hsize_t *size,
                const void *numbers) {
    const hid_t space = H5Screate_simple(rank, size, NULL);
    const hid_t dataset =
        H5Dcreate(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers) >= 0);
    H5Dclose(dataset);
    H5Sclose(space);
}

static void put_one(hid_t place, const char *name, hid_t type, hsize_t count, const void *numbers) {
    put(place, name, type, 1, &count, numbers);
}

/// Texts of fixed length, as a dataset or an attribute.
static void put_texts(hid_t place, const char *name, bool attribute, hsize_t count, size_t size,
                      const char *texts) {
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate_simple(1, &count, NULL);
    H5Tset_size(type, size);
    H5Tset_cset(type, H5T_CSET_UTF8);
    if (attribute) {
        const hid_t own = H5Acreate(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
        assert_true(H5Awrite(own, type, texts) >= 0);
        H5Aclose(own);
    } else
        put_one(place, name, type, count, texts);
    H5Sclose(space);
    H5Tclose(type);
}

static void put_variable(hid_t place, const char *name, hsize_t count, const char *const *texts) {
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate_simple(1, &count, NULL);
    H5Tset_size(type, H5T_VARIABLE);
    const hid_t own = H5Acreate(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Awrite(own, type, texts) >= 0);
    H5Aclose(own);
    H5Sclose(space);
    H5Tclose(type);
}

static void begin_file(void **state) {
    double position[ATOMS][3] = {{0}};
    snprintf(path, sizeof path, "%s/a.h5", ((struct temporary_folder *)*state)->path);
    file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t particles = make_group(file, "particles"), group = make_group(particles, "system");
    for (int k = 0; k < ATOMS; k++)
        position[k][0] = k;
    put(group, "position", H5T_NATIVE_DOUBLE, 2, (const hsize_t[]){ATOMS, 3}, position);
    H5Gclose(group);
    H5Gclose(particles);
}

static void write_topology(int waters, int last_name, bool variable) {
    const hid_t h5md = make_group(file, "h5md"), modules = make_group(h5md, "modules"),
                topology = make_group(modules, "gromacs_topology"),
                water = make_group(topology, "SOL"), dimer = make_group(topology, "Dimer");
    put_one(water, "mass", H5T_NATIVE_FLOAT, 3, (float[]){16, 1, 1.5F});
    put_one(water, "particle_name", H5T_NATIVE_INT32, 3, (int32_t[]){0, 1, 2});
    put_texts(water, "particle_name_table", false, 3, 4, "OW\0\0HW1\0HW2");
    put_one(water, "residue_id", H5T_NATIVE_INT32, 3, (int32_t[]){1, 1, 1});
    put_one(water, "residue_name", H5T_NATIVE_INT32, 3, (int32_t[]){0, 0, 0});
    put_texts(water, "residue_name_table", false, 1, 4, "SOL");
    put_one(dimer, "mass", H5T_NATIVE_FLOAT, 2, (float[]){15, 14});
    put_one(dimer, "particle_name", H5T_NATIVE_INT32, 2, (int32_t[]){0, last_name});
    put_texts(dimer, "particle_name_table", false, 1, 4, "CA\0");
    put_one(dimer, "residue_id", H5T_NATIVE_INT32, 2, (int32_t[]){4, 5});
    put_one(dimer, "residue_name", H5T_NATIVE_INT32, 2, (int32_t[]){1, 0});
    put_texts(dimer, "residue_name_table", false, 2, 4, "GLY\0ALA");
    if (variable)
        put_variable(topology, "molecule_block_names", 2, (const char *const[]){"SOL", "Dimer"});
    else
        put_texts(topology, "molecule_block_names", true, 2, 6, "SOL\0\0\0Dimer");
    const hid_t space = H5Screate_simple(1, (const hsize_t[]){2}, NULL);
    const hid_t counts = H5Acreate(topology, "molecule_block_counts", H5T_NATIVE_INT32, space,
                                   H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(counts, H5T_NATIVE_INT32, (int32_t[]){waters, 1});
    H5Aclose(counts);
    H5Sclose(space);
    H5Gclose(dimer);
    H5Gclose(water);
    H5Gclose(topology);
    H5Gclose(modules);
    H5Gclose(h5md);
}

static enum status try(void) {
    H5Fclose(file);
    return mf_trajectory_open(&trajectory, path, &(struct trajectory_options){.units = "nm-ps"});
}

static void test_h5md_has_the_topology_of_gromacs(void **state) {
    static const char *const names[] = {"OW", "HW1", "HW2", "OW", "HW1", "HW2", "CA", "CA"},
                             *const residues[] = {"SOL", "SOL", "SOL", "SOL",
                                                  "SOL", "SOL", "ALA", "GLY"};
    static const double mass[] = {16, 1, 1.5, 16, 1, 1.5, 15, 14};
    static const size_t residue[] = {0, 0, 0, 1, 1, 1, 2, 3};
    for (int variable = 0; variable < 2; variable++) {
        begin_file(state);
        write_topology(2, 0, variable);
        assert_ok(try());
        for (int k = 0; k < ATOMS; k++) {
            const struct structure_atom *const atom = &trajectory.structure.atom[k];
            assert_string_equal(atom->name, names[k]);
            assert_string_equal(atom->residue_name, residues[k]);
            assert_close(atom->mass, mass[k], 1e-6);
            assert_int_equal(atom->residue, residue[k]);
            assert_int_equal(atom->molecule, k < 6 ? k / 3 + 1 : 3);
        }
        mf_trajectory_close(&trajectory);
    }
}

static void test_h5md_says_so_when_its_topology_is_of_others(void **state) {
    begin_file(state);
    write_topology(3, 0, false);
    assert_ok(try());
    assert_contains(trajectory.note, "its topology is of another number of particles");
    assert_false(trajectory.structure.has_residues || trajectory.structure.has_masses);
    mf_trajectory_close(&trajectory);
    begin_file(state);
    write_topology(2, 1, false);
    assert_fails(try(), STATUS_BAD_INPUT, "\"particle_name\" is not of its table");
}

static void test_h5md_has_molecules_of_bonds(void **state) {
    for (int odd = 0; odd < 2; odd++) {
        const int64_t bonds[3][2] = {{0, 1}, {5, 1}, {6, odd ? ATOMS : 7}};
        begin_file(state);
        const hid_t connectivity = make_group(file, "connectivity");
        put(connectivity, "bonds", H5T_NATIVE_INT64, 2, (const hsize_t[]){3, 2}, bonds);
        H5Gclose(connectivity);
        if (odd) {
            assert_fails(try(), STATUS_BAD_INPUT, "bond 3 is of a particle 8, which is not there");
            continue;
        }
        assert_ok(try());
        assert_int_equal(trajectory.structure.residues, 5);
        assert_int_equal(trajectory.structure.atom[5].residue,
                         trajectory.structure.atom[0].residue);
        mf_trajectory_close(&trajectory);
    }
}

/// Where particles have ids, which are those of bonds: 1 and 2 are the last but one and the first.
static void test_h5md_has_bonds_of_ids(void **state) {
    static const int64_t ids[ATOMS] = {2, 3, 4, 5, 6, 7, 1, 8}, bonds[1][2] = {{1, 2}};
    begin_file(state);
    const hid_t group = H5Gopen(file, "particles/system", H5P_DEFAULT),
                connectivity = make_group(file, "connectivity");
    put_one(group, "id", H5T_NATIVE_INT64, ATOMS, ids);
    put(connectivity, "bonds", H5T_NATIVE_INT64, 2, (const hsize_t[]){1, 2}, bonds);
    H5Gclose(group);
    H5Gclose(connectivity);
    assert_ok(try());
    const struct structure_atom *const atom = trajectory.structure.atom; // by their ids
    assert_int_equal(trajectory.structure.residues, ATOMS - 1);
    assert_true(atom[0].id == 1 && atom[1].id == 2 && atom[0].residue == atom[1].residue);
    mf_trajectory_close(&trajectory);
}

/// Bonds of a group are not those of another one with as many particles.
static void test_h5md_has_bonds_of_its_own_group(void **state) {
    static const int64_t bonds[1][2] = {{0, 1}};
    static const double position[ATOMS][3] = {{0}};
    for (int other = 0; other < 2; other++) {
        hobj_ref_t reference;
        begin_file(state);
        const hid_t particles = H5Gopen(file, "particles", H5P_DEFAULT),
                    group = make_group(particles, "other"),
                    connectivity = make_group(file, "connectivity"), space = H5Screate(H5S_SCALAR);
        put(group, "position", H5T_NATIVE_DOUBLE, 2, (const hsize_t[]){ATOMS, 3}, position);
        put(connectivity, "bonds", H5T_NATIVE_INT64, 2, (const hsize_t[]){1, 2}, bonds);
        const hid_t dataset = H5Dopen(connectivity, "bonds", H5P_DEFAULT),
                    attribute = H5Acreate(dataset, "particles_group", H5T_STD_REF_OBJ, space,
                                          H5P_DEFAULT, H5P_DEFAULT);
        assert_true(H5Rcreate(&reference, file, "particles/other", H5R_OBJECT, -1) >= 0);
        assert_true(H5Awrite(attribute, H5T_STD_REF_OBJ, &reference) >= 0);
        H5Aclose(attribute);
        H5Dclose(dataset);
        H5Sclose(space);
        H5Gclose(connectivity);
        H5Gclose(group);
        H5Gclose(particles);
        H5Fclose(file);
        assert_ok(mf_trajectory_open(
            &trajectory, path,
            &(struct trajectory_options){.units = "nm-ps", .group = other ? "other" : "system"}));
        assert_int_equal(trajectory.structure.has_molecules, other);
        mf_trajectory_close(&trajectory);
    }
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_h5md_has_the_topology_of_gromacs),
        TEST(test_h5md_says_so_when_its_topology_is_of_others),
        TEST(test_h5md_has_molecules_of_bonds),
        TEST(test_h5md_has_bonds_of_ids),
        TEST(test_h5md_has_bonds_of_its_own_group),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
