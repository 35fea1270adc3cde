// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/live_topics.h"

#include "app/cmd_describe.h"
#include "io/json_write.h"

#include <stdlib.h>
#include <string.h>

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

char *mf_live_topics(void) {
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
