// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/commands.h"
#include "app/cmd_describe.h"
#include "io/json_write.h"
#include "live/live_session.h"

#include <stdlib.h>
#include <string.h>

// Topics, for the page ----------------------------------------------------------------------------

static const char *const types[] = {
    [FIELD_NUMBER] = "number",   [FIELD_INTEGER] = "integer", [FIELD_SEED] = "seed",
    [FIELD_LENGTHS] = "lengths", [FIELD_TEXT] = "text",       [FIELD_FILE] = "file",
    [FIELD_CHOICE] = "choice",   [FIELD_CHOICES] = "choices",
};

static void write_choices(struct json_writer *writer, const char *const *choices) {
    char text[1024] = "";
    for (; choices && *choices; choices++) {
        const size_t length = strlen(text);
        snprintf(text + length, sizeof text - length, "%s%s", length ? "|" : "", *choices);
    }
    if (text[0])
        mf_json_write_text(writer, "choices", text);
}

static void write_field(struct json_writer *writer, const struct field *field) {
    mf_json_begin(writer, field->name);
    mf_json_write_text(writer, "type", types[field->type]);
    mf_json_write_text(writer, "unit", field->unit ? field->unit : "");
    mf_json_write_text(writer, "help", field->help ? field->help : "");
    mf_json_write_integer(writer, "required", field->required);
    mf_json_write_number(writer, "default", field->initial);
    mf_json_write_number(writer, "minimum", field->minimum);
    mf_json_write_number(writer, "maximum", field->maximum);
    write_choices(writer, field->choices);
    mf_json_end(writer);
}

static void write_topic(struct json_writer *writer, const struct topic *topic) {
    struct topic_object objects[DESCRIBE_MAX_OBJECTS];
    const size_t count = mf_describe_objects(topic->name, objects);
    mf_json_begin(writer, NULL);
    mf_json_write_text(writer, "group", topic->group);
    mf_json_write_text(writer, "name", topic->name);
    mf_json_write_text(writer, "summary", topic->summary);
    mf_json_begin(writer, "objects");
    for (size_t k = 0; k < count; k++)
        mf_json_write_text(writer, objects[k].key, objects[k].topic);
    mf_json_end(writer);
    mf_json_begin(writer, "fields");
    for (size_t t = 0; topic->tables[t]; t++)
        for (const struct field *field = topic->tables[t]; field->name; field++)
            write_field(writer, field);
    mf_json_end(writer);
    mf_json_end(writer);
}

/// JSON: a list of objects with group, name, summary, objects (key: topic) and fields, by their
/// names: type, unit, default, minimum, maximum, choices (parted by |), help. To be freed with
/// free(); NULL without memory.
static char *live_topics(void) {
    struct topic topics[DESCRIBE_MAX_TOPICS];
    const size_t count = mf_describe_topics(topics);
    char *text = NULL;
    size_t size;
    struct json_writer *writer = mf_json_writer_create_list();
    FILE *stream = writer ? open_memstream(&text, &size) : NULL;
    for (size_t k = 0; stream && k < count; k++)
        write_topic(writer, &topics[k]);
    enum status status = stream ? mf_json_write_stream(writer, stream, "topics") : STATUS_NO_MEMORY;
    if (stream && fclose(stream) != 0)
        status = STATUS_NO_MEMORY;
    mf_json_writer_free(writer);
    if (status == STATUS_OK)
        return text;
    free(text);
    return NULL;
}

enum { START, STAY, PORT };

static const struct command_option options[] = {
    [START] = {"--start", NULL, "start at once, not from the page"},
    [STAY] = {"--stay", NULL, "keep serving after the run"},
    [PORT] = {"--port", "N", "port of 127.0.0.1; else any free one"},
    {NULL, NULL, NULL},
};

static enum status parse_port(const char *text, int *port) {
    char *end;
    const long number = strtol(text, &end, 10);
    if (end == text || *end != '\0' || number < 1 || number > 65535)
        return mf_status_fail(STATUS_BAD_INPUT, "a port is a whole number from 1 to 65535");
    *port = (int)number;
    return STATUS_OK;
}

static enum status serve(struct live_options *live) {
    char *topics = live_topics();
    if (topics == NULL)
        return mf_status_fail(STATUS_NO_MEMORY, "out of memory");
    live->topics = topics;
    const enum status status = mf_live_session(live);
    free(topics);
    return status;
}

static const struct command_option live_option = COMMAND_LIVE_OPTION;

enum status mf_cmd_live_run(const char *file, const struct run_options *run_options,
                            const char *port) {
    struct live_options live = {.subject = file, .run = *run_options, .start = true};
    if (strcmp(port, live_option.name) != 0)
        TRY(parse_port(port, &live.port));
    return serve(&live);
}

static enum status run(const struct command_line *line) {
    struct live_options live = {.subject = line->file_count > 0 ? line->files[0] : NULL,
                                .run = line->options,
                                .start = line->own[START] != NULL,
                                .stay = line->own[STAY] != NULL};
    if (line->own[PORT])
        TRY(parse_port(line->own[PORT], &live.port));
    if (live.start && live.subject == NULL)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "--start takes a scene or a run file to begin with");
    return serve(&live);
}

const struct command cmd_live = {
    .name = "live",
    .usage = "[FILE]",
    .summary = "show and run files and results in a browser",
    .min_files = 0,
    .max_files = 1,
    .options = options,
    .run = run,
};
