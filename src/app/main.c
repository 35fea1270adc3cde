// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/commands.h"

#include "base/interrupt.h"
#include "base/memory.h"
#include "base/nearest.h"
#include "base/ranks.h"
#include "base/fields.h"
#include "base/terminal.h"
#include "base/version.h"
#include "report/program.h"

#include <errno.h>
#include <fcntl.h>
#include <gsl/gsl_errno.h>
#include <omp.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int exit_code(enum status status) {
    switch (status) {
    case STATUS_OK:
        return 0;
    case STATUS_UNSTABLE:
    case STATUS_UNCONVERGED:
        return 1;
    case STATUS_BAD_INPUT:
    case STATUS_IO:
        return 2;
    case STATUS_NO_MEMORY:
        return 3;
    case STATUS_INTERRUPTED:
        return mf_interrupt_was_planned() ? 0 : 130;
    }
    return 1;
}

static enum status run(size_t count, const char *const *words) {
    const struct command *command = NULL;
    CLEARED_BY(mf_command_line_clear) struct command_line line = {.live = mf_cmd_live_run};
    if (strcmp(words[0], "watch") == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "the command \"watch\" was removed: use mesofit "
                                                "live, or progress.json in the run's folder");
    TRY(mf_command_find(mf_command_list, words[0], &command));
    TRY(mf_command_parse(command, count - 1, words + 1, &line));
    return command->run(&line);
}

/// Whether a word is the option, or its letter.
static bool asks_for(int count, char **words, const char *option, const char *letter) {
    for (int k = 1; k < count; k++)
        if (strcmp(words[k], option) == 0 || strcmp(words[k], letter) == 0)
            return true;
    return false;
}

/// Errors come back as statuses, not as signals or aborts.
static void install_handlers(void) {
    gsl_set_error_handler_off();
    signal(SIGXFSZ, SIG_IGN); // a write beyond the file size limit fails like a full disk
    mf_interrupt_install();
}

/// A file that is opened must not become what a closed stream was: what is said would go into it.
static void occupy_streams(void) {
    int file = STDIN_FILENO;
    while (file >= STDIN_FILENO && file <= STDERR_FILENO)
        file = open("/dev/null", O_RDONLY);
    if (file > STDERR_FILENO)
        close(file);
}

/// What was printed has arrived, or there is an error to tell of. A reader who has gone, such as
/// `head`, ends this program without a word, as it ends others.
static enum status finish_output(enum status status) {
    errno = 0;
    const int error = fflush(stdout) == 0 ? 0 : errno;
    if (error == EPIPE) {
        signal(SIGPIPE, SIG_DFL);
        raise(SIGPIPE);
    }
    if (status != STATUS_OK || (error == 0 && !ferror(stdout)))
        return status;
    return mf_status_fail(STATUS_IO, "cannot write to stdout: %s",
                          error ? strerror(error) : "not all of it has arrived");
}

/// That of a command if the word is one, else that of all.
static enum status print_help(const char *word) {
    for (size_t k = 0; mf_command_list[k]; k++)
        if (strcmp(word, mf_command_list[k]->name) == 0) {
            mf_command_print_own_help(mf_command_list[k]);
            return STATUS_OK;
        }
    mf_command_print_help();
    return STATUS_OK;
}

/// "help", or "help fit", as others have it.
static enum status help(int count, char **words) {
    const struct command *command = NULL;
    if (count > 2)
        TRY(mf_command_find(mf_command_list, words[2], &command));
    return print_help(count > 2 ? words[2] : "");
}

static enum status act(int count, char **words) {
    if (asks_for(count, words, "--help", "-h"))
        return print_help(words[1]);
    if (count > 1 && strcmp(words[1], "help") == 0)
        return help(count, words);
    if (asks_for(count, words, "--version", "-V")) {
        printf("mesofit %s\n", mf_version);
        return STATUS_OK;
    }
    if (count < 2) {
        mf_command_print_first();
        return mf_status_fail(STATUS_BAD_INPUT, "give a command");
    }
    mf_program_begin_again(words);
    return run((size_t)count - 1, (const char *const *)words + 1);
}

int main(int count, char **words) {
    occupy_streams();
    install_handlers();
    mf_memory_keep();
    const enum status begun = mf_terminal_begin();
    const enum status status = finish_output(begun == STATUS_OK ? act(count, words) : begun);
    if (!ranks_lead())
        return 0; // rank 0 speaks for all
    if (status != STATUS_OK)
        fprintf(stderr, "mesofit: %s\n", mf_status_message());
    return exit_code(status);
}
