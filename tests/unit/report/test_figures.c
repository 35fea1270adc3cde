// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/figures.h"

#include "io/output.h"
#include "shared/figure_folders.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char ga_history[] =
    "# iteration[1]\tevaluations[1]\tengine_steps[1]\terror[1]\tnoise[1]\tbest[1]\tmean[1]\t"
    "diversity[1]\tfailures[1]\n0\t10\t100\t0.5\t0\t0.5\t1\t2\t0\n1\t20\t200\t0.4\tnan\t0."
    "4\t1\t1\t0\n";

static void test_draws_what_the_tables_allow(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "it's a \"fit\" $HOME\\");
    figure_folders_write(folder, "rdf.tsv", figure_folders_fit_rdf);
    figure_folders_write(folder, "potential.tsv",
                         "# r[lambda]\tphi[k_BT_0]\tforce[k_BT_0/lambda]\tphi_error[k_BT_0]\n"
                         "0.5\t1000\t0\tnan\n1\t-0.5\t0\tnan\n1.5\t0\t0\tnan\n");
    figure_folders_write(folder, "history.tsv", ga_history);
    figure_folders_write(folder, "timing.tsv", figure_folders_timing);
    if (mf_figures_draw(folder) != STATUS_OK)
        fail_msg("%s", mf_status_message());
    assert_true(figure_folders_drawn(folder, "rdf"));
    assert_true(figure_folders_drawn(folder, "potential"));
    assert_true(figure_folders_drawn(folder, "error"));
    assert_true(figure_folders_drawn(folder, "generations"));
    assert_false(figure_folders_drawn(folder, "simulation"));
}

/// Two targets, with one member on the front and errors that are not known, and three.
static void test_draws_the_front_of_several_targets(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "front");
    figure_folders_write(folder, "pareto.tsv",
                         "# member\trank\tchosen\tmeasured\terror[1]\trdf_rmse[1]\tetd_rmse[1]\t"
                         "rdf_noise[1]\tetd_noise[1]\n1\t1\t1\t3\t2\t0.1\t0.2\t0\t0\n");
    assert_int_equal(mf_figures_draw(folder), STATUS_OK);
    assert_false(figure_folders_drawn(folder, "pareto"));
    figure_folders_write(folder, "pareto_history.tsv",
                         "# iteration\tfront\terror[1]\trdf_rmse[1]\tetd_rmse[1]\n"
                         "0\t0\t2\t0.1\t0.2\n0\t2\t2\t0.1\t0.2\n");
    if (mf_figures_draw(folder) != STATUS_OK)
        fail_msg("%s", mf_status_message());
    assert_true(figure_folders_drawn(folder, "pareto"));
    figure_folders_write(folder, "pareto.tsv",
                         "# member\trank\tchosen\tmeasured\terror[1]\trdf_rmse[1]\tetd_rmse[1]\t"
                         "pressure_rmse[1]\trdf_noise[1]\tetd_noise[1]\tpressure_noise[1]\n"
                         "1\t1\t0\t1\t2\t0.1\t0.3\t1\t0.05\t0.1\t0.2\n"
                         "2\t1\t1\t3\t2\t0.2\t0.2\t1\t0.05\t0.1\t0.2\n"
                         "3\t2\t0\t1\t2\t0.3\t0.4\t2\t0.05\t0.1\t0.2\n");
    figure_folders_write(
        folder, "pareto_history.tsv",
        "# iteration\tfront\terror[1]\trdf_rmse[1]\tetd_rmse[1]\tpressure_rmse[1]\n"
        "0\t0\t2\t0.1\t0.2\t1\n0\t2\t2\t0.1\t0.2\t1\n");
    if (mf_figures_draw(folder) != STATUS_OK)
        fail_msg("%s", mf_status_message());
}

static void test_draws_no_generations_without_diversity(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "imc");
    figure_folders_write(folder, "history.tsv", figure_folders_imc_history);
    figure_folders_write(folder, "timing.tsv", figure_folders_timing);
    assert_int_equal(mf_figures_draw(folder), STATUS_OK);
    assert_true(figure_folders_drawn(folder, "error"));
    assert_false(figure_folders_drawn(folder, "generations"));
}

