// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/xml.h"

#include "base/growing.h"
#include "io/text_file.h"

#include <expat.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

// expat 2.9 warns of the names that those before have alone.
#if XML_MAJOR_VERSION == 2 && XML_MINOR_VERSION < 9
#define XML_GetCurrentLineNumber64 XML_GetCurrentLineNumber
#define XML_GetCurrentColumnNumber64 XML_GetCurrentColumnNumber
#endif

struct reading {
    struct xml_document *document;
    XML_Parser parser;
    struct xml_element *at; ///< that is open, or NULL
    size_t depth, elements;
    size_t capacity[XML_DEEPEST + 1]; ///< of the texts that are open
    size_t length[XML_DEEPEST + 1];
    enum status status; ///< of what expat does not know of
};

static void stop(struct reading *reading, enum status status) {
    reading->status = status;
    XML_StopParser(reading->parser, XML_FALSE);
}

static size_t line_of(const struct reading *reading) {
    return XML_GetCurrentLineNumber64(reading->parser);
}

static void add_child(struct reading *reading, struct xml_element *element) {
    struct xml_element *const parent = reading->at;
    element->parent = parent;
    if (parent == NULL)
        reading->document->root = element;
    else if (parent->last)
        parent->last->next = element;
    else
        parent->child = element;
    if (parent)
        parent->last = element;
}

static bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

/// Add to the open element's text, which ends with a NUL; what stands around children is dropped.
static enum status append(struct reading *reading, const char *text, size_t length) {
    struct xml_element *const at = reading->at;
    size_t *const used = &reading->length[reading->depth];
    while (*used == 0 && length > 0 && is_blank(*text))
        text++, length--;
    if (at->child)
        return STATUS_OK;
    TRY(mf_growing_reserve(&at->text, &reading->capacity[reading->depth], *used, *used + length + 1,
                           1, 16));
    memcpy(at->text + *used, text, length);
    *used += length;
    at->text[*used] = '\0';
    return STATUS_OK;
}

static enum status begin(struct reading *reading, const char *name) {
    if (reading->depth == XML_DEEPEST || ++reading->elements > XML_MAX_ELEMENTS)
        return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: <%.60s>: more than %d elements%s",
                              reading->document->file, line_of(reading), name,
                              reading->depth == XML_DEEPEST ? XML_DEEPEST : XML_MAX_ELEMENTS,
                              reading->depth == XML_DEEPEST ? ", one in the other" : "");
    struct xml_element *element;
    TRY_ARRAY(element, 1);
    add_child(reading, element);
    element->line = line_of(reading);
    reading->at = element;
    reading->depth++;
    reading->capacity[reading->depth] = reading->length[reading->depth] = 0;
    TRY_ARRAY(element->name, strlen(name) + 1);
    memcpy(element->name, name, strlen(name) + 1);
    return append(reading, "", 0);
}

static void XMLCALL on_begin(void *context, const char *name, const char **attributes) {
    struct reading *const reading = context;
    (void)attributes;
    if (reading->status != STATUS_OK)
        return;
    const enum status status = begin(reading, name);
    if (status != STATUS_OK)
        stop(reading, status);
}

static void XMLCALL on_text(void *context, const char *text, int length) {
    struct reading *const reading = context;
    if (reading->status != STATUS_OK)
        return;
    const enum status status = append(reading, text, (size_t)length);
    if (status != STATUS_OK)
        stop(reading, status);
}

static void XMLCALL on_end(void *context, const char *name) {
    struct reading *const reading = context;
    (void)name;
    if (reading->status != STATUS_OK)
        return;
    char *const text = reading->at->text;
    size_t length = strlen(text);
    while (length > 0 && is_blank(text[length - 1]))
        text[--length] = '\0';
    reading->at = reading->at->parent;
    reading->depth--;
}

static void XMLCALL on_document_type(void *context, const char *name, const char *system,
                                     const char *public, int internal) {
    struct reading *const reading = context;
    (void)name, (void)system, (void)public, (void)internal;
    stop(reading, mf_status_fail(STATUS_BAD_INPUT,
                                 "%s:%zu: <!DOCTYPE …> and entities are not read: leave them out",
                                 reading->document->file, line_of(reading)));
}

static enum status parse(struct reading *reading, const char *text, size_t length) {
    XML_Parser const parser = reading->parser;
    XML_SetUserData(parser, reading);
    XML_SetElementHandler(parser, on_begin, on_end);
    XML_SetCharacterDataHandler(parser, on_text);
    XML_SetStartDoctypeDeclHandler(parser, on_document_type);
    if (XML_Parse(parser, text, (int)length, XML_TRUE) == XML_STATUS_OK)
        return STATUS_OK;
    if (reading->status != STATUS_OK)
        return reading->status;
    const enum XML_Error error = XML_GetErrorCode(parser);
    if (error == XML_ERROR_NO_MEMORY)
        return mf_status_fail(STATUS_NO_MEMORY, "%s: no memory", reading->document->file);
    return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu:%zu: no XML: %s", reading->document->file,
                          line_of(reading), (size_t)XML_GetCurrentColumnNumber64(parser) + 1,
                          XML_ErrorString(error));
}

enum status mf_xml_read(struct xml_document *document, const char *file) {
    enum status status = STATUS_OK;
    struct reading reading = {.document = document};
    OWNED char *text = NULL;
    size_t length;
    *document = (struct xml_document){0};
    NEW_ARRAY(document->file, strlen(file) + 1);
    memcpy(document->file, file, strlen(file) + 1);
    CHECK(mf_text_file_read(file, &text, &length));
    reading.parser = XML_ParserCreate(NULL);
    CHECK(reading.parser ? STATUS_OK : mf_status_fail(STATUS_NO_MEMORY, "%s: no memory", file));
    CHECK(parse(&reading, text, length));
done:
    if (reading.parser)
        XML_ParserFree(reading.parser);
    if (status != STATUS_OK)
        mf_xml_clear(document);
    return status;
}

/// The leaves go first: a list may be longer than a stack is deep.
void mf_xml_clear(struct xml_document *document) {
    struct xml_element *element = document->root;
    while (element) {
        if (element->child) {
            struct xml_element *const child = element->child;
            element->child = NULL;
            element = child;
            continue;
        }
        struct xml_element *const after = element->next ? element->next : element->parent;
        mf_memory_free(element->name);
        mf_memory_free(element->text);
        mf_memory_free(element);
        element = after;
    }
    mf_memory_free(document->file);
    *document = (struct xml_document){0};
}

bool mf_xml_is_name(const char *file) {
    const size_t length = strlen(file);
    return length >= 4 && strcmp(file + length - 4, ".xml") == 0;
}

static const struct xml_element *find_name(const struct xml_element *element, const char *name,
                                           size_t length) {
    while (element && (strncmp(element->name, name, length) != 0 || element->name[length] != '\0'))
        element = element->next;
    return element;
}

const struct xml_element *mf_xml_find(const struct xml_element *element, const char *path) {
    while (element && *path) {
        const size_t length = strcspn(path, ".");
        element = find_name(element->child, path, length);
        path += length + (path[length] == '.');
    }
    return element;
}

const struct xml_element *mf_xml_next(const struct xml_element *element) {
    return find_name(element->next, element->name, strlen(element->name));
}

const char *mf_xml_text(const struct xml_element *element, const char *path) {
    const struct xml_element *const found = mf_xml_find(element, path);
    return found ? found->text : "";
}

enum status mf_xml_fail(const struct xml_document *document, const struct xml_element *element,
                        const char *format, ...) {
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: <%.60s>: %s", document->file, element->line,
                          element->name, text);
}
