// SPDX-License-Identifier: GPL-3.0-or-later
#include "curves/expression_text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/// How tightly a part holds together; a looser one wants parentheses.
enum precedence { SUM, PRODUCT, RAISED, ATOM };

struct printer {
    const struct expression *expression;
    enum expression_style style;
    char *text;
    size_t length;
};

__attribute__((format(printf, 2, 3))) static void append(struct printer *printer,
                                                         const char *format, ...) {
    const size_t capacity = EXPRESSION_TEXT_SIZE - printer->length;
    va_list arguments;
    va_start(arguments, format);
    const int wanted = vsnprintf(printer->text + printer->length, capacity, format, arguments);
    va_end(arguments);
    printer->length += (size_t)wanted < capacity ? (size_t)wanted : capacity - 1;
}

/// A number above 0 with as few digits as give it again.
static void write_number(struct printer *printer, double number) {
    char text[40];
    for (int digits = 1; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, number);
        if (strtod(text, NULL) == number)
            break;
    }
    // 1e+06, where 1000000 is as short.
    if (number == rint(number) && number < 1e6)
        snprintf(text, sizeof text, "%.0f", number);
    char *power = strchr(text, 'e');
    if (printer->style == EXPRESSION_LATEX && power) {
        *power = '\0';
        append(printer, "%s\\cdot 10^{%d}", text, atoi(power + 1));
    } else {
        const bool whole = !power && !strchr(text, '.');
        append(printer, "%s%s", text, printer->style == EXPRESSION_C && whole ? ".0" : "");
    }
}

static const struct expression_node *node_of(const struct printer *printer, int end) {
    return &printer->expression->node[end];
}

/// Where the first argument of a node ends.
static int first_argument(const struct printer *printer, int end) {
    return mf_expression_arguments(node_of(printer, end)->kind) == 2
               ? mf_expression_begin(printer->expression, end - 1) - 1
               : end - 1;
}

/// Whether the text of a part begins with a minus.
static bool is_negative(const struct printer *printer, int end) {
    const struct expression_node *node = node_of(printer, end);
    if (node->kind == EXPRESSION_CONSTANT)
        return node->constant < 0;
    return (node->kind == EXPRESSION_MULTIPLY || node->kind == EXPRESSION_DIVIDE) &&
           is_negative(printer, first_argument(printer, end));
}

static enum precedence precedence_of(const struct printer *printer, int end) {
    switch (node_of(printer, end)->kind) {
    case EXPRESSION_ADD:
    case EXPRESSION_SUBTRACT:
        return SUM;
    case EXPRESSION_MULTIPLY:
    case EXPRESSION_DIVIDE:
        return PRODUCT;
    case EXPRESSION_POWER:
        return printer->style == EXPRESSION_C ? ATOM : RAISED;
    default:
        return ATOM;
    }
}

static void print(struct printer *printer, int end, bool minus_is_printed);

/// A part of at least this tightness, or in parentheses.
static void print_part(struct printer *printer, int end, enum precedence min, bool first) {
    const bool latex = printer->style == EXPRESSION_LATEX;
    const bool loose = precedence_of(printer, end) < min || (!first && is_negative(printer, end));
    append(printer, "%s", !loose ? "" : latex ? "\\left(" : "(");
    print(printer, end, false);
    append(printer, "%s", !loose ? "" : latex ? "\\right)" : ")");
}

static void print_sum(struct printer *printer, int end) {
    const bool adds = node_of(printer, end)->kind == EXPRESSION_ADD;
    const bool minus = is_negative(printer, end - 1);
    print_part(printer, first_argument(printer, end), SUM, true);
    append(printer, adds != minus ? " + " : " - ");
    if (minus)
        print(printer, end - 1, true);
    else
        print_part(printer, end - 1, adds ? SUM : PRODUCT, false);
}

