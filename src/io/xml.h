// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Small XML files, as settings of other programs: elements and their text, parsed by expat.
///
/// A document type is refused: with it go entities, external files and texts that grow without
/// bound. Attributes, comments and the text around child elements are not kept.
#pragma once

#include "base/status.h"

#include <stdbool.h>
#include <stddef.h>

enum { XML_DEEPEST = 64, XML_MAX_ELEMENTS = 100000 };

struct xml_document {
    char *file;
    struct xml_element {
        char *name;
        char *text;  ///< of its own, without blanks at both ends; "" if there is none
        size_t line; ///< where it begins
        struct xml_element *parent, *child, *next; ///< first child, next of the same parent
        struct xml_element *last;                  ///< last child
    } * root;
};

/// Fails: IO; BAD_INPUT with file, line and column for what is no XML, and with file and line for a
/// document type, elements deeper than XML_DEEPEST, more than XML_MAX_ELEMENTS; NO_MEMORY.
/// Tested: test_xml.
enum status mf_xml_read(struct xml_document *document, const char *file) MUST_USE;

void mf_xml_clear(struct xml_document *document);

/// Whether the file is called as XML is: "….xml".
bool mf_xml_is_name(const char *file);

/// The first element that a path of names leads to, as "inverse.target"; NULL if there is none, or
/// `element` is NULL.
const struct xml_element *mf_xml_find(const struct xml_element *element, const char *path);

/// The next element of the same name and parent, or NULL.
const struct xml_element *mf_xml_next(const struct xml_element *element);

/// The text at a path, or "".
const char *mf_xml_text(const struct xml_element *element, const char *path);

/// BAD_INPUT of an element: "file:line: <name>: …".
enum status mf_xml_fail(const struct xml_document *document, const struct xml_element *element,
                        const char *format, ...)
    __attribute__((format(printf, 3, 4), warn_unused_result));
