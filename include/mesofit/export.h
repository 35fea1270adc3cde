/* SPDX-License-Identifier: GPL-3.0-or-later */
/** @file What the shared library shows of itself, to C and C++. */
#ifndef MESOFIT_EXPORT_H
#define MESOFIT_EXPORT_H

#ifdef __cplusplus
#define MESOFIT_LANGUAGE extern "C"
#else
#define MESOFIT_LANGUAGE extern
#endif

#define MESOFIT_API MESOFIT_LANGUAGE __attribute__((visibility("default")))

#endif
