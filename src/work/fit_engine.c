// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/fit_engine.h"

#include "base/interrupt.h"
#include "work/fit_print.h"

enum status mf_fit_engine_expect(const struct fit_file *fit, const struct engine_door *door) {
    if (fit->engine.kind == ENGINE_NONE && door && door->command)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "--engine: the run file has no \"engine\" that says what the "
                              "command is: {\"name\": \"lammps\"} or \"command\"");
    return STATUS_OK;
}

enum status mf_fit_engine_open(struct fit_file *fit, const struct engine_door *door,
                               const char *folder, bool resume) {
    TRY(mf_fit_engine_expect(fit, door));
    if (fit->engine.kind == ENGINE_NONE)
        return STATUS_OK;
    if (door == NULL || door->command == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "engine: its command stands on the command line, as a run file "
                              "starts nothing: mesofit fit ... --engine \"COMMAND\"");
    return door->open(door->command, fit, folder, resume, &fit->problem.engine);
}

bool mf_fit_engine_waits(const struct fit_file *fit, const struct engine_door *door) {
    char text[STATUS_MESSAGE_SIZE / 2];
    if (fit->problem.engine == NULL || !door->waits(fit->problem.engine, text, sizeof text))
        return false;
    mf_interrupt_plan();
    (void)mf_status_fail(STATUS_INTERRUPTED, "%s", text);
    return true;
}

enum status mf_fit_engine_print_targets(struct progress *to, const struct fit_file *fit,
                                        bool resume) {
    const struct sampling_engine *engine = fit->problem.engine;
    return resume && engine && engine->announce ? STATUS_OK : mf_fit_print_targets(to, fit);
}

void mf_fit_engine_close(struct fit_file *fit, const struct engine_door *door) {
    if (door)
        door->close(fit->problem.engine);
    fit->problem.engine = NULL;
}
