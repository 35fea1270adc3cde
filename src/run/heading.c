// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/heading.h"

#define MEMBER(name) .offset = offsetof(struct heading, name)
const struct field heading_fields[] = {
    {"title", FIELD_TEXT, MEMBER(title), .unit = "", .help = "one line for people"},
    {"seed", FIELD_SEED, MEMBER(seed), .initial = 1, .minimum = 0, .maximum = FIELD_LARGEST_INTEGER,
     .unit = "", .help = "of all random numbers"},
    FIELD_END,
};
