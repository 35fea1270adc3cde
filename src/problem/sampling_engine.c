// SPDX-License-Identifier: GPL-3.0-or-later
#include "problem/sampling_engine.h"

const char *const mf_sampling_engine_kinds[] = {"none", "lammps", "command", NULL};

#define MEMBER(name) .offset = offsetof(struct engine_settings, name)
const struct field mf_sampling_engine_fields[] = {
    {"name", FIELD_CHOICE, MEMBER(kind), .choices = mf_sampling_engine_kinds,
     .initial = ENGINE_NONE, .unit = "", .help = "who samples; its command stands after --engine"},
    {"input", FIELD_FILE, MEMBER(input), .unit = "",
     .help = "LAMMPS input with two includes (any-engine.md); none: one is written"},
    {"frames", FIELD_TEXT, MEMBER(frames), .unit = "",
     .help = "trajectory that the command leaves"},
    {"time_step", FIELD_NUMBER, MEMBER(time_step), .initial = 0, .minimum = 0, .maximum = DBL_MAX,
     .unit = "tau", .help = "of a written input; 0: the scene's"},
    {"steps", FIELD_INTEGER, MEMBER(steps), .initial = 10, .minimum = 1, .maximum = 1e9,
     .unit = "steps", .help = "time steps of a sweep"},
    {"at_once", FIELD_INTEGER, MEMBER(at_once), .initial = 0, .minimum = 0, .maximum = 1024,
     .unit = "", .help = "replicas side by side; 0: as --threads"},
    {"keep", FIELD_INTEGER, MEMBER(keep), .initial = 2, .minimum = 1, .maximum = 1e9, .unit = "",
     .help = "pieces of a replica that stay"},
    FIELD_END,
};
