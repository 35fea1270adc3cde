// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_friction.h"

#include <math.h>

static const char *const families[] = {"free", "exportable", "linear", NULL};

const struct field mf_fit_friction_fields[] = {
    {"friction", FIELD_CHOICE, .choices = families, .initial = FIT_FRICTION_FREE, .unit = "",
     .help = "as --friction of fit"},
    FIELD_END,
};

bool mf_fit_friction_take(struct fit_unknown *omega, enum fit_friction family) {
    struct unknown_parameters *said = &omega->said;
    if (family == FIT_FRICTION_FREE)
        return true;
    if (fit_unknown_says(omega, "curve") && said->shape != INVERSE_CURVE_POWER)
        return false;
    said->shape = INVERSE_CURVE_POWER;
    if (!fit_unknown_says(omega, "inner_cutoff"))
        said->inner_cutoff = 0;
    omega->given |=
        mf_fields_bit(omega->fields, "curve") | mf_fields_bit(omega->fields, "inner_cutoff");
    if (isnan(said->fixed[INVERSE_INNER_CUTOFF]))
        said->fixed[INVERSE_INNER_CUTOFF] = 0;
    if (family == FIT_FRICTION_LINEAR && isnan(said->fixed[INVERSE_EXPONENT]))
        said->fixed[INVERSE_EXPONENT] = 1;
    return true;
}
