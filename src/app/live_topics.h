// SPDX-License-Identifier: GPL-3.0-or-later
/// @file What `mesofit describe` knows, for the page of the live view.
#pragma once

/// JSON: a list of objects with group, name, summary, objects (key: topic) and fields, by their
/// names: type, unit, default, minimum, maximum, choices (parted by |), help. To be freed with
/// free(); NULL without memory. Tested: test_live.
char *mf_live_topics(void);
