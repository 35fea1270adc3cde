// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Formulas as text: read as a person writes them, printed plain, for LaTeX and for C.
#pragma once

#include "curves/expression.h"

/// Characters of a printed formula of EXPRESSION_MAX nodes.
enum { EXPRESSION_TEXT_SIZE = 4096 };

/// Read a formula such as "4*(1/r^12 - 1/r^6)" or "12.5*(1 - r/0.99)^2": numbers, r, + - * / ^,
/// exp, sqrt, log (natural), tanh, erf, min(…, …), max, parentheses. "**" is "^" as well; − binds
/// less than ^, and ^ to the right. What stands after ^ must be a number. Fails: BAD_INPUT, with
/// the place, counted from 1, of what is wrong. Tested: test_expression.
enum status mf_expression_parse(struct expression *expression, const char *text) MUST_USE;

/// The same of a variable that is not called r. Tested: test_weight.
enum status mf_expression_parse_of(struct expression *expression, const char *text,
                                   const char *variable) MUST_USE;

enum expression_style {
    EXPRESSION_PLAIN, ///< as mf_expression_parse reads it
    EXPRESSION_LATEX,
    EXPRESSION_C, ///< an expression of the double r; with pow, exp, fmin and others of math.h
};

/// Print a formula into EXPRESSION_TEXT_SIZE characters, its constants with as few digits as give
/// the same number again. Tested: test_expression.
void mf_expression_print(const struct expression *expression, enum expression_style style,
                         char *text);
