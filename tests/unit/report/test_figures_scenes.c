// SPDX-License-Identifier: GPL-3.0-or-later
//
// Figures whose shape depends on the scene: particles, obstacles, dimensions.
#include "report/figures.h"
#include "shared/figure_folders.h"
#include "shared/is_close.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char blue[] = "rgb(  0, 114, 178)", vermillion[] = "rgb(213,  94,   0)";

/// Radius of the last point of a colour; 0 if there is none.
static double radius_of(const char *folder, const char *colour) {
    char path[FIGURE_PATH + 64], line[4096];
    double radius = 0;
    snprintf(path, sizeof path, "%s/figures/configuration.svg", folder);
    FILE *stream = fopen(path, "r");
    assert_non_null(stream);
    while (fgets(line, sizeof line, stream)) {
        const char *at = strstr(line, "scale(");
        if (at && strstr(line, colour))
            radius = strtod(at + strlen("scale("), NULL);
    }
    fclose(stream);
    return radius;
}

/// Two types, of which the table tells the radii alone: their discs are as large, and apart by
/// colour.
static void test_particles_are_discs_of_their_size_and_type(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "types");
    figure_folders_write(folder, "used.json",
                         "{\n\t\"dimensions\":\t2,\n\t\"box\":\t[10, 20]\n}\n");
    figure_folders_write(
        folder, "configuration.tsv",
        "# types: Big 1 small 2\n# x[lambda]\ty[lambda]\tradius\n5\t5\t2\n2\t2\t0.5\n8\t9\t0.5\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "configuration"));
    const double big = radius_of(folder, blue), small = radius_of(folder, vermillion);
    // 10 λ are about as wide as the figure without its margins; a rim is 0.3 pixels.
    assert_true(big > 60 && big < 110);
    assert_close_relative((big + 0.3) / (small + 0.3), 4, 0.01);
    assert_true(figure_folders_print(folder, "configuration", ">small<"));
}

/// Discs without radii touch where they begin to repel each other.
static void test_particles_without_radii_are_as_large_as_their_forces_reach(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    static const char scene[] =
        "{\n\t\"dimensions\":\t2,\n\t\"box\":\t[10, 10],\n\t\"conservative\":\t{\n"
        "\t\t\"law\":\t\"soft-repulsion\",\n\t\t\"a\":\t20,\n\t\t\"cutoff\":\t%s\n\t}\n}\n";
    static const char table[] = "# x[lambda]\ty[lambda]\n5\t5\n";
    char text[256];
    double width[2];
    for (int k = 0; k < 2; k++) {
        figure_folders_make(folder, k == 0 ? "short" : "long");
        snprintf(text, sizeof text, scene, k == 0 ? "1" : "3");
        figure_folders_write(folder, "used.json", text);
        figure_folders_write(folder, "configuration.tsv", table);
        figure_folders_draw(folder);
        width[k] = radius_of(folder, blue) + 0.3;
    }
    assert_close_relative(width[1] / width[0], 3, 0.01);
}

/// Of a box that spheres cover more than once a slab at the front is drawn: 8 of radius 2.5 cover
/// 157 of 100, so that it is 10/1.57 deep. The stiffest are yellow, the softest, here at the back,
/// would be violet.
static void test_full_boxes_show_a_slab_in_the_colour_of_stiffness(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    static const char yellow[] = "rgb(253, 231,  37)", violet[] = "rgb( 68,   1,  84)";
    for (int full = 0; full < 2; full++) {
        char folder[FIGURE_PATH], text[1024];
        size_t length = (size_t)snprintf(text, sizeof text,
                                         "# x[lambda]\ty[lambda]\tz[lambda]\tradius\tstiffness\n");
        for (int k = 0; k < 8; k++)
            length +=
                (size_t)snprintf(text + length, sizeof text - length, "%d\t5\t%s\t%s\t%d\n", k + 1,
                                 k < 4  ? "10"
                                 : full ? "3.5"
                                        : "10",
                                 full ? "2.5" : "1", k < 4 ? 30 : 10);
        figure_folders_make(folder, full ? "full" : "empty");
        figure_folders_write(folder, "used.json",
                             "{\n\t\"dimensions\":\t3,\n\t\"box\":\t[10, 10, 10]\n}\n");
        figure_folders_write(folder, "configuration.tsv", text);
        figure_folders_draw(folder);
        assert_true(radius_of(folder, yellow) > 0);
        assert_int_equal(radius_of(folder, violet) > 0, !full);
        assert_int_equal(figure_folders_print(folder, "configuration", "a slab of 6.4"), full);
        assert_true(figure_folders_print(folder, "configuration", ">stiffness<"));
    }
}

