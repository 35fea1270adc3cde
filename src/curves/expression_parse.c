// SPDX-License-Identifier: GPL-3.0-or-later
//
// Recursive descent: a sum of products of signed powers of atoms.
#include "curves/expression_text.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/// Parentheses and signs inside one another.
enum { MAX_LEVELS = 200 };

struct reader {
    const char *text, *at;
    const char *variable; ///< its name
    struct expression *expression;
    int levels;
};

/// `what` may name the variable by %s.
static enum status fault(const struct reader *reader, const char *what) {
    const char *name = strstr(what, "%s");
    const int before = (int)(name ? name - what : (ptrdiff_t)strlen(what));
    return mf_status_fail(STATUS_BAD_INPUT, "the formula \"%s\", character %zu: %.*s%s%s",
                          reader->text, (size_t)(reader->at - reader->text) + 1, before, what,
                          name ? reader->variable : "", name ? name + 2 : "");
}

static enum status push(struct reader *reader, enum expression_kind kind, double constant) {
    return mf_expression_push(reader->expression, kind, constant)
               ? STATUS_OK
               : fault(reader, "it is too long by here");
}

static void skip_blanks(struct reader *reader) {
    while (isspace((unsigned char)*reader->at))
        reader->at++;
}

/// Whether `token` is next, which is then passed over.
static bool take(struct reader *reader, const char *token) {
    const size_t length = strlen(token);
    skip_blanks(reader);
    if (strncmp(reader->at, token, length) != 0)
        return false;
    reader->at += length;
    return true;
}

static enum status read_sum(struct reader *reader);
static enum status read_signed(struct reader *reader);

static enum status read_number(struct reader *reader) {
    char *end;
    const double value = strtod(reader->at, &end);
    if (!isfinite(value) || strpbrk(reader->at, "xX") == reader->at + 1)
        return fault(reader, "not a decimal number within the range of a double");
    TRY(push(reader, EXPRESSION_CONSTANT, value));
    reader->at = end;
    return STATUS_OK;
}

static enum status read_parentheses(struct reader *reader) {
    TRY(read_sum(reader));
    return take(reader, ")") ? STATUS_OK : fault(reader, "a \")\" is missing");
}

/// Functions by their names; the square root is a power.
static const struct function {
    const char *name;
    enum expression_kind kind;
} functions[] = {{"exp", EXPRESSION_EXP},    {"sqrt", EXPRESSION_POWER}, {"log", EXPRESSION_LOG},
                 {"tanh", EXPRESSION_TANH},  {"erf", EXPRESSION_ERF},    {"min", EXPRESSION_LESSER},
                 {"max", EXPRESSION_GREATER}};

static enum status read_function(struct reader *reader, const struct function *function) {
    const bool root = function->kind == EXPRESSION_POWER;
    if (!take(reader, "("))
        return fault(reader, "expected \"(\" after the name of a function");
    TRY(read_sum(reader));
    if (!root && mf_expression_arguments(function->kind) == 2) {
        if (!take(reader, ","))
            return fault(reader, "expected \",\" and a second argument");
        TRY(read_sum(reader));
    }
    if (!take(reader, ")"))
        return fault(reader, "a \")\" is missing");
    if (root)
        TRY(push(reader, EXPRESSION_CONSTANT, 0.5));
    return push(reader, function->kind, 0);
}

static enum status read_name(struct reader *reader) {
    size_t length = 0;
    while (isalnum((unsigned char)reader->at[length]) || reader->at[length] == '_')
        length++;
    if (length == strlen(reader->variable) && strncmp(reader->at, reader->variable, length) == 0) {
        reader->at += length;
        return push(reader, EXPRESSION_DISTANCE, 0);
    }
    for (size_t k = 0; k < sizeof functions / sizeof *functions; k++)
        if (length == strlen(functions[k].name) &&
            strncmp(reader->at, functions[k].name, length) == 0) {
            reader->at += length;
            return read_function(reader, &functions[k]);
        }
    return fault(reader,
                 "unknown name: only %s, exp, sqrt, log, tanh, erf, min and max are allowed");
}

