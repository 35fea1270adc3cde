// SPDX-License-Identifier: GPL-3.0-or-later
/// @file A number with its standard error, for a person.
#pragma once

enum { NUMBER_TEXT_SIZE = 48 };

/// "2.581(34)": the error has two digits and stands in units of the last digit of the value.
/// Without an error (0 or not finite) the value has four significant digits. Tested:
/// test_number_text.
void mf_number_text(double value, double error, char text[NUMBER_TEXT_SIZE]);