/// Count the halves of bonds that begin at each of two colours; returns the longest [pixels].
static double halves_of(const char *folder, int count[2]) {
    char path[FIGURE_PATH + 64], line[16384];
    double longest = 0;
    snprintf(path, sizeof path, "%s/figures/configuration.svg", folder);
    FILE *stream = fopen(path, "r");
    assert_non_null(stream);
    count[0] = count[1] = 0;
    while (fgets(line, sizeof line, stream))
        for (const char *at = line; (at = strstr(at, "<path stroke='rgb(")); at++) {
            double x[2], y[2];
            const int colour =
                strncmp(at + strlen("<path stroke='"), blue, strlen(blue)) == 0 ? 0 : 1;
            if (sscanf(strstr(at, "d='M"), "d='M%lf,%lf L%lf,%lf", &x[0], &y[0], &x[1], &y[1]) !=
                    4 ||
                (colour == 1 &&
                 strncmp(at + strlen("<path stroke='"), vermillion, strlen(vermillion)) != 0))
                continue;
            count[colour]++;
            longest = fmax(longest, hypot(x[1] - x[0], y[1] - y[0]));
        }
    fclose(stream);
    return longest;
}

/// Bonds of 0.5 and 1.5, one of them over an edge of the box: beads are a fifth of the mean, and
/// half a bond begins at each bead in the colour of its type.
static void test_bonds_are_drawn_over_the_edges_of_the_box(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        char folder[FIGURE_PATH], text[256];
        figure_folders_make(folder, dimensions == 2 ? "bonds-plane" : "bonds-space");
        snprintf(text, sizeof text, "{\n\t\"dimensions\":\t%d,\n\t\"box\":\t[10, 10%s]\n}\n",
                 dimensions, dimensions == 2 ? "" : ", 10");
        figure_folders_write(folder, "used.json", text);
        figure_folders_write(folder, "configuration.tsv",
                             "# types: A 2 B 2\n# x[lambda]\ty[lambda]\tz[lambda]\n"
                             "0.2\t5\t9.99\n4\t5\t9.99\n9.7\t5\t9.99\n5.5\t5\t9.99\n");
        figure_folders_write(folder, "configuration_bonds.tsv",
                             "# rows\n# first\tsecond\n1\t3\n2\t4\n");
        figure_folders_draw(folder);
        assert_true(figure_folders_drawn(folder, "configuration"));
        assert_true(figure_folders_print(folder, "configuration", ">B<"));
        int halves[2];
        const double radius = radius_of(folder, blue) + 0.3, longest = halves_of(folder, halves);
        assert_int_equal(halves[0], 2);
        assert_int_equal(halves[1], 2);
        // Half of the bond of 1.5 is 3.75 times a radius of a fifth of (0.5 + 1.5)/2.
        assert_close_relative(longest / radius, 3.75, 0.02);
    }
}

static const char grey[] = "<polygon fill = 'rgb(217, 217, 217)'";

static void test_flow_shows_its_obstacle(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH],
        text[1024] =
            "# x[lambda]\ty[lambda]\tv_x[lambda/tau]\tv_y[lambda/tau]\tdensity[1/lambda^d]\t"
            "vorticity[1/tau]\tstream_function[lambda^2/tau]\n";
    for (int n = 0; n < 16; n++)
        sprintf(text + strlen(text), "%g\t%g\t1\t0\t10\t%g\t%g\n", n % 4 + 0.5, n / 4 + 0.5,
                0.1 * n, n / 4 + 0.5);
    static const char scene[] =
        "{\n\t\"dimensions\":\t2,\n\t\"box\":\t[4, 4],\n\t\"dynamics\":\t{\n"
        "\t\t\"obstacle_centre\":\t[2, 2],\n\t\t\"obstacle_radius\":\t1\n"
        "\t}\n}\n";
    figure_folders_make(folder, "obstacle");
    figure_folders_write(folder, "used.json", scene);
    figure_folders_write(folder, "flow_field.tsv", text);
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "flow_field"));
    assert_true(figure_folders_print(folder, "flow_field", grey));
    figure_folders_make(folder, "no-obstacle");
    figure_folders_write(folder, "used.json", "{\n\t\"box\":\t[4, 4]\n}\n");
    figure_folders_write(folder, "flow_field.tsv", text);
    figure_folders_draw(folder);
    assert_false(figure_folders_print(folder, "flow_field", grey));
}