/// Where all candidates of a generation fail, nothing is known of its errors but that they are bad.
static void test_draws_generations_of_which_all_failed(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH], table[1024];
    static const char names[] =
        "# iteration\tevaluations\tengine_steps\terror[1]\tnoise[1]\tleast[1]"
        "\tmean[1]\tdiversity[1]\tfailures\n";
    static const char failed[] = "2\t30\t3000\tnan\t0\tinf\tnan\t0.2\t10\n"
                                 "3\t40\t4000\tnan\t0\tinf\tinf\tnan\t10\n";
    static const char known[] = "0\t10\t1000\tnan\t0\t70\t80\t0.1\t7\n"
                                "1\t20\t2000\tnan\t0\t60\t70\t0.1\t8\n";
    figure_folders_make(folder, "failed");
    snprintf(table, sizeof table, "%s%s", names, failed);
    figure_folders_write(folder, "history.tsv", table);
    figure_folders_write(folder, "timing.tsv", "# iteration\tseconds[s]\n2\t3\n3\t4\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "generations"));
    assert_false(figure_folders_drawn(folder, "error")); // of which there is no number
    snprintf(table, sizeof table, "%s%s%s", names, known, failed);
    figure_folders_write(folder, "history.tsv", table);
    figure_folders_draw(folder);
    assert_true(figure_folders_print(folder, "generations", ">50<"));
    assert_true(figure_folders_print(folder, "generations", ">100<"));
}

static void test_draws_simulation_and_no_fit(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "simulation");
    figure_folders_write(folder, "rdf.tsv",
                         "# r[lambda]\tg[1]\tg_error[1]\n0.5\t0\t0\n1\t1\t0.1\n");
    figure_folders_write(folder, "thermodynamics.tsv",
                         "# step[1]\ttime[tau]\ttemperature[T_0]\tpotential_energy[k_BT_0]\t"
                         "pressure[k_BT_0/lambda^3]\ttemperature_configurational[T_0]\n"
                         "0\t0\t1\t0\t3\tnan\n1\t0.1\t1\t0\t3\tnan\n");
    assert_int_equal(mf_figures_draw(folder), STATUS_OK);
    assert_true(figure_folders_drawn(folder, "simulation"));
    assert_false(figure_folders_drawn(folder, "rdf"));
}

/// Of a mixture: g(r) of every pair type, and its name. In units that the tables know.
static void test_draws_simulation_of_a_mixture_in_its_units(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "mixture");
    static const char rdf[] = "# r[lambda]\tg[1]\tg_error[1]\tr[nm]\n0.5\t0\t0\t2\n1\t1\t0.1\t4\n";
    figure_folders_write(folder, "rdf_A-A.tsv", rdf);
    figure_folders_write(folder, "rdf_A-B.tsv", rdf);
    figure_folders_write(folder, "rdf_B-B.tsv", rdf);
    figure_folders_write(folder, "thermodynamics.tsv",
                         "# step\ttime[tau]\ttemperature[T_0]\tpotential_energy[k_B.T_0]\t"
                         "pressure[k_B.T_0/lambda^d]\ttemperature_configurational[T_0]\ttime[ps]\t"
                         "potential_energy[kJ/mol]\tpressure[bar]\n"
                         "0\t0\t1\t1\t3\tnan\t0\t2.5\t900\n1\t0.1\t1\t2\t3\tnan\t70\t5\t900\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "simulation"));
    assert_true(figure_folders_print(folder, "simulation", "A-B"));
    assert_true(figure_folders_print(folder, "simulation", "nm") &&
                figure_folders_print(folder, "simulation", "ps"));
    assert_true(figure_folders_print(folder, "simulation", "kJ/mol") &&
                figure_folders_print(folder, "simulation", "bar"));
    assert_true(figure_folders_print(folder, "simulation", ">3.5<")); // a distance in nm
    assert_true(figure_folders_print(folder, "simulation", ">60<"));  // a time in ps
    assert_true(figure_folders_print(folder, "simulation", ">900<"));
}

