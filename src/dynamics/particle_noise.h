// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Standard normal numbers that each particle draws in a step, by its id.
#pragma once

#include "base/normal_words.h"
#include "base/rng.h"

struct simulation;

/// Particles that are moved together, and numbers that one of them draws.
enum { PARTICLE_NOISE_BLOCK = NORMAL_WORDS, PARTICLE_NOISE_NUMBERS = 3 };

/// Numbers of the particles begin … begin + count − 1 in this step, count at most
/// PARTICLE_NOISE_BLOCK.
void mf_particle_noise_draw(const struct simulation *simulation, const struct normal_table *normal,
                            enum rng_stream stream, size_t begin, size_t count,
                            double noise[PARTICLE_NOISE_NUMBERS][PARTICLE_NOISE_BLOCK]);