static void test_pressure_is_over_lengths_of_as_many_dimensions(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    for (int dimensions = 2; dimensions <= 3; dimensions++) {
        char folder[FIGURE_PATH], text[64];
        figure_folders_make(folder, dimensions == 2 ? "plane" : "space");
        figure_folders_write(folder, "thermodynamics.tsv",
                             "# step\ttime[tau]\ttemperature[T_0]\tpotential_energy[k_B.T_0]\t"
                             "pressure[k_B.T_0/lambda^d]\ttemperature_configurational[T_0]\n"
                             "0\t0\t1\t0\t30\tnan\n1\t0.1\t1\t0\t30\tnan\n");
        snprintf(text, sizeof text, "{\n\t\"dimensions\":\t%d\n}\n", dimensions);
        figure_folders_write(folder, "used.json", text);
        figure_folders_draw(folder);
        // The only raised figure.
        assert_true(figure_folders_print(
            folder, "simulation", dimensions == 2 ? "dy=\"-6.50px\">2<" : "dy=\"-6.50px\">3<"));
    }
}

/// All particles are one cluster: its size is on the axis.
static void test_the_one_size_of_clusters_is_told(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "one cluster");
    figure_folders_write(folder, "clusters.tsv", "# size[1]\tshare[1]\tclusters[1]\n3000\t1\t1\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_print(folder, "clusters", ">3000<"));
    assert_true(figure_folders_print(folder, "clusters", "share of all particles"));
    figure_folders_write(
        folder, "used.json",
        "{\n\t\"clusters\":\t{\n\t\t\"distance\":\t1,\n\t\t\"types\":\t\"H T\"\n\t}\n}\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_print(folder, "clusters", "share of all H and T beads"));
}

/// A reduced scene with "units": no figure has λ, T_0 or k_B T_0 beside nm and kJ/mol.
static void test_figures_are_all_in_the_units_that_are_given(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    static const char *const figures[] = {"simulation", "configuration"};
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "given units");
    figure_folders_write(
        folder, "used.json",
        "{\n\t\"dimensions\":\t3,\n\t\"box\":\t[8, 8, 8],\n\t\"units\":\t{\n"
        "\t\t\"length\":\t0.5,\n\t\t\"temperature\":\t300,\n\t\t\"mass\":\t3e-26\n\t}\n}\n");
    figure_folders_write(folder, "configuration.tsv",
                         "# x[lambda]\ty[lambda]\tz[lambda]\n5\t5\t2\n2\t2\t0.5\n8\t7\t0.5\n");
    figure_folders_write(
        folder, "thermodynamics.tsv",
        "# step\ttime[tau]\ttemperature[T_0]\tpotential_energy[k_B.T_0]\t"
        "pressure[k_B.T_0/lambda^d]\ttemperature_configurational[T_0]\ttotal_energy[k_B.T_0]\t"
        "time[ps]\tpotential_energy[kJ/mol]\tpressure[bar]\n"
        "0\t0\t0.99\t1\t3\t1\t2\t0\t2.494339\t900\n1\t0.1\t1.01\t2\t3\t1\t3\t70\t4.988678\t900\n");
    figure_folders_draw(folder);
    for (int k = 0; k < 2; k++) {
        assert_true(figure_folders_drawn(folder, figures[k]));
        assert_false(figure_folders_print(folder, figures[k], "λ"));
        assert_false(figure_folders_print(folder, figures[k], ">B<")); // of k_B
    }
    assert_true(figure_folders_print(folder, "configuration", "nm"));
    assert_true(figure_folders_print(folder, "configuration", ">4<")); // the edge of the box
    assert_true(figure_folders_print(folder, "simulation", "K"));
    assert_true(figure_folders_print(folder, "simulation", ">300<"));
}

/// Sweeps of Monte Carlo are no times, and have no unit.
static void test_vectors_of_molecules_live_for_times_or_sweeps(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    for (int sweeps = 0; sweeps < 2; sweeps++) {
        char folder[FIGURE_PATH], text[256];
        figure_folders_make(folder, sweeps ? "sampled" : "moved");
        snprintf(text, sizeof text, "# %s\tchain[1]\tchain_error[1]\n0\t1\t0.01\n10\t0.6\t0.02\n",
                 sweeps ? "sweeps[1]" : "time[tau]");
        figure_folders_write(folder, "end_to_end.tsv", text);
        figure_folders_write(folder, "molecule_sizes.tsv", text);
        figure_folders_draw(folder);
        assert_true(figure_folders_drawn(folder, "molecule_sizes"));
        assert_int_equal(figure_folders_print(folder, "molecule_sizes", "sweeps"), sweeps);
        assert_int_equal(figure_folders_print(folder, "molecule_sizes", "τ"), !sweeps);
        assert_true(figure_folders_print(folder, "molecule_sizes", "⟨"));
        assert_true(figure_folders_print(folder, "molecule_sizes", "chain: end to end"));
        assert_true(figure_folders_print(folder, "molecule_sizes", "radius of gyration"));
    }
}

