// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/cmd_describe.h"

#include "app/commands.h"
#include "app/completion.h"
#include "app/reference.h"
#include "app/schema.h"
#include "base/nearest.h"

#include <string.h>

enum { FORMAT };

static const struct command_option options[] = {
    [FORMAT] = {"--format", "man|markdown|bash|schema",
                "the reference as man page, Markdown, bash completions, JSON Schema"},
    {NULL, NULL, NULL},
};

static void print_index(const struct topic *topics, size_t count) {
    const char *group = "";
    for (size_t k = 0; k < count; k++) {
        if (strcmp(group, topics[k].group) != 0)
            printf("%s%s\n", k ? "\n" : "", topics[k].group);
        group = topics[k].group;
        printf("  %-16s %s\n", topics[k].name, topics[k].summary);
    }
    printf("\n`mesofit describe NAME` lists the numbers of one of them, or of a whole group.\n");
}

static void print_objects(const char *topic) {
    struct topic_object objects[DESCRIBE_MAX_OBJECTS];
    const size_t count = mf_describe_objects(topic, objects);
    for (size_t k = 0; k < count; k++) {
        printf("  %-24s %s\n", objects[k].key, objects[k].help);
        printf("  %-24s   object, see `mesofit describe %s`\n", "", objects[k].topic);
    }
}

static void print_topic(const struct topic *topic) {
    printf("%s (%s): %s\n", topic->name, topic->group, topic->summary);
    for (size_t t = 0; topic->tables[t]; t++)
        mf_fields_describe(topic->tables[t], stdout);
    print_objects(topic->name);
}

/// The topics of that name, and all of a group of that name; false if there is none.
static bool print_named(const struct topic *topics, size_t count, const char *name) {
    bool found = false;
    char target[64];
    for (size_t k = 0; k < count; k++)
        if (strcmp(topics[k].group, name) == 0 || strcmp(topics[k].name, name) == 0) {
            printf("%s", found ? "\n" : "");
            print_topic(&topics[k]);
            found = true;
        }
    // What is measured in a simulation may be a target, too, of which a run file says other things.
    snprintf(target, sizeof target, "%s-target", name);
    for (size_t k = 0; found && k < count; k++)
        if (strcmp(topics[k].name, target) == 0)
            printf("\nIn \"target\" of a run file \"%s\" is another object, see `mesofit describe "
                   "%s`.\n",
                   name, target);
    return found;
}

/// The whole reference, as `format` wants it.
static enum status print_all(const char *format, const struct topic *topics, size_t count) {
    static const char *const formats[] = {"man", "markdown", "bash", "schema"};
    char hint[128];
    if (strcmp(format, formats[0]) == 0)
        mf_reference_print_man(stdout, topics, count);
    else if (strcmp(format, formats[1]) == 0)
        mf_reference_print_markdown(stdout, topics, count);
    else if (strcmp(format, formats[2]) == 0)
        mf_completion_print(stdout, topics, count);
    else if (strcmp(format, formats[3]) == 0)
        return mf_schema_print(stdout, topics, count);
    else {
        mf_nearest_hint(format, formats, 4, hint, sizeof hint);
        return mf_status_fail(STATUS_BAD_INPUT, "describe: unknown format \"%s\"; %s", format,
                              hint);
    }
    return STATUS_OK;
}

/// The topic that says which command it is for.
static const char *find_of_command(const struct topic *topics, size_t count, const char *command) {
    char words[64];
    snprintf(words, sizeof words, "`mesofit %.32s`", command);
    for (size_t k = 0; k < count; k++)
        if (strstr(topics[k].summary, words))
            return topics[k].name;
    return NULL;
}

static enum status run(const struct command_line *line) {
    struct topic topics[DESCRIBE_MAX_TOPICS];
    const char *names[DESCRIBE_MAX_TOPICS];
    const size_t count = mf_describe_topics(topics);
    if (line->own[FORMAT] && line->file_count > 0)
        return mf_status_fail(STATUS_BAD_INPUT, "describe --format prints all, and takes no NAME");
    if (line->own[FORMAT])
        return print_all(line->own[FORMAT], topics, count);
    if (line->file_count == 0) {
        print_index(topics, count);
        return STATUS_OK;
    }
    if (print_named(topics, count, line->files[0]))
        return STATUS_OK;
    for (size_t k = 0; k < count; k++)
        names[k] = topics[k].name;
    const char *nearest = find_of_command(topics, count, line->files[0]);
    if (nearest == NULL)
        nearest = mf_nearest_name(line->files[0], names, count);
    return nearest
               ? mf_status_fail(STATUS_BAD_INPUT,
                                "describe: \"%s\" is not known; did you mean \"%s\"?",
                                line->files[0], nearest)
               : mf_status_fail(
                     STATUS_BAD_INPUT,
                     "describe: \"%s\" is not known; `mesofit describe` without a name lists all",
                     line->files[0]);
}

const struct command cmd_describe = {
    .name = "describe",
    .usage = "[NAME]",
    .summary = "list keys of files, units, defaults, ranges",
    .min_files = 0,
    .max_files = 1,
    .options = options,
    .run = run,
};
