// SPDX-License-Identifier: GPL-3.0-or-later
//
// docs/tutorial.md, command by command, as its reader types them.
#include "shared/is_close.h"
#include "shared/length.h"
#include "shared/results.h"
#include "shared/run_program.h"
#include "shared/small_inputs.h"
#include "shared/testing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/// Numbers of the page that are changed in short, so that its fits take a third of the time.
static const struct {
    const char *from, *to;
} shorter[] = {
    {"\"precision\": 0.005",
     "\"precision\": 0.01, \"replicas\": 4, \"equilibration\": 60, \"samples\": 100"},
    {"\"equilibration\": 500, \"samples\": 30}", "\"equilibration\": 500, \"samples\": 10}"},
    {"\"samples\": 30, \"every\": 20", "\"samples\": 10, \"every\": 20"}};

/// The page as page.md, in the working folder.
static void write_page(const char *sources) {
    char path[2048], line[4096];
    snprintf(path, sizeof path, "%s/docs/tutorial.md", sources);
    snprintf(line, sizeof line, "cp '%s' page.md", path);
    assert_int_equal(system(line), 0);
    for (size_t k = 0; k < (length_is_long() ? 0 : sizeof shorter / sizeof *shorter); k++) {
        snprintf(line, sizeof line, "grep -q '%s' page.md && sed -i 's/%s/%s/' page.md",
                 shorter[k].from, shorter[k].from, shorter[k].to);
        assert_int_equal(system(line), 0);
    }
}

/// Every command succeeds, the potential has converged and is exported; σ is found
/// again within three of its errors (false alarms: 0.3 %, but the seed is fixed), and the scene has
/// the pressure that another program finds.
static void test_tutorial_does_what_it_says(void **state) {
    char command[4096];
    const char *sources = run_program_sources();
    (void)state;
    assert_int_equal(symlink(getenv("MESOFIT"), "mesofit"), 0);
    snprintf(command, sizeof command, "%s/targets", sources);
    assert_int_equal(symlink(command, "targets"), 0);
    write_page(sources);
    snprintf(command, sizeof command,
             "PATH=.:\"$PATH\" '%s/tests/tools/run_page.sh' page.md >page.txt 2>&1", sources);
    if (system(command) != 0) {
        const char *page = temporary_folder_read("page.txt");
        const size_t length = strlen(page), shown = 800; // more are cut
        fail_msg("%s", page + (length > shown ? length - shown : 0));
    }
    results_assert_text("tutorial/out/summary.json", "status", "converged");
    results_assert_text("tutorial/omega/summary.json", "status", "converged");
    assert_true(results_number("tutorial/out/summary.json", "rdf_rmse") <
                (length_is_long() ? 0.01 : 0.03));
    const double sigma =
        results_number("tutorial/omega/summary.json", "parameters.omega.sigma.value");
    const double error =
        results_number("tutorial/omega/summary.json", "parameters.omega.sigma.error");
    print_message("sigma = %g(%g)\n", sigma, error);
    assert_true(error > 0 && error < (length_is_long() ? 4 : 8));
    assert_true(fabs(sigma - 22.74) < 3 * error);
    // LAMMPS finds 23.652(1), see tests/reference_data; one run has an error of 0.007.
    assert_close(results_number("tutorial/scene/summary.json", "pressure"), 23.652, 0.04);
    results_assert_table("tutorial/scene/rdf.tsv", 3, 100);
    char *page = temporary_folder_read("page.txt");
    assert_contains(page, "target rdf: g from 0.005 to 0.995 nm, peak 2.79 at 0.275 nm");
    assert_contains(page, "omega: sigma = ");
    free(page);
    results_assert_table("tutorial/out/potential.tsv", 5, 101);
    char *input = temporary_folder_read("tutorial/lammps/in.mesofit");
    assert_contains(input, "mesofit.table");
    free(input);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_tutorial_does_what_it_says, small_inputs_enter,
                                        small_inputs_leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