static enum status read_atom(struct reader *reader) {
    skip_blanks(reader);
    if (take(reader, "("))
        return read_parentheses(reader);
    if (isdigit((unsigned char)*reader->at) || *reader->at == '.')
        return read_number(reader);
    if (isalpha((unsigned char)*reader->at))
        return read_name(reader);
    return fault(reader, *reader->at ? "expected a number, %s, a function or \"(\""
                                     : "it ends where a number, %s, a function or \"(\" is needed");
}

/// What was read since node `begin` becomes one constant, if it is a number.
static bool fold(struct expression *expression, int begin) {
    struct expression part = {0};
    mf_expression_append(&part, expression, begin, expression->length - 1);
    for (int k = 0; k < part.length; k++)
        if (part.node[k].kind == EXPRESSION_DISTANCE)
            return false;
    expression->length = begin;
    return mf_expression_push(expression, EXPRESSION_CONSTANT, mf_expression_value(&part, 0, NULL));
}

static enum status read_power(struct reader *reader) {
    TRY(read_atom(reader));
    if (!take(reader, "^") && !take(reader, "**"))
        return STATUS_OK;
    skip_blanks(reader);
    const char *exponent = reader->at;
    const int begin = reader->expression->length;
    TRY(read_signed(reader));
    if (!fold(reader->expression, begin)) {
        reader->at = exponent;
        return fault(reader, "an exponent must be a number");
    }
    return push(reader, EXPRESSION_POWER, 0);
}

/// −x is (−1) x, and of a number that number.
static enum status read_minus(struct reader *reader) {
    struct expression *expression = reader->expression;
    const int begin = expression->length;
    TRY(push(reader, EXPRESSION_CONSTANT, -1));
    TRY(read_signed(reader));
    if (expression->length == begin + 2 &&
        expression->node[begin + 1].kind == EXPRESSION_CONSTANT) {
        expression->node[begin].constant = -expression->node[begin + 1].constant;
        expression->length--;
        return STATUS_OK;
    }
    return push(reader, EXPRESSION_MULTIPLY, 0);
}

static enum status read_signed(struct reader *reader) {
    if (++reader->levels > MAX_LEVELS)
        return fault(reader, "its parts are nested too deeply");
    if (take(reader, "-"))
        TRY(read_minus(reader));
    else if (take(reader, "+"))
        TRY(read_signed(reader));
    else
        TRY(read_power(reader));
    reader->levels--;
    return STATUS_OK;
}

static enum status read_product(struct reader *reader) {
    TRY(read_signed(reader));
    for (;;) {
        const bool times = take(reader, "*");
        if (!times && !take(reader, "/"))
            return STATUS_OK;
        TRY(read_signed(reader));
        TRY(push(reader, times ? EXPRESSION_MULTIPLY : EXPRESSION_DIVIDE, 0));
    }
}

static enum status read_sum(struct reader *reader) {
    TRY(read_product(reader));
    for (;;) {
        const bool plus = take(reader, "+");
        if (!plus && !take(reader, "-"))
            return STATUS_OK;
        TRY(read_product(reader));
        TRY(push(reader, plus ? EXPRESSION_ADD : EXPRESSION_SUBTRACT, 0));
    }
}

enum status mf_expression_parse_of(struct expression *expression, const char *text,
                                   const char *variable) {
    struct reader reader = {
        .text = text, .at = text, .variable = variable, .expression = expression};
    *expression = (struct expression){0};
    TRY(read_sum(&reader));
    skip_blanks(&reader);
    if (*reader.at)
        return fault(&reader, "expected an operator: + - * / ^");
    return STATUS_OK;
}

enum status mf_expression_parse(struct expression *expression, const char *text) {
    return mf_expression_parse_of(expression, text, "r");
}
