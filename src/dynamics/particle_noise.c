// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/particle_noise.h"

#include "base/simd.h"
#include "dynamics/simulation.h"

SIMD_CLONES void
mf_particle_noise_draw(const struct simulation *simulation, const struct normal_table *normal,
                       enum rng_stream stream, size_t begin, size_t count,
                       double noise[PARTICLE_NOISE_NUMBERS][PARTICLE_NOISE_BLOCK]) {
    const uint64_t step = simulation->step, seed = simulation->setup.seed;
    const uint32_t *id = simulation->particles.id + begin;
    const uint32_t low = (uint32_t)step, high = (uint32_t)(step >> 32);
    uint32_t word[PARTICLE_NOISE_NUMBERS][PARTICLE_NOISE_BLOCK];
    for (size_t k = 0; k < count; k++) {
        uint32_t all[4];
        rng_philox_words((uint32_t)seed, (uint32_t)(seed >> 32), low, id[k], high,
                         rng_stream_word(stream, 0), all);
        for (int n = 0; n < PARTICLE_NOISE_NUMBERS; n++)
            word[n][k] = all[n];
    }
    const size_t whole = (count + 3) / 4 * 4;
    for (int n = 0; n < PARTICLE_NOISE_NUMBERS; n++) {
        for (size_t k = count; k < whole; k++)
            word[n][k] = 0;
        normal_of_words(normal, word[n], whole, noise[n]);
    }
}