/// A barrier of 1.33 after a core of 50, and a well of 0.3: all of it is seen.
static void test_potential_is_shown_up_to_its_barrier(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "barrier");
    figure_folders_write(folder, "potential.tsv",
                         "# r[lambda]\tphi[k_B.T_0]\tforce[k_B.T_0/lambda]\tphi_error[k_B.T_0]\n"
                         "0.2\t50\t0\tnan\n0.25\t0.2\t0\tnan\n0.3\t0.1\t0\tnan\n"
                         "0.375\t1.33\t0\tnan\n0.5\t-0.3\t0\tnan\n1\t0\t0\tnan\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "potential"));
    assert_true(figure_folders_print(folder, "potential", ">1.4<"));
    assert_false(figure_folders_print(folder, "potential", ">2<"));
}

/// Ideal particles, distances that no pair has, laws of one strength, and one bin: no axis is
/// empty.
static void test_draws_tables_whose_numbers_are_all_the_same(void **state) {
    static const char *const names[] = {"potential", "rdf", "bonds_even", "bond_lengths_even"};
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "flat");
    figure_folders_write(folder, "potential.tsv",
                         "# r[lambda]\tphi[k_B.T_0]\tforce[k_B.T_0/lambda]\tphi_error[k_B.T_0]\n"
                         "0.5\t0\t0\tnan\n1\t0\t0\tnan\n");
    figure_folders_write(folder, "rdf.tsv",
                         "# r[lambda]\ttarget[1]\ttarget_error[1]\tresult[1]\tresult_error[1]\n"
                         "0.5\t0\t0\t0\t0\n1\t0\t0\t0\t0\n");
    figure_folders_write(folder, "bonds_even.tsv",
                         "# r[lambda]\tenergy[k_B.T_0]\tenergy_error[k_B.T_0]\n1\t0\tnan\n");
    figure_folders_write(folder, "bond_lengths_even.tsv",
                         "# r[lambda]\ttarget[1/lambda]\ttarget_error[1/lambda]\t"
                         "result[1/lambda]\tresult_error[1/lambda]\n0.8\t1\t0\t1\t0\n");
    figure_folders_draw(folder);
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        assert_true(figure_folders_drawn(folder, names[k]));
}

/// A soft repulsion whose core goes on steeply where no pair was seen, in nm and kJ/mol.
static void test_soft_potential_is_shown_almost_whole(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH], table[2048];
    int length = snprintf(table, sizeof table,
                          "# r[lambda]\tphi[k_B.T_0]\tforce[k_B.T_0/lambda]\t"
                          "phi_error[k_B.T_0]\tr[nm]\tphi[kJ/mol]\n");
    figure_folders_make(folder, "soft");
    for (int k = 0; k <= 20; k++) {
        const double r = 0.05 * k, core = r < 0.2 ? 1000 * (0.2 - r) : 0;
        const double phi = 16 * (1 - r) * (1 - r) + core;
        length += snprintf(table + length, sizeof table - (size_t)length,
                           "%g\t%g\t0\t0.1\t%g\t%g\n", r, phi, 2 * r, 10 * phi);
    }
    figure_folders_write(folder, "potential.tsv", table);
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "potential"));
    assert_true(figure_folders_print(folder, "potential", "nm") &&
                figure_folders_print(folder, "potential", "kJ/mol"));
    assert_true(figure_folders_print(folder, "potential", ">0.8<")); // nm: 0.4 lambda
    assert_true(figure_folders_print(folder, "potential", ">40<"));
    assert_false(figure_folders_print(folder, "potential", ">300<"));
}

/// Two times, three bins; no result at time 0, nothing known of the last bin.
static const char fit_cells[] =
    "# time[tau]\tr0[lambda]\ttarget[1]\ttarget_error[1]\tresult[1]\tresult_error[1]\n"
    "0\t0.6\t1\t0\tnan\t0\n0\t0.7\t1\t0\tnan\t0\n0\t0.8\t1\t0\tnan\tnan\n"
    "0.1\t0.6\t0.9\t0.01\t0.8\t0.01\n0.1\t0.7\t0.7\t0.01\t0.75\t0.01\n"
    "0.1\t0.8\t0.4\t0.01\tnan\tnan\n0.2\t0.6\t0.8\t0.01\t0.7\t0.01\n"
    "0.2\t0.7\t0.6\t0.01\t0.65\t0.01\n0.2\t0.8\t0.3\t0.01\tnan\tnan\n";

