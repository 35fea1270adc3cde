// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_file.h"

#include "problem/unknowns.h"
#include "shared/is_close.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

/// Above this g the target knows the potential well.
static const double well_known = 0.5;

/// rms of base − truth where g is well known, less the best ramp A (1 − r/r_c), which the closure
/// does not know; and of base − (−k_B T ln g).
static void compare(const struct fit_file *fit, double *to_truth, double *to_mean_force) {
    const struct rdf_bins *bins = &fit->problem.targets.bins;
    const double *g = fit->problem.targets.target[TARGET_RDF].value;
    const double *base = fit->problem.unknown[UNKNOWN_POTENTIAL].base;
    double count = 0, ramp = 0, squares = 0;
    *to_truth = *to_mean_force = 0;
    assert_non_null(base);
    for (size_t k = 0; k < bins->count; k++) {
        const double r = mf_rdf_bins_centre(bins, k);
        if (g[k] < well_known)
            continue;
        count += 1;
        const double off =
            base[k] - mf_curve_value(&fit->unknown[UNKNOWN_POTENTIAL].truth.curve[0], r);
        const double shape = 1 - r / mf_rdf_bins_range(bins);
        *to_truth += off * off;
        ramp += off * shape;
        squares += shape * shape;
        *to_mean_force += pow(base[k] + log(g[k]), 2);
    }
    *to_truth = sqrt((*to_truth - ramp * ramp / squares) / count);
    *to_mean_force = sqrt(*to_mean_force / count);
}

/// A fit of the Gaussian core, for which the hypernetted chain is good: A. Lang, C. N.
/// Likos, M. Watzlawek and H. Löwen, J. Phys.: Condens. Matter 12, 5087 (2000).
static void read_fit(void **state, struct fit_file *fit, const char *unknown) {
    char text[2048], folder[1024];
    assert_non_null(getcwd(folder, sizeof folder));
    const int length =
        snprintf(text, sizeof text,
                 "{\"target\": {\"rdf\": {\"file\": \"%s/targets/gaussian-core/rdf.tsv\"}}, "
                 "\"scene\": {\"box\": [19.05, 19.05, 19.05], \"particles\": {\"count\": 1728}, "
                 "\"time_step\": 0.01, \"dissipative\": {\"law\": \"power\", \"sigma\": 1.5}}, "
                 "\"unknowns\": {\"potential\": {%s \"truth\": {\"law\": \"gaussian\", "
                 "\"epsilon\": 20, \"sigma\": 1, \"cutoff\": 3.2}}}, "
                 "\"method\": {\"name\": \"genetic\"}}",
                 folder, unknown);
    assert_in_range(length, 1, sizeof text - 1);
    assert_ok(mf_fit_file_read(fit,
                               temporary_folder_write(*state, "run.json", text, (size_t)length),
                               &(struct run_options){.threads = 1}));
}

static void test_fit_base_is_the_hypernetted_chain_unless_another_is_named(void **state) {
    struct fit_file fit;
    double to_truth, to_mean_force;
    read_fit(state, &fit, "");
    compare(&fit, &to_truth, &to_mean_force);
    print_message("hypernetted chain: %.3f from the truth, %.3f from -ln g\n", to_truth,
                  to_mean_force);
    assert_true(to_mean_force > 0.5);
    const double chain = to_truth;
    assert_close(fit.unknown[UNKNOWN_POTENTIAL].parameters.minimum, -6.5, 0);
    mf_fit_file_clear(&fit);

    read_fit(state, &fit, "\"base\": \"mean-force\",");
    compare(&fit, &to_truth, &to_mean_force);
    assert_close(to_mean_force, 0, 1e-9);
    print_message("-ln g: %.3f from the truth\n", to_truth);
    assert_true(chain < 0.5 * to_truth);
    mf_fit_file_clear(&fit);

    read_fit(state, &fit,
             "\"start\": {\"law\": \"gaussian\", \"epsilon\": 20, \"sigma\": 1, "
             "\"cutoff\": 3.2},");
    compare(&fit, &to_truth, &to_mean_force);
    assert_close(to_truth, 0, 1e-9);
    mf_fit_file_clear(&fit);

    read_fit(state, &fit, "\"base\": \"none\",");
    assert_null(fit.problem.unknown[UNKNOWN_POTENTIAL].base);
    assert_close(fit.unknown[UNKNOWN_POTENTIAL].parameters.minimum, 0, 0);
    mf_fit_file_clear(&fit);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(
            test_fit_base_is_the_hypernetted_chain_unless_another_is_named, temporary_folder_create,
            temporary_folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
