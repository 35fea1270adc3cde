// SPDX-License-Identifier: GPL-3.0-or-later
//
// Small XML files: elements, their text and lines; what is no XML, or could grow without bound.
#include "io/xml.h"
#include "shared/temporary_folder.h"
#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>

static struct xml_document document;

static enum status read(void **state, const char *text) {
    return mf_xml_read(&document, temporary_folder_write(*state, "a.xml", text, strlen(text)));
}

static void test_elements_have_text_and_lines(void **state) {
    assert_ok(read(state, "\xEF\xBB\xBF<?xml version=\"1.0\"?>\n<!-- who -->\n<cg k=\"v\">\r\n"
                          " <pair>\n  <name> A-B\n </name>\n  <max/>\n </pair>\n"
                          " <pair><name>C &lt; &#68;<![CDATA[ & E]]></name></pair> rest\n</cg>\n"));
    const struct xml_element *const pair = mf_xml_find(document.root, "pair");
    assert_string_equal(document.root->name, "cg");
    assert_string_equal(mf_xml_text(document.root, "pair.name"), "A-B");
    assert_string_equal(mf_xml_text(pair, "max"), "");
    assert_int_equal(mf_xml_find(pair, "max")->line, 7);
    assert_string_equal(mf_xml_text(mf_xml_next(pair), "name"), "C < D & E");
    assert_null(mf_xml_next(mf_xml_next(pair)));
    assert_null(mf_xml_find(document.root, "pai"));
    assert_null(mf_xml_find(document.root, "pair.name.x"));
    assert_string_equal(mf_xml_text(NULL, "pair"), "");
    assert_fails(mf_xml_fail(&document, pair, "no %d", 3), STATUS_BAD_INPUT,
                 "a.xml:4: <pair>: no 3");
    mf_xml_clear(&document);
}

static void assert_refused(void **state, const char *text, const char *part) {
    assert_fails(read(state, text), STATUS_BAD_INPUT, part);
    assert_null(document.root);
}

static void test_what_is_no_xml_is_named_with_its_place(void **state) {
    assert_refused(state, "<a>\n<b>\n</a>\n", "a.xml:3:3: no XML: mismatched tag");
    assert_refused(state, "{\"a\": 1}", "a.xml:1:1: no XML");
    assert_refused(state, "<a>\n", "a.xml:2:1: no XML: no element found");
    assert_refused(state, "<a/>\n<b/>", "a.xml:2:1: no XML: junk after document element");
    assert_refused(state, "<a>&e;</a>", "a.xml:1:4: no XML: undefined entity");
    assert_refused(state, "<a>\xff</a>", "a.xml:1:4: no XML: not well-formed");
    assert_int_equal(mf_xml_read(&document, "/nowhere.xml"), STATUS_IO);
}

/// Entities can be of other files, or a billion times as long as their text.
static void test_document_types_are_refused(void **state) {
    assert_refused(state, "<?xml version=\"1.0\"?>\n<!DOCTYPE a SYSTEM \"/etc/passwd\">\n<a/>",
                   "a.xml:2: <!DOCTYPE");
    assert_refused(state,
                   "<!DOCTYPE a [<!ENTITY b \"ha\"><!ENTITY c \"&b;&b;\"><!ENTITY d \"&c;&c;\">]>"
                   "<a>&d;</a>",
                   "a.xml:1: <!DOCTYPE");
}

/// `count` times a text, and then another as often.
static char *repeat(const char *begin, const char *end, int count) {
    char *const text = calloc((strlen(begin) + strlen(end)) * (size_t)count + 16, 1);
    char *at = text + sprintf(text, "<r>\n");
    for (int k = 0; k < count; k++)
        at += sprintf(at, "%s", begin);
    for (int k = 0; k < count; k++)
        at += sprintf(at, "%s", end);
    sprintf(at, "</r>");
    return text;
}

static void test_depth_and_number_are_bounded(void **state) {
    char *text = repeat("<a>", "</a>", XML_DEEPEST);
    assert_refused(state, text, "a.xml:2: <a>: more than 64 elements, one in the other");
    free(text);
    text = repeat("<a>", "</a>", XML_DEEPEST - 1);
    assert_ok(read(state, text));
    mf_xml_clear(&document);
    free(text);
    text = repeat("<a/>", "", XML_MAX_ELEMENTS);
    assert_refused(state, text, "a.xml:2: <a>: more than 100000 elements");
    free(text);
}

#define TEST(name)                                                                                 \
    cmocka_unit_test_setup_teardown(name, temporary_folder_create, temporary_folder_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_elements_have_text_and_lines),
        TEST(test_what_is_no_xml_is_named_with_its_place),
        TEST(test_document_types_are_refused),
        TEST(test_depth_and_number_are_bounded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
