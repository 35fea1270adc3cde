// SPDX-License-Identifier: GPL-3.0-or-later
//
// Figures of molecules and of mixtures, from small tables as runs write them.
#include "report/figures.h"

#include "shared/figure_folders.h"
#include "shared/testing.h"

#include <stdio.h>

static const char bond[] = "# r[nm]\tenergy[kJ/mol]\tenergy_error[kJ/mol]\n"
                           "0.1\t900\tnan\n0.15\t2\t0.1\n0.16\t0.5\t0.1\n0.17\t0\t0.1\n"
                           "0.18\t0.5\t0.1\n0.19\t2\t0.1\n0.3\t900\tnan\n";

/// What is known of U is shown, not the steep walls beyond it.
static void test_energy_of_a_group_is_drawn_where_it_is_known(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "bonds");
    figure_folders_write(folder, "bonds_back-bone_1.tsv", bond);
    figure_folders_write(folder, "bonds_back-bone_1_flat.tsv", "# r[nm]\tflat_1\n0.1\t1\n0.2\t2\n");
    figure_folders_write(folder, "bonds_back-bone_1_history.tsv",
                         "# r[nm]\t0[kJ/mol]\t1[kJ/mol]\n0.1\t900\t900\n0.15\t3\t2\n"
                         "0.16\t1\t0.5\n0.17\t0\t0\n0.18\t1\t0.5\n0.19\t3\t2\n0.3\t900\t900\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "bonds_back-bone_1"));
    assert_false(figure_folders_drawn(folder, "bonds_back-bone_1_flat"));
    assert_false(figure_folders_drawn(folder, "bonds_back-bone_1_history"));
    assert_true(figure_folders_print(folder, "bonds_back-bone_1", "kJ/mol"));
    assert_true(figure_folders_print(folder, "bonds_back-bone_1", "95 % band"));
    assert_true(figure_folders_print(folder, "bonds_back-bone_1", "iteration"));
    assert_true(figure_folders_print(folder, "bonds_back-bone_1", ">0.16<"));
    assert_false(figure_folders_print(folder, "bonds_back-bone_1", ">0.25<"));
    assert_false(figure_folders_print(folder, "bonds_back-bone_1", ">800<"));
    // The only iteration, as that of force matching, is the result.
    figure_folders_write(folder, "bonds_back-bone_1_history.tsv",
                         "# r[nm]\t0[kJ/mol]\n0.1\t900\n0.15\t2\n0.16\t0.5\n0.17\t0\n"
                         "0.18\t0.5\n0.19\t2\n0.3\t900\n");
    figure_folders_draw(folder);
    assert_false(figure_folders_print(folder, "bonds_back-bone_1", "iteration"));
}

/// A curve without errors is drawn whole and has no band.
static void test_energy_of_a_group_is_drawn_without_errors(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "dihedrals");
    figure_folders_write(folder, "dihedrals_turn.tsv",
                         "# phi[degrees]\tenergy[k_B.T_0]\tenergy_error[k_B.T_0]\n"
                         "-180\t0\tnan\n-90\t2\tnan\n0\t5\tnan\n90\t2\tnan\n180\t0\tnan\n");
    figure_folders_write(folder, "angles_'; system('touch pwned'); '.tsv", bond);
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "dihedrals_turn"));
    assert_true(figure_folders_print(folder, "dihedrals_turn", "degrees"));
    assert_true(figure_folders_print(folder, "dihedrals_turn", ">100<"));
    assert_false(figure_folders_print(folder, "dihedrals_turn", "95 % band"));
    assert_false(figure_folders_print(folder, "dihedrals_turn", "continued"));
}

/// A density per length or per degree has that unit.
static void test_distributions_have_their_units(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "distributions");
    figure_folders_write(folder, "bond_angles_bend.tsv",
                         "# theta[degrees]\ttarget[1/degrees]\ttarget_error[1/degrees]\t"
                         "result[1/degrees]\tresult_error[1/degrees]\n"
                         "100\t0.01\t0.001\t0.01\t0.001\n110\t0.02\t0.001\t0.02\t0.001\n");
    figure_folders_write(folder, "bond_lengths.tsv",
                         "# r[nm]\tbond[1/nm]\tbond_error[1/nm]\tbond_boltzmann[1]\n"
                         "0.1\t5\t1\t1\n0.2\t6\t1\t1\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_print(folder, "bond_angles_bend", "degrees"));
    assert_true(figure_folders_print(folder, "bond_angles_bend", "target"));
    assert_true(figure_folders_print(folder, "bond_angles_bend", ">bend<"));
    assert_true(figure_folders_print(folder, "bond_lengths", ">-1<"));
}

/// g(r) between molecules: of a simulation all pair types in one figure, of a fit one each.
static void test_draws_structure_between_molecules(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    static const char counted[] = "# r[lambda]\tg[1]\tg_error[1]\n0.5\t0\t0\n1\t1\t0.1\n";
    figure_folders_make(folder, "simulated between");
    figure_folders_write(folder, "intermolecular_rdf_A-A.tsv", counted);
    figure_folders_write(folder, "intermolecular_rdf_A-B.tsv", counted);
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "intermolecular_rdf"));
    assert_true(figure_folders_print(folder, "intermolecular_rdf", "A-B"));
    assert_false(figure_folders_drawn(folder, "intermolecular_rdf_A-B"));

    figure_folders_make(folder, "fitted between");
    figure_folders_write(folder, "intermolecular_rdf_A-A.tsv", figure_folders_fit_rdf);
    figure_folders_write(folder, "intermolecular_rdf_A-B.tsv", figure_folders_fit_rdf);
    figure_folders_draw(folder);
    assert_true(figure_folders_print(folder, "intermolecular_rdf_A-A", "target"));
    assert_true(figure_folders_print(folder, "intermolecular_rdf_A-B", "target"));
    assert_false(figure_folders_drawn(folder, "intermolecular_rdf"));
}

/// Of a mixture each pair type has its population.
static void test_draws_the_population_of_each_pair_type(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "populations");
    for (int k = 0; k < 2; k++) {
        const char *pair = k ? "A-B" : "A-A";
        char name[64];
        snprintf(name, sizeof name, "population_potential_%s.tsv", pair);
        figure_folders_write(folder, name,
                             "# columns are named by the error of their candidate\n"
                             "# r[lambda]\t0.5[k_B.T_0]\t0.6[k_B.T_0]\n0.5\t1\t2\n1\t0\t0\n");
        snprintf(name, sizeof name, "potential_%s.tsv", pair);
        figure_folders_write(folder, name,
                             "# r\tphi\tforce\tphi_error\n0.5\t1\t0\tnan\n1\t0\t0\tnan\n");
    }
    figure_folders_draw(folder);
    assert_true(figure_folders_print(folder, "population_A-A", "last generation"));
    assert_true(figure_folders_print(folder, "population_A-B", "last generation"));
    assert_false(figure_folders_drawn(folder, "population"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_energy_of_a_group_is_drawn_where_it_is_known),
        cmocka_unit_test(test_energy_of_a_group_is_drawn_without_errors),
        cmocka_unit_test(test_distributions_have_their_units),
        cmocka_unit_test(test_draws_structure_between_molecules),
        cmocka_unit_test(test_draws_the_population_of_each_pair_type),
    };
    return cmocka_run_group_tests(tests, figure_folders_begin, figure_folders_end);
}
