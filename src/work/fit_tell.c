// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/fit_tell.h"

#include "input/target_sanity.h"

static void say_line(void *progress, const char *line) {
    mf_progress_say(progress, "%s", line);
}

static enum status tell_state(struct progress *to, const struct fit_file *fit) {
    const struct target_etd *etd = &fit->files.etd;
    const char *warning = mf_scene_warning(&fit->scene);
    if (fit->name[0])
        mf_progress_say(to, "state \"%s\":", fit->name);
    if (warning)
        mf_progress_say(to, "mesofit: warning: scene: %s", warning);
    for (size_t k = 0; k < fit->choices.count; k++)
        mf_progress_say(to, "chosen: %s", fit->choices.line[k]);
    if (etd->left_out > 0)
        mf_progress_say(to, "target.etd: %zu of %zu cells of the target are not known and left out",
                        etd->left_out, (size_t)(etd->grid.times * etd->grid.bins));
    return mf_target_sanity_tell(&fit->files, &fit->scene,
                                 &(struct target_sanity_listener){say_line, to});
}

const char *mf_fit_tell_timing(const struct fit_file *fit) {
    const struct inverse_method *method = fit->method;
    if (!method->depends_on_timing || !method->depends_on_timing(method, fit->method_parameters))
        return NULL;
    return "\"asynchronous\": results depend on timing; they are not the same bits from run to "
           "run, "
           "nor after --resume";
}

enum status mf_fit_tell_targets(struct progress *to, const struct fit_file *fit) {
    const char *timing = mf_fit_tell_timing(fit);
    mf_progress_say_scale(to, &fit->scene.units);
    if (timing)
        mf_progress_say(to, "%s", timing);
    TRY(tell_state(to, fit));
    for (size_t s = 0; s < fit->others; s++)
        TRY(tell_state(to, &fit->other[s]));
    return STATUS_OK;
}
