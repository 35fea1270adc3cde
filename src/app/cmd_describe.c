// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/cmd_describe.h"

#include "app/commands.h"
#include "base/nearest.h"

#include <stdio.h>
#include <string.h>

// Completions of a command line in bash -----------------------------------------------------------

/// What the words are chosen from: see `_mesofit_words` below.
static const char *kind_of(const char *value) {
    if (strstr(value, "FILE"))
        return "files";
    if (strstr(value, "SCENE") || strstr(value, ".json"))
        return "json";
    return strstr(value, "DIR") ? "folders" : "nothing";
}

/// "a|b" up to a blank, with blanks between.
static void write_choices(FILE *stream, const char *value) {
    for (; *value && *value != ' '; value++)
        fputc(*value == '|' ? ' ' : *value, stream);
}

static void write_option_values(FILE *stream, const char *verb,
                                const struct command_option *option) {
    for (; option && option->name; option++) {
        if (option->value == NULL || option->value[0] == '[')
            continue;
        fprintf(stream, "    %s:%s) ", verb, option->name);
        if (strchr(option->value, '|')) {
            fprintf(stream, "choices=\"");
            write_choices(stream, option->value);
            fprintf(stream, "\" ;;\n");
        } else {
            fprintf(stream, "kind=%s ;;\n", kind_of(option->value));
        }
    }
}

static void write_names(FILE *stream, const struct command_option *option) {
    for (; option && option->name; option++)
        fprintf(stream, " %s", option->name);
}

static bool is_name(const struct topic *topics, size_t count, const char *name) {
    for (size_t k = 0; k < count; k++)
        if (strcmp(topics[k].name, name) == 0)
            return true;
    return false;
}

static bool is_group(const struct topic *topics, size_t count, const char *name) {
    for (size_t k = 0; k < count; k++)
        if (strcmp(topics[k].group, name) == 0)
            return true;
    return false;
}

/// Every name that `describe` knows, of topics and of groups, once.
static void write_topics(FILE *stream, const struct topic *topics, size_t count) {
    for (size_t k = 0; k < count; k++) {
        const char *group = topics[k].group, *name = topics[k].name;
        if (!is_group(topics, k, group) && !is_name(topics, count, group))
            fprintf(stream, " %s", group);
        if (!is_name(topics, k, name))
            fprintf(stream, " %s", name);
    }
}

/// What a subcommand takes beside options; the folders that are read are those of runs.
static void write_command(FILE *stream, const struct command *command, const struct topic *topics,
                          size_t count) {
    fprintf(stream, "        %s)", command->name);
    if (command->options) {
        fprintf(stream, " options=\"$options");
        write_names(stream, command->options);
        fprintf(stream, "\"");
    }
    if (strcmp(command->usage, cmd_describe.usage) == 0) {
        fprintf(stream, " choices=\"");
        write_topics(stream, topics, count);
        fprintf(stream, "\"");
    } else if (strchr(command->usage, '|')) {
        fprintf(stream, " choices=\"");
        write_choices(stream, command->usage);
        fprintf(stream, "\"");
    }
    fprintf(stream, " kind=%s ;;\n",
            strstr(command->usage, "DIR") ? "runs" : kind_of(command->usage));
}

static const char helpers[] =
    "# Folders of runs, and those that have folders in which there may be some.\n"
    "_mesofit_runs() {\n"
    "    local folder\n"
    "    compgen -d -- \"$1\" | while IFS= read -r folder; do\n"
    "        if [ -e \"$folder/summary.json\" ] || compgen -d -- \"$folder/\" >/dev/null; then\n"
    "            printf '%s\\n' \"$folder\"\n"
    "        fi\n"
    "    done\n"
    "}\n"
    "\n"
    "# _mesofit_words WORD KIND CHOICES: how WORD may go on.\n"
    "_mesofit_words() {\n"
    "    compgen -W \"$3\" -- \"$1\"\n"
    "    case $2 in\n"
    "    runs) _mesofit_runs \"$1\" ;;\n"
    "    folders) compgen -d -- \"$1\" ;;\n"
    "    files) compgen -f -- \"$1\" ;;\n"
    "    json) compgen -d -- \"$1\"; compgen -f -X '!*.json' -- \"$1\" ;;\n"
    "    esac\n"
    "}\n"
    "\n";

static const char ending[] =
    "    [[ $word != -* ]] || kind=nothing choices=$options\n"
    "    mapfile -t COMPREPLY < <(_mesofit_words \"$word\" \"$kind\" \"$choices\")\n"
    "    # Folders end with a slash and names with blanks are quoted, if bash is asking.\n"
    "    [ \"$kind\" = nothing ] || compopt -o filenames 2>/dev/null\n"
    "    return 0\n"
    "}\n"
    "\n"
    "complete -F _mesofit mesofit\n";

/// Print the script that bash loads.
static void print(FILE *stream, const struct topic *topics, size_t count) {
    fprintf(stream,
            "# SPDX-License-Identifier: GPL-3.0-or-later\n"
            "# Completions of bash for mesofit, by `mesofit describe --format bash`.\n\n%s"
            "_mesofit() {\n"
            "    local word=${COMP_WORDS[COMP_CWORD]} verb=${COMP_WORDS[1]}\n"
            "    local kind=nothing choices=\n"
            "    local options=\"",
            helpers);
    write_names(stream, mf_command_common);
    fprintf(stream, "\"\n    [ \"$COMP_CWORD\" -gt 1 ] || verb=\n"
                    "    case $verb:${COMP_WORDS[COMP_CWORD - 1]} in\n    :*) choices=\"");
    for (size_t k = 0; mf_command_list[k]; k++)
        fprintf(stream, " %s", mf_command_list[k]->name);
    fprintf(stream, "\" ;;\n");
    for (size_t k = 0; mf_command_list[k]; k++)
        write_option_values(stream, mf_command_list[k]->name, mf_command_list[k]->options);
    write_option_values(stream, "*", mf_command_common);
    fprintf(stream, "    *)\n        case $verb in\n");
    for (size_t k = 0; mf_command_list[k]; k++)
        write_command(stream, mf_command_list[k], topics, count);
    fprintf(stream, "        esac\n        ;;\n    esac\n%s", ending);
}

