// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/commands.h"

#include "base/version.h"

#include <string.h>

const struct command *const mf_command_list[] = {
    &mf_command_measure, &mf_command_fit, &mf_command_export, &mf_command_simulate,
    &mf_command_import,  &cmd_live,       &cmd_plot,          &cmd_film,
    &cmd_compare,        &cmd_describe,   &cmd_bench,         NULL,
};

_Static_assert(sizeof mf_command_list / sizeof *mf_command_list <= COMMAND_MAX_COMMANDS + 1,
               "more commands than COMMAND_MAX_COMMANDS");

const char mf_command_purpose[] = "fit the pair interactions of a coarse liquid to measurements";

const char mf_command_exit_codes[] =
    "0 done, or stopped by SIGTERM or SIGUSR1; 1 not converged or unstable; 2 bad input, files or "
    "options; 3 out of memory; 130 interrupted";

const char *mf_command_option_text(const struct command_option *option,
                                   char text[COMMAND_OPTION_SIZE]) {
    const bool apart = option->value && option->value[0] != '[';
    snprintf(text, COMMAND_OPTION_SIZE, "%s%s%s", option->name, apart ? " " : "",
             option->value ? option->value : "");
    return text;
}

static void print_options(const struct command_option *option) {
    char text[COMMAND_OPTION_SIZE];
    for (; option && option->name; option++)
        printf("  %-16s  %s\n", mf_command_option_text(option, text), option->help);
}

void mf_command_print_first(void) {
    printf(
        "mesofit %s: %s\n\nfrom a trajectory to a potential in your engine:\n"
        "  mesofit measure traj.xtc -s conf.gro --temperature 298 -o target\n"
        "  mesofit fit --target target -o fit\n"
        "  mesofit export fit --engine lammps -o lammps\n\n"
        "`mesofit --help` lists all commands and options, `mesofit COMMAND --help` those of one.\n",
        mf_version, mf_command_purpose);
}

void mf_command_print_help(void) {
    printf("mesofit %s: %s\n\nusage:\n", mf_version, mf_command_purpose);
    for (const struct command *const *command = mf_command_list; *command; command++)
        printf("  mesofit %-9s %-22s  %s\n", (*command)->name, (*command)->usage,
               (*command)->summary);
    printf("\noptions:\n");
    print_options(mf_command_common);
    for (const struct command *const *command = mf_command_list; *command; command++) {
        if ((*command)->options)
            printf("\noptions of %s:\n", (*command)->name);
        print_options((*command)->options);
    }
    printf("\nexit code: %s\n", mf_command_exit_codes);
}

void mf_command_print_own_help(const struct command *command) {
    printf("mesofit %s %s: %s\n\n", command->name, command->usage, command->summary);
    if (command->options) {
        printf("options of %s:\n", command->name);
        print_options(command->options);
        printf("\n");
    }
    printf("options of all commands:\n");
    print_options(mf_command_common);
    printf("\nexit code: %s\n", mf_command_exit_codes);
}
