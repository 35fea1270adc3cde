// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands/command.h"
#include "import/import_votca.h"

#include <string.h>

enum { BOX, COUNT };

static const struct command_option options[] = {
    [BOX] = {"--box", "LX,LY,LZ", "box [nm], without conf.gro"},
    [COUNT] = {"--count", "A=N,B=M", "beads of types, without topol.top and conf.gro"},
    {NULL, NULL, NULL},
};

static enum status run(const struct command_line *line) {
    struct progress progress = mf_progress_begin(line->options.quiet, line->options.watcher);
    struct import_request request = {.file = line->files[1],
                                     .folder =
                                         line->options.folder ? line->options.folder : "imported",
                                     .options.count = line->own[COUNT],
                                     .force = line->options.force,
                                     .progress = &progress};
    if (strcmp(line->files[0], "votca") != 0)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "import: \"%.60s\" is no program whose settings are read: votca is",
                              line->files[0]);
    TRY(mf_command_read_box(line->own[BOX], request.options.box));
    return mf_import_votca(&request);
}

const struct command mf_command_import = {
    .name = "import",
    .usage = "votca SETTINGS.xml",
    .summary = "make a run file of settings",
    .min_files = 2,
    .max_files = 2,
    .options = options,
    .run = run,
};