// The subcommand ----------------------------------------------------------------------------------

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

static bool is_named(const struct topic *topic, const char *name) {
    return strcmp(topic->group, name) == 0 || strcmp(topic->name, name) == 0;
}

/// The topics of that name, and all of a group of that name; false if there is none.
static bool print_named(const struct topic *topics, size_t count, const char *name) {
    bool found = false;
    char target[80];
    for (size_t k = 0; k < count; k++)
        if (is_named(&topics[k], name)) {
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

/// The topic or group of an object by its path, "rdf-target" of "run.target.rdf"; false if there is
/// none.
static bool find_object(const struct topic *topics, size_t count, const char *path, char name[64]) {
    struct topic_object objects[DESCRIBE_MAX_OBJECTS];
    char outer[256], home[64];
    const char *const dot = strrchr(path, '.');
    snprintf(name, 64, "%s", path);
    if (dot == NULL)
        return true;
    snprintf(outer, sizeof outer, "%.*s", (int)(dot - path), path);
    if (!find_object(topics, count, outer, home))
        return false;
    for (size_t k = 0; k < count; k++) {
        const size_t own =
            is_named(&topics[k], home) ? mf_describe_objects(topics[k].name, objects) : 0;
        for (size_t o = 0; o < own; o++)
            if (strcmp(objects[o].key, dot + 1) == 0) {
                snprintf(name, 64, "%s", objects[o].topic);
                return true;
            }
    }
    return false;
}

/// The number at the end of a path, "scene.box", of each topic that has it; false if there is none.
static bool print_field(const struct topic *topics, size_t count, const char *path) {
    bool found = false;
    char outer[256], home[64];
    const char *const dot = strrchr(path, '.');
    if (dot == NULL)
        return false;
    snprintf(outer, sizeof outer, "%.*s", (int)(dot - path), path);
    if (!find_object(topics, count, outer, home))
        return false;
    for (size_t k = 0; k < count; k++)
        for (size_t t = 0; is_named(&topics[k], home) && topics[k].tables[t]; t++)
            for (const struct field *field = topics[k].tables[t]; field->name; field++)
                if (strcmp(field->name, dot + 1) == 0) {
                    const struct field alone[] = {*field, FIELD_END};
                    printf("%s (%s)\n", topics[k].name, topics[k].group);
                    mf_fields_describe(alone, stdout);
                    found = true;
                }
    return found;
}

/// The names from which "name" chooses, of "method.name" and "weight.name"; false if the path is
/// another.
static bool print_choices(const struct topic *topics, size_t count, const char *path) {
    char outer[256], home[64];
    const char *const dot = strrchr(path, '.');
    if (dot == NULL || strcmp(dot, ".name") != 0)
        return false;
    snprintf(outer, sizeof outer, "%.*s", (int)(dot - path), path);
    if (!find_object(topics, count, outer, home) ||
        (strcmp(home, "method") != 0 && strcmp(home, "weight") != 0))
        return false;
    printf("name (%s): one of\n", home);
    for (size_t k = 0; k < count; k++)
        if (strcmp(topics[k].group, home) == 0)
            printf("  %-16s %s\n", topics[k].name, topics[k].summary);
    return true;
}

/// What stands at a path, a number or an object; false if there is nothing.
static bool print_path(const struct topic *topics, size_t count, const char *path) {
    char name[64];
    return print_field(topics, count, path) || print_choices(topics, count, path) ||
           (find_object(topics, count, path, name) && print_named(topics, count, name));
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
        print(stdout, topics, count);
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

static bool has_key(const struct topic *topic, const char *key) {
    for (size_t t = 0; topic->tables[t]; t++)
        for (const struct field *field = topic->tables[t]; field->name; field++)
            if (strcmp(field->name, key) == 0)
                return true;
    return false;
}

/// What to describe instead of a key, "molecule" of "molecules", "measure", "motion", … of "every",
/// into `text`; false if no object has that key.
static bool find_key(const struct topic *topics, size_t count, const char *key, char *text,
                     size_t size) {
    enum { MOST = 4 };
    size_t found = 0, length = 0;
    for (size_t k = 0; k < count; k++) {
        struct topic_object objects[DESCRIBE_MAX_OBJECTS];
        const char *name = has_key(&topics[k], key) ? topics[k].name : NULL;
        const size_t own = mf_describe_objects(topics[k].name, objects);
        for (size_t o = 0; o < own; o++)
            if (strcmp(objects[o].key, key) == 0)
                name = objects[o].topic;
        if (name == NULL || (found > 0 && strstr(text, name)) || found++ > MOST)
            continue;
        length += (size_t)snprintf(text + length, size - length, "%s%.24s", found > 1 ? ", " : "",
                                   found > MOST ? "..." : name);
    }
    return found > 0;
}

static enum status run(const struct command_line *line) {
    char homes[256];
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
    if (print_path(topics, count, line->files[0]))
        return STATUS_OK;
    for (size_t k = 0; k < count; k++)
        names[k] = topics[k].name;
    const char *const dot = strrchr(line->files[0], '.'); // as in "scene.box"
    const char *const key = dot ? dot + 1 : line->files[0];
    if (find_key(topics, count, key, homes, sizeof homes))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "describe: \"%s\" is a key: see mesofit describe %s", key, homes);
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
