// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command.h"

#include "base/interrupt.h"
#include "base/memory.h"
#include "base/nearest.h"
#include "base/ranks.h"
#include "base/fields.h"
#include "base/terminal.h"
#include "mesofit.h"
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

/// A whole number from `min` to `max`.
static enum status parse_number(const char *option, const char *text, uint64_t min, uint64_t max,
                                uint64_t *number) {
    char *end = NULL;
    errno = 0;
    *number = text ? strtoull(text, &end, 10) : 0;
    if (text == NULL || end == text || *end != '\0' || errno || *text == '-' || *number < min ||
        *number > max)
        return mf_status_fail(STATUS_BAD_INPUT, "%s takes a whole number from %llu to %llu", option,
                              (unsigned long long)min, (unsigned long long)max);
    return STATUS_OK;
}

/// Whether a word can be the value of an option: another option cannot, a number below 0 can, of
/// which the option says whether it will do.
static bool is_value(const char *word) {
    return word && *word && (*word != '-' || strchr("0123456789.", word[1] ? word[1] : '-'));
}

/// An option of the subcommand itself, if `word` is one: *used is then how many words it took.
static enum status parse_own_option(const struct command *command, const char *word,
                                    const char *value, struct command_line *line, int *used) {
    for (size_t k = 0; command->options && command->options[k].name; k++) {
        const struct command_option *own = &command->options[k];
        const size_t length = strlen(own->name);
        const bool joins = own->value && own->value[0] == '[';
        if (strcmp(word, own->name) != 0 &&
            !(joins && strncmp(word, own->name, length) == 0 && word[length] == '='))
            continue;
        if (joins) {
            line->own[k] = word[length] ? word + length + 1 : own->name;
            *used = 1;
            return STATUS_OK;
        }
        if (own->value && !is_value(value))
            return mf_status_fail(STATUS_BAD_INPUT, "%s takes %s", word, own->value);
        line->own[k] = own->value ? value : own->name;
        *used = own->value ? 2 : 1;
        return STATUS_OK;
    }
    return STATUS_OK;
}

static enum status fail_unknown_option(const struct command *command, const char *word) {
    const char *known[16 + COMMAND_MAX_OPTIONS];
    size_t count = 0;
    for (const struct command_option *common = mf_command_common; common->name; common++)
        known[count++] = common->name;
    for (const struct command_option *own = command->options; own && own->name; own++)
        if (strcmp(own->name, "-o") != 0)
            known[count++] = own->name;
    char hint[256];
    mf_nearest_hint(word, known, count, hint, sizeof hint);
    return mf_status_fail(STATUS_BAD_INPUT, "unknown option %s; %s", word, hint);
}

/// One option with its value, if it takes one; *used is how many words it took.
static enum status parse_option(const struct command *command, const char *word, const char *value,
                                struct command_line *line, int *used) {
    struct run_options *options = &line->options;
    uint64_t number;
    *used = 0;
    TRY(parse_own_option(command, word, value, line, used));
    if (*used > 0)
        return STATUS_OK;
    *used = 2;
    if (strcmp(word, "-o") == 0) {
        if (value == NULL || *value == '\0' || *value == '-')
            return mf_status_fail(STATUS_BAD_INPUT, "-o takes a folder");
        options->folder = value;
    } else if (strcmp(word, "--threads") == 0) {
        TRY(parse_number(word, value, 1, 1024, &number));
        options->threads = (int)number;
        options->has_threads = true;
    } else if (strcmp(word, "--seed") == 0) {
        TRY(parse_number(word, value, 0, (uint64_t)FIELD_LARGEST_INTEGER - 1, &options->seed));
        options->has_seed = true;
    } else {
        *used = 1;
        if (strcmp(word, "--resume") == 0) {
            options->resume = true;
        } else if (strcmp(word, "--force") == 0) {
            options->force = true;
        } else if (strcmp(word, "--quiet") == 0) {
            options->quiet = true;
        } else {
            return fail_unknown_option(command, word);
        }
    }
    return STATUS_OK;
}

static enum status parse_line(const struct command *command, int count, char **words,
                              struct command_line *line) {
    line->options.threads = command->threads > 0 ? command->threads : omp_get_max_threads();
    for (int k = 0; k < count;) {
        int used = 1;
        if (words[k][0] == '-')
            TRY(parse_option(command, words[k], k + 1 < count ? words[k + 1] : NULL, line, &used));
        else if (line->file_count == COMMAND_MAX_FILES)
            return mf_status_fail(STATUS_BAD_INPUT, "more than %d files", COMMAND_MAX_FILES);
        else
            line->files[line->file_count++] = words[k];
        k += used;
    }
    return STATUS_OK;
}

static enum status find_command(const char *name, const struct command **command) {
    const char *names[COMMAND_MAX_COMMANDS];
    char hint[256];
    size_t count = 0;
    for (; mf_command_list[count]; count++) {
        names[count] = mf_command_list[count]->name;
        if (strcmp(name, names[count]) == 0) {
            *command = mf_command_list[count];
            return STATUS_OK;
        }
    }
    if (strcmp(name, "watch") == 0)
        return mf_status_fail(STATUS_BAD_INPUT, "the command \"watch\" was removed: use mesofit "
                                                "live, or progress.json in the run's folder");
    mf_nearest_hint(name, names, count, hint, sizeof hint);
    return mf_status_fail(STATUS_BAD_INPUT, "unknown command \"%s\"; %s", name, hint);
}

static enum status run(int count, char **words) {
    const struct command *command = NULL;
    struct command_line line = {0};
    TRY(find_command(words[0], &command));
    TRY(parse_line(command, count - 1, words + 1, &line));
    if (line.file_count < command->min_files || line.file_count > command->max_files)
        return mf_status_fail(STATUS_BAD_INPUT, "usage: mesofit %s %s", command->name,
                              command->usage);
    if (line.options.resume && line.options.force)
        return mf_status_fail(STATUS_BAD_INPUT, "--resume and --force exclude each other");
    return command->run(&line);
}

static bool asks_for(int count, char **words, const char *option) {
    for (int k = 1; k < count; k++)
        if (strcmp(words[k], option) == 0)
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

/// That of a command if the first word is one, else that of all.
static enum status print_help(const char *word) {
    for (size_t k = 0; mf_command_list[k]; k++)
        if (strcmp(word, mf_command_list[k]->name) == 0) {
            mf_command_print_own_help(mf_command_list[k]);
            return STATUS_OK;
        }
    mf_command_print_help();
    return STATUS_OK;
}

static enum status act(int count, char **words) {
    if (asks_for(count, words, "--help"))
        return print_help(words[1]);
    if (asks_for(count, words, "--version")) {
        printf("mesofit " MESOFIT_VERSION "\n");
        return STATUS_OK;
    }
    if (count < 2) {
        mf_command_print_help();
        return mf_status_fail(STATUS_BAD_INPUT, "give one of these commands");
    }
    mf_program_begin_again(words);
    return run(count - 1, words + 1);
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
