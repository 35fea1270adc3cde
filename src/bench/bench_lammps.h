// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The same scene in LAMMPS, from the same positions and velocities, timed in turn with ours.
/// A. P. Thompson et al., Comput. Phys. Commun. 271, 108171 (2022).
#pragma once

#include "bench/bench_case.h"

/// Fails: BAD_INPUT with one line if there is no program lmp.
enum status mf_bench_lammps_check(void) MUST_USE;

/// Why a scene is not compared, or NULL if it is: Debian's LAMMPS has pair styles for tables and
/// Lennard-Jones, not for DPD.
const char *mf_bench_lammps_unsupported(const struct scene *scene);

/// Write the input of LAMMPS for the present state of `simulation`, which has no objection, to the
/// files in.bench, start.data and, if the law is a table, pair.table in `folder`.
/// Fails: IO. Tested: test_bench_lammps.
enum status mf_bench_lammps_write(const char *folder, const struct scene *scene,
                                  const struct simulation *simulation) MUST_USE;

/// Steps a second of the last run in what LAMMPS printed, or NaN. Tested: test_bench_lammps.
double mf_bench_lammps_rate(const char *text);

/// Time `bench`, which has begun, and LAMMPS in turn, with the fastest of LAMMPS's variants of the
/// style and the scene's or LAMMPS's usual skin. Fills all of `result`.
/// Fails: IO if LAMMPS fails; INTERRUPTED; as mf_bench_case_repeat.
/// Threads: one at a time, since the environment is changed.
enum status mf_bench_lammps_compare(struct bench_case *bench, const struct bench_scene *scene,
                                    struct bench_result *result) MUST_USE;
