// SPDX-License-Identifier: GPL-3.0-or-later
#include "observe/green_kubo.h"

#include "base/statistics.h"

#include <math.h>

enum { MAX_BLOCKS = 32, MAX_WINDOWS = 24, SHORTEST_WINDOW = 4 };

enum status mf_green_kubo_init(struct green_kubo *green_kubo, size_t lags, size_t components,
                               size_t samples) {
    *green_kubo = (struct green_kubo){.lags = lags, .components = components};
    if (samples < 2 * lags)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%zu intervals are fewer than two windows of %zu; lower \"lags\", or "
                              "raise \"samples\" of \"measure\"",
                              samples, lags);
    const size_t origins = samples - lags;
    green_kubo->each = (origins + MAX_BLOCKS - 1) / MAX_BLOCKS;
    green_kubo->blocks = origins / green_kubo->each;
    TRY_ARRAY(green_kubo->last, (lags + 1) * components);
    TRY_ARRAY(green_kubo->products, green_kubo->blocks * (lags + 1));
    return STATUS_OK;
}

void mf_green_kubo_clear(struct green_kubo *green_kubo) {
    mf_memory_free(green_kubo->last);
    mf_memory_free(green_kubo->products);
    *green_kubo = (struct green_kubo){0};
}

void mf_green_kubo_add(struct green_kubo *green_kubo, const double *flow) {
    const size_t now = green_kubo->samples++, slots = green_kubo->lags + 1;
    const size_t components = green_kubo->components;
    double *mine = green_kubo->last + now % slots * components;
    for (size_t c = 0; c < components; c++)
        mine[c] = flow[c];
    for (size_t lag = 0; lag <= green_kubo->lags && lag <= now; lag++) {
        const size_t block = (now - lag) / green_kubo->each;
        const double *then = green_kubo->last + (now - lag) % slots * components;
        double sum = 0;
        for (size_t c = 0; c < components; c++)
            sum += mine[c] * then[c];
        if (block < green_kubo->blocks)
            green_kubo->products[block * slots + lag] += sum / (double)components;
    }
}

size_t mf_green_kubo_spans(struct green_kubo *green_kubo, struct memory_span *spans) {
    const size_t slots = green_kubo->lags + 1;
    spans[0] = (struct memory_span){&green_kubo->samples, sizeof green_kubo->samples};
    spans[1] = (struct memory_span){green_kubo->last,
                                    slots * green_kubo->components * sizeof *green_kubo->last};
    spans[2] = (struct memory_span){green_kubo->products,
                                    green_kubo->blocks * slots * sizeof *green_kubo->products};
    return GREEN_KUBO_SPANS;
}

// Results -----------------------------------------------------------------------------------------

/// Blocks of origins whose last window has ended.
static size_t complete_blocks(const struct green_kubo *green_kubo) {
    const size_t lags = green_kubo->lags, samples = green_kubo->samples;
    const size_t blocks = samples > lags ? (samples - lags) / green_kubo->each : 0;
    return blocks < green_kubo->blocks ? blocks : green_kubo->blocks;
}

/// ⟨x_0 x_k⟩ of a block.
static double correlation(const struct green_kubo *green_kubo, size_t block, size_t lag) {
    return green_kubo->products[block * (green_kubo->lags + 1) + lag] / (double)green_kubo->each;
}

/// Mean of I over the second half of a window, in one block.
static double plateau(const struct green_kubo *green_kubo, size_t block, size_t window) {
    double integral = 0.5 * correlation(green_kubo, block, 0), sum = 0;
    for (size_t lag = 0; lag <= window; lag++) {
        integral += lag > 0 ? correlation(green_kubo, block, lag) : 0;
        sum += lag >= window / 2 ? integral : 0;
    }
    return sum / (double)(window - window / 2 + 1);
}

/// Mean over the blocks of what one of them shows, less what another shows.
struct estimate {
    double mean, error;
};

