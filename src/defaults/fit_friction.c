// SPDX-License-Identifier: GPL-3.0-or-later
#include "defaults/fit_friction.h"

#include "defaults/fit_choice.h"

#include <string.h>

static const char *const families[] = {"free", "exportable", "linear", NULL};

const struct field mf_fit_friction_fields[] = {
    {"friction", FIELD_CHOICE, .choices = families, .initial = FIT_FRICTION_FREE, .unit = "",
     .help = "as --friction of fit"},
    FIELD_END,
};

static const char path[] = "unknowns.omega", fixed[] = "unknowns.omega.fixed";

static enum status put_number(const struct json_object *root, const char *where, const char *key,
                              double value) {
    return mf_fit_choice_lacks(root, where, key)
               ? mf_fit_choice_give_number(root, where, key, value)
               : STATUS_OK;
}

/// Without a curve of the file's own, or with the same.
static bool has_other_curve(const struct json_object *root) {
    struct json_object omega = mf_fit_choice_object(root, path);
    const char *curve =
        mf_json_has(&omega, "curve") ? mf_json_choice(&omega, "curve", NULL, "") : NULL;
    if (curve == NULL || strcmp(curve, "power") == 0)
        return false;
    mf_json_fault(&omega, "curve",
                  "\"%s\" is not the power law that \"friction\" asks for: leave "
                  "one of them out",
                  curve);
    return true;
}

enum status mf_fit_friction_put(struct json_object *root, bool *changed) {
    struct json_object own = *root; // looks, and asks for nothing
    int family;
    *changed = false;
    mf_json_fields(&own, mf_fit_friction_fields, &family);
    if (family == FIT_FRICTION_FREE || !mf_json_has(&own, "unknowns"))
        return STATUS_OK;
    const struct json_object unknowns = mf_fit_choice_object(root, "unknowns");
    if (!mf_json_is_object(&unknowns, "omega")) {
        mf_json_fault(&own, "friction", "there is no \"omega\" among the \"unknowns\"");
        return STATUS_OK;
    }
    if (has_other_curve(root))
        return STATUS_OK;
    *changed = true;
    if (mf_fit_choice_lacks(root, path, "curve"))
        TRY(mf_fit_choice_give_text(root, path, "curve", "power"));
    TRY(put_number(root, path, "inner_cutoff", 0));
    TRY(put_number(root, fixed, "inner_cutoff", 0));
    return family == FIT_FRICTION_LINEAR ? put_number(root, fixed, "exponent", 1) : STATUS_OK;
}
