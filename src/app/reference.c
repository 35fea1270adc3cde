// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/cmd_describe.h"

#include "app/commands.h"
#include "base/fields.h"
#include "base/version.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

/// Of the tables of keys.
static const char *const key_titles[] = {"key", "what", "value", "default", NULL};
enum { CELLS = sizeof key_titles / sizeof *key_titles - 1 };

/// How the parts of a text look in a format.
struct look {
    /// @param[in] level  1: a chapter; 2: a section
    void (*heading)(FILE *stream, int level, const char *text);
    void (*paragraph)(FILE *stream, const char *text);
    /// The head of a table.
    void (*titles)(FILE *stream, const char *const *titles);
    /// A row, with as many cells as titles; an empty cell says nothing.
    void (*row)(FILE *stream, const char *const *titles, const char *const *cells);
    const char *link; ///< printf format: name and place of a section
};

// Markdown ----------------------------------------------------------------------------------------

/// With what would be markup spelled out: `|` parts cells, `<` begins a tag, `*` emphasis.
static void write_markdown(FILE *stream, const char *text) {
    for (bool code = false; *text; text++) {
        code = *text == '`' ? !code : code;
        if (*text == '|' || (!code && (*text == '*' || *text == '<')))
            fputc('\\', stream);
        fputc(*text, stream);
    }
}

static void markdown_heading(FILE *stream, int level, const char *text) {
    fprintf(stream, "\n%s ", level == 1 ? "##" : "###");
    write_markdown(stream, text);
    fprintf(stream, "\n");
}

static void markdown_paragraph(FILE *stream, const char *text) {
    fprintf(stream, "\n");
    write_markdown(stream, text);
    fprintf(stream, "\n");
}

static void markdown_titles(FILE *stream, const char *const *titles) {
    fprintf(stream, "\n"); // a first cell that is never empty needs no bar before it
    for (size_t k = 0; titles[k]; k++)
        fprintf(stream, "%s |%s", titles[k], titles[k + 1] ? " " : "");
    fprintf(stream, "\n");
    for (size_t k = 0; titles[k]; k++)
        fprintf(stream, "---|");
    fprintf(stream, "\n");
}

/// Without the empty cells at the end, which a table needs not.
static void markdown_row(FILE *stream, const char *const *titles, const char *const *cells) {
    size_t last = 1; // a bar makes it a row
    for (size_t k = 0; titles[k]; k++)
        last = cells[k][0] && k > last ? k : last;
    fprintf(stream, "`");
    write_markdown(stream, cells[0]);
    fprintf(stream, "`");
    for (size_t k = 1; k <= last; k++) {
        fprintf(stream, " |%s", cells[k][0] ? " " : "");
        write_markdown(stream, cells[k]);
    }
    fprintf(stream, "\n");
}

static const struct look markdown = {
    .heading = markdown_heading,
    .paragraph = markdown_paragraph,
    .titles = markdown_titles,
    .row = markdown_row,
    .link = "[%s](#%s)",
};

// Man pages ---------------------------------------------------------------------------------------

/// With what would be a command of roff spelled out; a `-` stays one that can be copied, and a line
/// may end after a `|`.
static void write_man(FILE *stream, const char *text) {
    if (*text == '.' || *text == '\'')
        fprintf(stream, "\\&");
    for (; *text; text++)
        switch (*text) {
        case '\\':
            fprintf(stream, "\\e");
            break;
        case '-':
            fprintf(stream, "\\-");
            break;
        case '"':
            fprintf(stream, "\\(dq");
            break;
        case '|':
            fprintf(stream, "|\\:");
            break;
        default:
            fputc(*text, stream);
        }
}

static void man_heading(FILE *stream, int level, const char *text) {
    char shown[128];
    snprintf(shown, sizeof shown, "%s", text);
    for (char *letter = shown; level == 1 && *letter; letter++)
        *letter = (char)toupper((unsigned char)*letter);
    fprintf(stream, ".%s \"", level == 1 ? "SH" : "SS");
    write_man(stream, shown);
    fprintf(stream, "\"\n");
}

static void man_paragraph(FILE *stream, const char *text) {
    fprintf(stream, ".PP\n");
    write_man(stream, text);
    fprintf(stream, "\n");
}