static struct estimate difference(const double *values, const double *others, size_t blocks) {
    double all[MAX_BLOCKS];
    struct running_mean mean = {0};
    for (size_t b = 0; b < blocks; b++) {
        all[b] = values[b] - (others ? others[b] : 0);
        mf_statistics_add(&mean, all[b]);
    }
    return (struct estimate){mean.mean, mf_statistics_correlated_error(all, blocks, 1)};
}

/// What window w shows, with its error: its own noise, that of what the next doubling adds, in
/// which as much may hide, and the largest difference from a longer window.
static struct estimate judge(double (*values)[MAX_BLOCKS], size_t w, size_t windows,
                             size_t blocks) {
    const struct estimate found = difference(values[w], NULL, blocks);
    double lacking = 0, hidden = found.error; // of the longest the next doubling is not known
    for (size_t longer = windows - 1; longer > w; longer--) {
        const struct estimate added = difference(values[longer], values[w], blocks);
        lacking = fmax(lacking, fabs(added.mean));
        hidden = added.error;
    }
    return (struct estimate){found.mean, hypot(found.error, hypot(hidden, lacking))};
}

/// Whether the longest window differs from the one before by less than two errors.
static bool is_at_rest(double (*values)[MAX_BLOCKS], size_t windows, size_t blocks) {
    if (windows < 2)
        return false;
    const struct estimate d = difference(values[windows - 1], values[windows - 2], blocks);
    return fabs(d.mean) <= 2 * d.error;
}

static void write_curves(const struct green_kubo *green_kubo, size_t blocks,
                         const struct green_kubo_curves *curves) {
    double integral[MAX_BLOCKS] = {0}, here[MAX_BLOCKS];
    for (size_t lag = 0; lag <= green_kubo->lags; lag++) {
        for (size_t b = 0; b < blocks; b++) {
            here[b] = correlation(green_kubo, b, lag);
            integral[b] += lag > 0 ? here[b] : 0.5 * here[b];
        }
        const struct estimate i = difference(integral, NULL, blocks);
        const struct estimate c = difference(here, NULL, blocks);
        curves->integral[lag] = i.mean;
        curves->integral_error[lag] = i.error;
        curves->correlation[lag] = c.mean;
        curves->correlation_error[lag] = c.error;
    }
}

struct green_kubo_summary mf_green_kubo_result(const struct green_kubo *green_kubo,
                                               const struct green_kubo_curves *curves) {
    static const double alike = 1.25;
    double values[MAX_WINDOWS][MAX_BLOCKS];
    size_t window[MAX_WINDOWS], windows = 1;
    const size_t blocks = complete_blocks(green_kubo);
    while (windows < MAX_WINDOWS && green_kubo->lags >> windows >= SHORTEST_WINDOW)
        windows++;
    for (size_t w = 0; w < windows; w++) {
        window[w] = green_kubo->lags >> (windows - 1 - w);
        for (size_t b = 0; b < blocks; b++)
            values[w][b] = plateau(green_kubo, b, window[w]);
    }
    if (curves)
        write_curves(green_kubo, blocks, curves);
    if (blocks == 0)
        return (struct green_kubo_summary){.value = NAN, .error = NAN};
    struct estimate found[MAX_WINDOWS] = {{0}};
    double least = INFINITY;
    size_t taken = 0;
    for (size_t w = 0; w < windows; w++) {
        found[w] = judge(values, w, windows, blocks);
        least = fmin(least, found[w].error);
    }
    for (size_t w = 0; w < windows; w++)
        taken = found[w].error <= alike * least ? w : taken;
    return (struct green_kubo_summary){.value = found[taken].mean,
                                       .error = found[taken].error,
                                       .window = window[taken],
                                       .reached = taken + 1 < windows ||
                                                  is_at_rest(values, windows, blocks),
                                       .blocks = (double)blocks};
}
