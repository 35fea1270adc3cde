// SPDX-License-Identifier: GPL-3.0-or-later
#include "work/fit_engine.h"

enum status mf_fit_engine_open(struct fit_file *fit, const struct engine_door *door,
                               const char *folder) {
    const bool named = door && door->command;
    if (fit->engine.kind == ENGINE_NONE)
        return named ? mf_status_fail(STATUS_BAD_INPUT,
                                      "--engine: the run file has no \"engine\" that says what the "
                                      "command is: {\"name\": \"lammps\"} or \"command\"")
                     : STATUS_OK;
    if (!named)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "engine: its command stands on the command line, as a run file "
                              "starts nothing: mesofit fit ... --engine \"COMMAND\"");
    return door->open(door->command, fit, folder, &fit->problem.engine);
}

void mf_fit_engine_close(struct fit_file *fit, const struct engine_door *door) {
    if (door)
        door->close(fit->problem.engine);
    fit->problem.engine = NULL;
}
