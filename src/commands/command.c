// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands/command.h"

#include "base/fields.h"
#include "base/memory.h"
#include "base/nearest.h"

#include <errno.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const struct command_option mf_command_common[] = {
    {"-o", "DIR",
     "folder for the results (default: \"out\" beside the input; of measure, compare, import "
     "\"target\", \"compare\", \"imported\")"},
    {"--threads", "N",
     "threads (default: all processors; bench engine: 1); results do not depend on it"},
    {"--seed", "N", "seed, instead of the file's"},
    {"--resume", NULL, "continue an interrupted run in its folder"},
    {"--force", NULL, "replace a fit, an unfinished run, changed files"},
    {"--quiet", NULL, "no progress, warnings alone"},
    {"--help", NULL, "(-h) summary, or a command's"},
    {"--version", NULL, "(-V) version"},
    {NULL, NULL, NULL},
};

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
            options->quiet = RUN_WARNS;
        } else {
            return fail_unknown_option(command, word);
        }
    }
    return STATUS_OK;
}

/// The option of the subcommand that takes a value and whose name begins as this word does.
static const struct command_option *find_longer(const struct command *command, const char *word) {
    for (const struct command_option *own = command->options; own && own->name; own++)
        if (own->value && strncmp(own->name, word, strlen(word)) == 0)
            return own;
    return NULL;
}

/// A number behind an option that takes none was meant for another, unless a file has that name.
static enum status refuse_number(const struct command *command, const char *word,
                                 const char *next) {
    char *end = NULL;
    if (next == NULL || (strtod(next, &end), end == next) || *end || access(next, F_OK) == 0)
        return STATUS_OK;
    const struct command_option *const meant = find_longer(command, word);
    if (meant == NULL)
        return mf_status_fail(STATUS_BAD_INPUT, "%s takes no value, and there is no file %.60s",
                              word, next);
    return mf_status_fail(STATUS_BAD_INPUT, "%s takes no value such as %.60s: did you mean %s%s%s?",
                          word, next, meant->name, meant->value[0] == '[' ? "" : " ", meant->value);
}

static enum status parse_words(const struct command *command, size_t count,
                               const char *const *words, struct command_line *line) {
    for (size_t k = 0; k < count;) {
        int used = 1;
        const char *const next = k + 1 < count ? words[k + 1] : NULL;
        if (words[k][0] != '-')
            line->files[line->file_count++] = words[k];
        else
            TRY(parse_option(command, words[k], next, line, &used));
        if (words[k][0] == '-' && used == 1)
            TRY(refuse_number(command, words[k], next));
        k += (size_t)used;
    }
    return STATUS_OK;
}

enum status mf_command_parse(const struct command *command, size_t count, const char *const *words,
                             struct command_line *line) {
    TRY_ARRAY(line->files, count + 1);
    line->options.threads = command->threads > 0 ? command->threads : omp_get_max_threads();
    TRY(parse_words(command, count, words, line));
    if (line->file_count < command->min_files || line->file_count > command->max_files)
        return mf_status_fail(STATUS_BAD_INPUT, "usage: mesofit %s %s", command->name,
                              command->usage);
    if (line->options.resume && line->options.force)
        return mf_status_fail(STATUS_BAD_INPUT, "--resume and --force exclude each other");
    return STATUS_OK;
}

void mf_command_line_clear(struct command_line *line) {
    mf_memory_free(line->files);
    line->files = NULL;
}

enum status mf_command_find(const struct command *const *list, const char *name,
                            const struct command **command) {
    const char *names[COMMAND_MAX_COMMANDS];
    char hint[256];
    size_t count = 0;
    for (; list[count]; count++) {
        names[count] = list[count]->name;
        if (strcmp(name, names[count]) == 0) {
            *command = list[count];
            return STATUS_OK;
        }
    }
    mf_nearest_hint(name, names, count, hint, sizeof hint);
    return mf_status_fail(STATUS_BAD_INPUT, "unknown command \"%s\"; %s", name, hint);
}

enum status mf_command_check_live(const struct command_line *line, const char *option) {
    return line->live ? STATUS_OK
                      : mf_status_fail(STATUS_BAD_INPUT, "%s is for the program alone", option);
}

enum status mf_command_read_box(const char *text, double box[3]) {
    const char *const given = text;
    int count = 0;
    char *end = NULL;
    if (text == NULL)
        return STATUS_OK;
    for (bool more = true; more && count < 3; count++) {
        box[count] = strtod(text, &end);
        more = end > text && isfinite(box[count]) && box[count] > 0 && *end == ',';
        text = more ? end + 1 : text;
    }
    if (end == text || *end != '\0' || !isfinite(box[count - 1]) || !(box[count - 1] > 0) ||
        count == 2)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "--box takes one length or three, as 4,4,5, not \"%.60s\"", given);
    for (int d = count; d < 3; d++)
        box[d] = box[0];
    return STATUS_OK;
}