static void man_titles(FILE *stream, const char *const *titles) {
    (void)stream;
    (void)titles;
}

/// What stands after the second cell follows it with its titles: "type number; default 0".
static void man_row(FILE *stream, const char *const *titles, const char *const *cells) {
    const char *between = "";
    fprintf(stream, ".TP\n\\fB");
    write_man(stream, cells[0]);
    fprintf(stream, "\\fR\n");
    write_man(stream, cells[1]);
    fprintf(stream, "\n");
    for (size_t k = 2; titles[k]; k++) {
        if (cells[k][0] == '\0')
            continue;
        fprintf(stream, "%s%s ", between[0] ? between : ".br\n", titles[k]);
        write_man(stream, cells[k]);
        between = "; ";
    }
    fprintf(stream, "%s", between[0] ? "\n" : "");
}

static const struct look man = {
    .heading = man_heading,
    .paragraph = man_paragraph,
    .titles = man_titles,
    .row = man_row,
    .link = "%s",
};

// The text ----------------------------------------------------------------------------------------

static void print_options(FILE *stream, const struct look *look,
                          const struct command_option *option) {
    static const char *const titles[] = {"option", "what", NULL};
    char name[COMMAND_OPTION_SIZE];
    look->titles(stream, titles);
    for (; option->name; option++)
        look->row(stream, titles,
                  (const char *const[]){mf_command_option_text(option, name), option->help});
}

static void print_commands(FILE *stream, const struct look *look) {
    static const char *const titles[] = {"command", "what", NULL};
    char text[128];
    look->heading(stream, 1, "Commands");
    look->titles(stream, titles);
    for (size_t k = 0; mf_command_list[k]; k++) {
        snprintf(text, sizeof text, "mesofit %s %s", mf_command_list[k]->name,
                 mf_command_list[k]->usage);
        look->row(stream, titles, (const char *const[]){text, mf_command_list[k]->summary});
    }
    look->heading(stream, 1, "Options");
    print_options(stream, look, mf_command_common);
    for (size_t k = 0; mf_command_list[k]; k++) {
        if (mf_command_list[k]->options == NULL)
            continue;
        snprintf(text, sizeof text, "Options of %s", mf_command_list[k]->name);
        look->heading(stream, 2, text);
        print_options(stream, look, mf_command_list[k]->options);
    }
    look->heading(stream, 1, "Exit status");
    look->paragraph(stream, mf_command_exit_codes);
}

/// What a key takes: "number [lambda], above 0".
static void print_field(FILE *stream, const struct look *look, const struct field *field) {
    char type[256], fallback[64], range[64], value[512];
    mf_fields_type_text(field, type, sizeof type);
    mf_fields_default_text(field, fallback, sizeof fallback);
    mf_fields_range_text(field, range, sizeof range);
    const bool has_unit = field->unit[0], has_range = strcmp(range, "any") != 0;
    snprintf(value, sizeof value, "%s%s%s%s%s%s", type, has_unit ? " [" : "", field->unit,
             has_unit ? "]" : "", has_range ? ", " : "", has_range ? range : "");
    look->row(stream, key_titles,
              (const char *const[CELLS]){
                  field->name, field->help, value,
                  field->type == FIELD_CHOICE || strcmp(fallback, "none") != 0 ? fallback : ""});
}

static const struct topic *find_topic(const struct topic *topics, size_t count, const char *name) {
    for (size_t k = 0; k < count; k++)
        if (strcmp(topics[k].name, name) == 0)
            return &topics[k];
    return NULL;
}

/// The place of a topic's section, or where there is none of a group's chapter.
static void refer(char *text, size_t size, const struct look *look, const char *name,
                  const struct topic *topics, size_t count) {
    char place[64];
    snprintf(place, sizeof place, "%s%s", find_topic(topics, count, name) ? "" : "keys-", name);
    snprintf(text, size, look->link, name, place);
}