static void test_draws_dynamics_of_a_fit(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "dynamics");
    figure_folders_write(folder, "etd_cells.tsv", fit_cells);
    figure_folders_write(folder, "vacf.tsv",
                         "# time[tau]\ttarget\ttarget_error\tresult\tresult_error\n"
                         "0\t3\t0.01\t3.1\tnan\n0.1\t1\t0.01\t1.2\tnan\n0.2\t-0.1\t0.01\t0\tnan\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "etd_cells"));
    assert_true(figure_folders_print(folder, "etd_cells", "0.700"));
    assert_false(figure_folders_print(folder, "etd_cells", "0.800"));
    assert_true(figure_folders_drawn(folder, "vacf"));
    assert_false(figure_folders_drawn(folder, "etd"));
    assert_false(figure_folders_drawn(folder, "msd"));
    figure_folders_write(folder, "msd.tsv",
                         "# time[tau]\ttarget[lambda^2]\ttarget_error[lambda^2]\tresult[lambda^2]\t"
                         "result_error[lambda^2]\n"
                         "0\t0\t0\t0\t0\n0.1\t1\t0.01\t1.2\tnan\n0.2\t3\t0.01\t2.9\tnan\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "msd"));
}

/// A first bin of one pair would be a line along E = 1 below the others, and a band of everything.
static void test_draws_etd_of_the_bins_with_pairs_enough(void **state) {
    char folder[FIGURE_PATH];
    (void)state;
    figure_folders_skip_without_gnuplot();
    figure_folders_make(folder, "etd_bins");
    figure_folders_write(folder, "etd.tsv",
                         "# time[tau]\tE(r0=0.1)[1]\tE(r0=0.3)[1]\tE(r0=0.5)[1]\tE(r0=0.7)[1]\n"
                         "0\tnan\t1\t1\t1\n0.5\tnan\t1\t0.9\t0.8\n1\tnan\t1\t0.5\t0.4\n");
    figure_folders_write(folder, "etd_error.tsv",
                         "# time[tau]\tE_error\tE_error\tE_error\tE_error\n0\tnan\t0\t0\t0\n"
                         "0.5\tnan\t0.5\t0.02\t0.01\n1\tnan\t0.5\t0.02\t0.01\n");
    figure_folders_write(folder, "etd_bins.tsv",
                         "# r0[lambda]\tpairs[1]\n0.1\t0\n0.3\t1\n0.5\t150\n0.7\t5000\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "etd"));
    assert_false(figure_folders_print(folder, "etd", "0.300"));
    assert_true(figure_folders_print(folder, "etd", "0.500"));
    assert_true(figure_folders_print(folder, "etd", "0.700"));
    figure_folders_write(folder, "etd_bins.tsv",
                         "# r0[lambda]\tpairs[1]\n0.1\t0\n0.3\t1\n0.5\t15\n0.7\t50\n");
    figure_folders_draw(folder);
    assert_false(figure_folders_print(folder, "etd", "0.100"));
    assert_true(figure_folders_print(folder, "etd", "0.300"));
    assert_true(figure_folders_print(folder, "etd", "0.700"));
}

static void test_draws_etd_of_no_known_result(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "nothing known");
    figure_folders_write(
        folder, "etd_cells.tsv",
        "# time[tau]\tr0[lambda]\ttarget[1]\ttarget_error[1]\tresult[1]\tresult_error[1]\n"
        "0\t0.6\t1\t0\tnan\tnan\n0.1\t0.6\t1\t0\tnan\tnan\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "etd_cells"));
}

static void test_draws_bands_and_truth_where_they_are_known(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "weight");
    figure_folders_write(folder, "omega.tsv", "# r[lambda]\tomega[sqrt(mu/tau)]\n0\t2\n1\t0\n");
    figure_folders_draw(folder);
    assert_false(figure_folders_drawn(folder, "omega"));
    figure_folders_write(
        folder, "omega.tsv",
        "# r[lambda]\tomega[sqrt(mu/tau)]\tomega_error[sqrt(mu/tau)]\n0\t2\tnan\n1\t0\tnan\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "omega"));
    assert_false(figure_folders_print(folder, "omega", "95 % band"));
    assert_false(figure_folders_print(folder, "omega", "truth"));
    figure_folders_write(
        folder, "omega.tsv",
        "# r[lambda]\tomega[sqrt(mu/tau)]\tomega_error[sqrt(mu/tau)]\ttruth[sqrt(mu/tau)]\n"
        "0\t2\t0.5\t1.9\n0.5\t1\t0.1\t0.9\n1\t0\tnan\t0\n");
    figure_folders_write(folder, "potential.tsv",
                         "# r[lambda]\tphi[k_B.T_0]\tforce[k_B.T_0/lambda]\tphi_error[k_B.T_0]\t"
                         "truth[k_B.T_0]\tr[nm]\n"
                         "0.5\t1000\t0\tnan\t900\t0.2\n1\t-0.5\t0\t0.1\t-0.4\t0.4\n"
                         "1.5\t0\t0\tnan\t0\t0.6\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "omega"));
    assert_true(figure_folders_print(folder, "omega", "95 % band") &&
                figure_folders_print(folder, "omega", "truth"));
    assert_true(figure_folders_print(folder, "potential", "95 % band") &&
                figure_folders_print(folder, "potential", "truth"));
}

static void test_error_is_named_after_what_was_fitted(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "names");
    figure_folders_write(folder, "history.tsv", figure_folders_imc_history);
    figure_folders_write(folder, "timing.tsv", figure_folders_timing);
    figure_folders_write(folder, "used.json",
                         "{\n\t\"target\":\t{\n\t\t\"rdf\":\t{\n\t\t\t\"fitted\":\t\"no\"\n\t\t},\n"
                         "\t\t\"etd\":\t{\n\t\t\t\"fitted\":\t\"yes\"\n\t\t},\n"
                         "\t\t\"vacf\":\t{\n\t\t\t\"fitted\":\t\"yes\"\n\t\t}\n\t}\n}\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_print(folder, "error", "weighted error"));
    figure_folders_write(folder, "used.json",
                         "{\n\t\"target\":\t{\n\t\t\"diffusion\":\t{\n\t\t\t\"fitted\":\t\"yes\"\n"
                         "\t\t}\n\t}\n}\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_print(folder, "error", "rmse of"));
    assert_true(figure_folders_print(folder, "error", "τ")); // its unit
}

/// Of a mixture's inversion: tables whose names look like those of a pair type are others, since no
/// type has a name that begins or ends so.
static void test_pairs_are_drawn_of_their_own_tables_only(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    static const char now[] =
        "# r[lambda]\ttarget[1]\tresult[1]\tresult_error[1]\texcess[1]\n0.5\t0\t0\t0\t0\n"
        "1\t1\t1.1\t0.1\t30\n";
    static const char history[] = "# r[lambda]\t0\t1\t2\n0.5\t1\t1\t1\n1\t0\t0\t0\n";
    static const char flat[] = "# changes\n# r[lambda]\t3\t0.2\n0.5\t0.1\t0.2\n1\t0.1\t0.1\n";
    static const char potential[] =
        "# r[lambda]\tphi[k_B.T_0]\tforce[k_B.T_0/lambda]\tphi_error[k_B.T_0]\n"
        "0.5\t1\t2\t0.1\n1\t0\t2\t0.1\n";
    figure_folders_make(folder, "alike");
    figure_folders_write(folder, "rdf_A-B.tsv", figure_folders_fit_rdf);
    figure_folders_write(folder, "rdf_now_A-B.tsv", now);
    figure_folders_write(folder, "potential_A-B.tsv", potential);
    figure_folders_write(folder, "potential_A-B_history.tsv", history);
    figure_folders_write(folder, "potential_A-B_flat.tsv", flat);
    figure_folders_write(folder, "potential_A-of_history.tsv", potential);
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "rdf_A-B"));
    assert_true(figure_folders_drawn(folder, "potential_A-B"));
    // As a title, of which the axis has the index, so that figures of one mixture can be told
    // apart.
    assert_true(figure_folders_print(folder, "rdf_A-B", ">A-B<"));
    assert_true(figure_folders_print(folder, "potential_A-B", ">A-B<"));
    assert_false(figure_folders_drawn(folder, "potential_A-of_history"));
    assert_false(figure_folders_drawn(folder, "rdf_now_A-B"));
    assert_false(figure_folders_drawn(folder, "potential_A-B_history"));
    assert_false(figure_folders_drawn(folder, "potential_A-B_flat"));
}

static void test_draws_nothing_without_tables(void **state) {
    (void)state;
    char folder[FIGURE_PATH], figures[FIGURE_PATH + 64];
    figure_folders_make(folder, "empty");
    assert_int_equal(mf_figures_draw(folder), STATUS_OK);
    snprintf(figures, sizeof figures, "%s/figures", folder);
    assert_int_not_equal(access(figures, F_OK), 0);
}

static void test_broken_tables_spoil_their_figures_only(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "broken/figures"); // with figures of an earlier run
    figure_folders_write(folder, "rdf.svg", "old");
    figure_folders_write(folder, "rdf.png", "old");
    figure_folders_make(folder, "broken");
    figure_folders_write(folder, "potential.tsv", "# r phi force phi_error\nnot a number\n");
    figure_folders_write(folder, "rdf.tsv",
                         "# r target target_error result result_error\nnot a number\n");
    figure_folders_write(folder, "history.tsv", figure_folders_imc_history);
    figure_folders_write(folder, "timing.tsv", figure_folders_timing);
    assert_int_equal(mf_figures_draw(folder), STATUS_IO);
    assert_non_null(strstr(mf_status_message(), "/broken/figures/rdf: gnuplot failed: "));
    assert_non_null(strstr(mf_status_message(), "rdf.gp\" line "));
    assert_null(strchr(mf_status_message(), '\n'));
    assert_false(figure_folders_drawn(folder, "rdf"));
    assert_true(figure_folders_drawn(folder, "error"));
}

static void test_missing_gnuplot_is_one_clear_line(void **state) {
    (void)state;
    char folder[FIGURE_PATH], message[2 * FIGURE_PATH], *path = strdup(getenv("PATH"));
    figure_folders_make(folder, "no_gnuplot");
    figure_folders_write(folder, "rdf.tsv", figure_folders_fit_rdf);
    assert_int_equal(setenv("PATH", figure_folders_root(), 1), 0);
    const enum status status = mf_figures_draw(folder);
    assert_int_equal(setenv("PATH", path, 1), 0);
    free(path);
    assert_int_equal(status, STATUS_IO);
    snprintf(message, sizeof message, "no figure %s/figures/rdf: gnuplot is not installed", folder);
    assert_string_equal(mf_status_message(), message);
}

static void test_comparison_needs_its_table(void **state) {
    (void)state;
    assert_int_equal(mf_figures_draw_comparison(figure_folders_root()), STATUS_IO);
    assert_non_null(strstr(mf_status_message(), "no compare.tsv in "));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_draws_what_the_tables_allow),
        cmocka_unit_test(test_draws_the_front_of_several_targets),
        cmocka_unit_test(test_draws_no_generations_without_diversity),
        cmocka_unit_test(test_draws_generations_of_which_all_failed),
        cmocka_unit_test(test_draws_simulation_and_no_fit),
        cmocka_unit_test(test_draws_simulation_of_a_mixture_in_its_units),
        cmocka_unit_test(test_potential_is_shown_up_to_its_barrier),
        cmocka_unit_test(test_draws_tables_whose_numbers_are_all_the_same),
        cmocka_unit_test(test_soft_potential_is_shown_almost_whole),
        cmocka_unit_test(test_draws_dynamics_of_a_fit),
        cmocka_unit_test(test_draws_etd_of_the_bins_with_pairs_enough),
        cmocka_unit_test(test_draws_etd_of_no_known_result),
        cmocka_unit_test(test_draws_bands_and_truth_where_they_are_known),
        cmocka_unit_test(test_error_is_named_after_what_was_fitted),
        cmocka_unit_test(test_pairs_are_drawn_of_their_own_tables_only),
        cmocka_unit_test(test_draws_nothing_without_tables),
        cmocka_unit_test(test_broken_tables_spoil_their_figures_only),
        cmocka_unit_test(test_missing_gnuplot_is_one_clear_line),
        cmocka_unit_test(test_comparison_needs_its_table),
    };
    return cmocka_run_group_tests(tests, figure_folders_begin, figure_folders_end);
}
