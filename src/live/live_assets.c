// SPDX-License-Identifier: GPL-3.0-or-later
#include "live/live_assets.h"

#include <string.h>

/// Put a file between two labels; the assembler finds it in the folders that the Makefile names.
#define INCLUDE(name, file)                                                                        \
    __asm__(".section .rodata\n"                                                                   \
            "live_" #name ": .incbin \"" file "\"\n"                                               \
            "live_" #name "_end: .byte 0\n"                                                        \
            ".previous\n");                                                                        \
    extern const unsigned char name[] __asm__("live_" #name);                                      \
    extern const unsigned char name##_end[] __asm__("live_" #name "_end");

#define HTML "text/html; charset=utf-8"
#define SCRIPT "text/javascript; charset=utf-8"
#define PICTURE "image/svg+xml"
#define STYLE "text/css; charset=utf-8"
#define TEXT "text/plain; charset=utf-8"

/// Name here, path in the page, file, type.
#define ASSETS(EACH)                                                                               \
    EACH(index, "/", "index.html", HTML)                                                           \
    EACH(icon, "/icon.svg", "icon.svg", PICTURE)                                                   \
    EACH(style, "/style.css", "style.css", STYLE)                                                  \
    EACH(app, "/app.js", "app.js", SCRIPT)                                                         \
    EACH(server, "/server.js", "server.js", SCRIPT)                                                \
    EACH(tables, "/tables.js", "tables.js", SCRIPT)                                                \
    EACH(plots, "/plots.js", "plots.js", SCRIPT)                                                   \
    EACH(curves, "/curves.js", "curves.js", SCRIPT)                                                \
    EACH(individuals, "/individuals.js", "individuals.js", SCRIPT)                                 \
    EACH(population, "/population.js", "population.js", SCRIPT)                                    \
    EACH(candidate, "/candidate.js", "candidate.js", SCRIPT)                                       \
    EACH(film, "/film.js", "film.js", SCRIPT)                                                      \
    EACH(maps, "/maps.js", "maps.js", SCRIPT)                                                      \
    EACH(particles, "/particles.js", "particles.js", SCRIPT)                                       \
    EACH(bonds, "/bonds.js", "bonds.js", SCRIPT)                                                   \
    EACH(shaders, "/shaders.js", "shaders.js", SCRIPT)                                             \
    EACH(settings, "/settings.js", "settings.js", SCRIPT)                                          \
    EACH(files, "/files.js", "files.js", SCRIPT)                                                   \
    EACH(chart, "/chart.js", "chart.min.js", SCRIPT)                                               \
    EACH(licences, "/licences.txt", "licences.txt", TEXT)

#define INCLUDE_FILE(name, path, file, type) INCLUDE(name, file)
ASSETS(INCLUDE_FILE)

#define RECORD(name, path, file, type) {path, type, name, name##_end},
static const struct live_asset assets[] = {ASSETS(RECORD)};

const struct live_asset *mf_live_assets_find(const char *path) {
    for (size_t k = 0; k < sizeof assets / sizeof *assets; k++)
        if (strcmp(assets[k].path, path) == 0)
            return &assets[k];
    return NULL;
}