/// A fit's distribution of a group has the result in blue and no second colour, as its g(r).
static void test_groups_of_a_fit_have_the_colours_of_its_rdf(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "groups");
    figure_folders_write(folder, "rdf.tsv", figure_folders_fit_rdf);
    figure_folders_write(folder, "bond_lengths_arm.tsv",
                         "# r[lambda]\ttarget[1/lambda]\ttarget_error[1/lambda]\t"
                         "result[1/lambda]\tresult_error[1/lambda]\n0.5\t1\t0.1\t1.2\t0.1\n"
                         "0.6\t2\t0.1\t1.8\t0.1\n0.7\t1\t0.1\t1.1\t0.1\n");
    // The same numbers of two groups of a simulation, which are apart by colour.
    figure_folders_write(folder, "bond_lengths.tsv",
                         "# r[lambda]\tarm[1/lambda]\tarm_error[1/lambda]\tleg[1/lambda]\t"
                         "leg_error[1/lambda]\n0.5\t1\t0.1\t1.2\t0.1\n0.6\t2\t0.1\t1.8\t0.1\n");
    figure_folders_draw(folder);
    static const char *const names[] = {"rdf", "bond_lengths_arm"};
    for (int k = 0; k < 2; k++) {
        assert_true(figure_folders_print(folder, names[k], ">target<"));
        assert_true(figure_folders_print(folder, names[k], blue));
        assert_true(figure_folders_print(folder, names[k], "xlink:href='#gpPt6'"));
        assert_false(figure_folders_print(folder, names[k], vermillion));
    }
    assert_true(figure_folders_print(folder, "bond_lengths", vermillion));
    assert_false(figure_folders_print(folder, "bond_lengths", "xlink:href='#gpPt6'"));
}

static void test_axes_are_named_whatever_the_table_says_of_its_errors(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "errors_of_samples");
    figure_folders_write(folder, "target.json", "{}");
    figure_folders_write(folder, "rdf.tsv",
                         "# errors of samples\n# r[nm]\tg[1]\tg_error[1]\n0.1\t0\t0\n0.3\t2\t0.1\n"
                         "0.5\t1\t0.1\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "rdf"));
    assert_true(figure_folders_print(folder, "rdf", "nm"));
    assert_false(figure_folders_print(folder, "rdf", "errors"));
}

static void test_structure_factors_of_pair_types_are_drawn_by_name(void **state) {
    (void)state;
    figure_folders_skip_without_gnuplot();
    char folder[FIGURE_PATH];
    figure_folders_make(folder, "structure");
    figure_folders_write(folder, "structure_factor.tsv",
                         "# q[1/lambda]\tS[1]\tS_error[1]\tS(A_1-A_1)[1]\tS_error(A_1-A_1)[1]\t"
                         "S(A_1-B)[1]\tS_error(A_1-B)[1]\tS(B-B)[1]\tS_error(B-B)[1]\n"
                         "1\t0.5\t0.01\t0.9\t0.01\t-0.5\t0.01\t0.9\t0.01\n"
                         "2\t1\t0.01\t1.1\t0.01\t0.1\t0.01\t1.1\t0.01\n");
    figure_folders_draw(folder);
    assert_true(figure_folders_drawn(folder, "structure_factor"));
    assert_true(figure_folders_print(folder, "structure_factor", ">A_1-B<"));
    assert_true(figure_folders_print(folder, "structure_factor", ">B-B<"));
    assert_true(figure_folders_print(folder, "structure_factor", ">all<"));
    assert_false(figure_folders_print(folder, "structure_factor", "error"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_particles_are_discs_of_their_size_and_type),
        cmocka_unit_test(test_particles_without_radii_are_as_large_as_their_forces_reach),
        cmocka_unit_test(test_full_boxes_show_a_slab_in_the_colour_of_stiffness),
        cmocka_unit_test(test_bonds_are_drawn_over_the_edges_of_the_box),
        cmocka_unit_test(test_flow_shows_its_obstacle),
        cmocka_unit_test(test_pressure_is_over_lengths_of_as_many_dimensions),
        cmocka_unit_test(test_the_one_size_of_clusters_is_told),
        cmocka_unit_test(test_figures_are_all_in_the_units_that_are_given),
        cmocka_unit_test(test_vectors_of_molecules_live_for_times_or_sweeps),
        cmocka_unit_test(test_groups_of_a_fit_have_the_colours_of_its_rdf),
        cmocka_unit_test(test_axes_are_named_whatever_the_table_says_of_its_errors),
        cmocka_unit_test(test_structure_factors_of_pair_types_are_drawn_by_name),
    };
    return cmocka_run_group_tests(tests, figure_folders_begin, figure_folders_end);
}