/// The table of a topic's own keys, and of the objects in it.
static void print_keys(FILE *stream, const struct look *look, const struct topic *topic,
                       const struct topic *topics, size_t count) {
    struct topic_object objects[DESCRIBE_MAX_OBJECTS];
    const size_t object_count = mf_describe_objects(topic->name, objects);
    char place[128];
    bool begun = false;
    for (size_t t = 0; topic->tables[t]; t++) {
        const struct topic *home = mf_describe_home(topics, count, topic->tables[t]);
        if (home && home != topic)
            continue;
        for (const struct field *field = topic->tables[t]; field->name; field++, begun = true) {
            if (!begun)
                look->titles(stream, key_titles);
            print_field(stream, look, field);
        }
    }
    if (object_count > 0 && !begun)
        look->titles(stream, key_titles);
    for (size_t k = 0; k < object_count; k++) {
        const struct topic *inner = find_topic(topics, count, objects[k].topic);
        const bool repeats = inner && strcmp(inner->summary, objects[k].help) == 0;
        refer(place, sizeof place, look, objects[k].topic, topics, count);
        look->row(
            stream, key_titles,
            (const char *const[CELLS]){objects[k].key, repeats ? "" : objects[k].help, place, ""});
    }
}

static void print_topic(FILE *stream, const struct look *look, const struct topic *topic,
                        const struct topic *topics, size_t count) {
    char text[256], place[128];
    size_t used = 0;
    look->heading(stream, 2, topic->name);
    look->paragraph(stream, topic->summary);
    print_keys(stream, look, topic, topics, count);
    // What several topics share stands in one section.
    for (size_t t = 0; topic->tables[t]; t++) {
        const struct topic *home = mf_describe_home(topics, count, topic->tables[t]);
        if (home == NULL || home == topic)
            continue;
        refer(place, sizeof place, look, home->name, topics, count);
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%s",
                                 used ? ", " : "Keys as in ", place);
    }
    if (used)
        look->paragraph(stream, text);
}

static void print_topics(FILE *stream, const struct look *look, const struct topic *topics,
                         size_t count) {
    char title[64];
    for (size_t k = 0; k < count; k++) {
        if (k == 0 || strcmp(topics[k].group, topics[k - 1].group) != 0) {
            snprintf(title, sizeof title, "Keys: %s", topics[k].group);
            look->heading(stream, 1, title);
        }
        print_topic(stream, look, &topics[k], topics, count);
    }
}

static void print_body(FILE *stream, const struct look *look, const struct topic *topics,
                       size_t count) {
    print_commands(stream, look);
    look->heading(stream, 1, "Files");
    look->paragraph(
        stream,
        "Run files (section \"run\") and scene files (\"scene\") are strict JSON. Laws are chosen "
        "by "
        "{\"law\": …}, {\"law\": \"none\"} for none, \"dynamics\" by {\"integrator\": …}, "
        "\"method\" by {\"name\": …}. Units are reduced: energy k_B T_0, length lambda, mass mu, "
        "time tau = lambda sqrt(mu/(k_B T_0)). With \"units\" at its top a file is in nm, ps, u, "
        "kJ/mol, K, bar, or angstrom, fs, g/mol, kcal/mol, K, atm, and lengths and strengths of "
        "laws have no defaults unless \"units\" gives the length.");
    print_topics(stream, look, topics, count);
}

void mf_reference_print_markdown(FILE *stream, const struct topic *topics, size_t count) {
    fprintf(stream, "# Reference\n\nBy `make docs`; also the man page `mesofit(1)`. `mesofit "
                    "describe TOPIC` has all keys of a section.\nFiles that runs write are in "
                    "[results.md](results.md).\n");
    print_body(stream, &markdown, topics, count);
}

void mf_reference_print_man(FILE *stream, const struct topic *topics, size_t count) {
    fprintf(stream, ".TH MESOFIT 1 \"\" \"mesofit %s\" \"User Commands\"\n", mf_version);
    man.heading(stream, 1, "Name");
    fprintf(stream, "mesofit \\- %s\n", mf_command_purpose);
    man.heading(stream, 1, "Synopsis");
    for (size_t k = 0; mf_command_list[k]; k++) {
        fprintf(stream, "%s.B mesofit %s\n", k ? ".br\n" : "", mf_command_list[k]->name);
        write_man(stream, mf_command_list[k]->usage);
        fprintf(stream, " [option ...]\n");
    }
    print_body(stream, &man, topics, count);
}