/// −1 before a product is its sign alone.
static void print_product(struct printer *printer, int end, bool minus_is_printed) {
    const int first = first_argument(printer, end);
    const struct expression_node *factor = node_of(printer, first);
    if (factor->kind == EXPRESSION_CONSTANT && factor->constant == -1) {
        append(printer, minus_is_printed ? "" : "-");
    } else {
        if (minus_is_printed)
            print(printer, first, true);
        else
            print_part(printer, first, PRODUCT, true);
        append(printer, printer->style == EXPRESSION_LATEX ? " \\, " : "*");
    }
    print_part(printer, end - 1, PRODUCT, false);
}

static void print_quotient(struct printer *printer, int end, bool minus_is_printed) {
    const bool latex = printer->style == EXPRESSION_LATEX;
    const int first = first_argument(printer, end);
    // A minus stands before the fraction.
    const bool minus = latex && !minus_is_printed && is_negative(printer, first);
    append(printer, "%s%s", minus ? "-" : "", latex ? "\\frac{" : "");
    if (minus || minus_is_printed)
        print(printer, first, true);
    else
        print_part(printer, first, latex ? SUM : PRODUCT, true);
    append(printer, latex ? "}{" : "/");
    print_part(printer, end - 1, latex ? SUM : RAISED, latex);
    append(printer, latex ? "}" : "");
}

static void print_power(struct printer *printer, int end) {
    static const char *const middle[] = {"^", "^{", ", "}, *const after[] = {"", "}", ")"};
    append(printer, printer->style == EXPRESSION_C ? "pow(" : "");
    print_part(printer, first_argument(printer, end), printer->style == EXPRESSION_C ? SUM : ATOM,
               printer->style == EXPRESSION_C);
    append(printer, "%s", middle[printer->style]);
    print(printer, end - 1, false);
    append(printer, "%s", after[printer->style]);
}

/// In each style.
static const char *name_of(enum expression_kind kind, enum expression_style style) {
    static const char *const names[][3] = {[EXPRESSION_EXP] = {"exp", "\\exp", "exp"},
                                           [EXPRESSION_LOG] = {"log", "\\ln", "log"},
                                           [EXPRESSION_TANH] = {"tanh", "\\tanh", "tanh"},
                                           [EXPRESSION_ERF] = {"erf", "\\operatorname{erf}", "erf"},
                                           [EXPRESSION_LESSER] = {"min", "\\min", "fmin"},
                                           [EXPRESSION_GREATER] = {"max", "\\max", "fmax"}};
    return names[kind][style];
}

static void print_function(struct printer *printer, int end) {
    const bool latex = printer->style == EXPRESSION_LATEX;
    const enum expression_kind kind = node_of(printer, end)->kind;
    append(printer, "%s%s", name_of(kind, printer->style), latex ? "\\left(" : "(");
    if (mf_expression_arguments(kind) == 2) {
        print(printer, first_argument(printer, end), false);
        append(printer, ", ");
    }
    print(printer, end - 1, false);
    append(printer, latex ? "\\right)" : ")");
}

/// @param[in] minus_is_printed  the minus that the part begins with has been printed
static void print(struct printer *printer, int end, bool minus_is_printed) {
    const struct expression_node *node = node_of(printer, end);
    switch (node->kind) {
    case EXPRESSION_CONSTANT:
        append(printer, node->constant < 0 && !minus_is_printed ? "-" : "");
        write_number(printer, fabs(node->constant));
        break;
    case EXPRESSION_ADD:
    case EXPRESSION_SUBTRACT:
        print_sum(printer, end);
        break;
    case EXPRESSION_MULTIPLY:
        print_product(printer, end, minus_is_printed);
        break;
    case EXPRESSION_DIVIDE:
        print_quotient(printer, end, minus_is_printed);
        break;
    case EXPRESSION_POWER:
        print_power(printer, end);
        break;
    case EXPRESSION_DISTANCE:
        append(printer, "r");
        break;
    default:
        print_function(printer, end);
    }
}

void mf_expression_print(const struct expression *expression, enum expression_style style,
                         char *text) {
    struct printer printer = {expression, style, text, 0};
    text[0] = '\0';
    if (expression->length > 0)
        print(&printer, expression->length - 1, false);
}
