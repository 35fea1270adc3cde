// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/sample_fields.h"

const char *const sample_kinds[] = {"soft", "hard", NULL};

const struct field sample_fields[] = {
    {"strength", FIELD_NUMBER, offsetof(struct sample, strength), false, 0.1, 0, 1, NULL, "k_B T",
     "how strong"},
    {"steps", FIELD_INTEGER, offsetof(struct sample, steps), false, 5, 1, FIELD_LARGEST_INTEGER,
     NULL, "", "a count"},
    {"seed", FIELD_SEED, offsetof(struct sample, seed), false, 42, 0, 0, NULL, "", "a seed"},
    {"lengths", FIELD_LENGTHS, offsetof(struct sample, lengths), false, 0, FIELD_ABOVE_ZERO,
     DBL_MAX, NULL, "", "box"},
    {"name", FIELD_TEXT, offsetof(struct sample, name), false, 0, 0, 0, NULL, "", "a name"},
    {"file", FIELD_FILE, offsetof(struct sample, file), false, 0, 0, 0, NULL, "", "a file"},
    {"kind", FIELD_CHOICE, offsetof(struct sample, kind), false, 1, 0, 0, sample_kinds, "",
     "a kind"},
    {"kinds", FIELD_CHOICES, offsetof(struct sample, kinds), false, 2, 0, 0, sample_kinds, "",
     "a set of them"},
    FIELD_END,
};
