// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/completion.h"

#include "app/commands.h"

#include <string.h>

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

void mf_completion_print(FILE *stream, const struct topic *topics, size_t count) {
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
