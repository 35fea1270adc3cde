// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/small_scenes.h"

#include "shared/small_inputs.h"

const char small_scenes_dpd[] =
    "{\"seed\": 5, \"box\": [4.64, 4.64, 4.64], \"particles\": {\"count\": 300},\n"
    "\"time_step\": 0.04, \"conservative\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 2.1213},\n"
    "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10},\n"
    "\"units\": {\"length\": 0.7, \"temperature\": 300, \"mass\": 9e-26}}\n";

const char small_scenes_mixture[] =
    "{\"seed\": 5, \"box\": [4.64, 4.64, 4.64],\n"
    "\"particles\": {\"types\": {\"A\": 120, \"B\": 180}}, \"time_step\": 0.04,\n"
    "\"conservative\": {\"A-A\": {\"law\": \"soft-repulsion\", \"a\": 25},\n"
    "  \"B-A\": {\"law\": \"soft-repulsion\", \"a\": 30, \"cutoff\": 0.9},\n"
    "  \"B-B\": {\"law\": \"none\"}},\n"
    "\"dissipative\": {\"law\": \"power\", \"sigma\": 2.1213},\n"
    "\"measure\": {\"equilibration\": 100, \"samples\": 20, \"every\": 10}}\n";

const char small_scenes_nve[] =
    "{\"seed\": 5, \"box\": [7.3, 7.1, 7.2], \"particles\": {\"count\": 300},\n"
    "\"time_step\": 0.002, \"conservative\": {\"law\": \"lennard-jones\"},\n"
    "\"rdf\": {\"range\": 3.5, \"bins\": 70}, " SMALL_SCENES_LONG_MEASURE "}\n";

const char *const small_scenes_tables[] = {"rdf.tsv", "thermodynamics.tsv", NULL};

const char *const small_scenes_moving_tables[] = {"rdf.tsv", "thermodynamics.tsv", "motion.tsv",
                                                  NULL};
const char *const small_scenes_mixture_tables[] = {"rdf_A-A.tsv", "rdf_A-B.tsv", "rdf_B-B.tsv",
                                                   "thermodynamics.tsv", NULL};

void small_scenes_write(struct temporary_folder *folder, const char *text, const char *from,
                        const char *to) {
    small_inputs_write(folder, "scene.json", text, from, to);
}

void small_scenes_simulate(struct run_program_result *result, const char *out) {
    RUN_PROGRAM(result, "simulate", "scene.json", "-o", out);
    run_program_assert_code(result, 0);
}
