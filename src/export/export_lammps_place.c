// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_lammps_place.h"

#include "base/memory.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/// LAMMPS has no quotes around these, and puts others in the place of what is not ASCII.
static bool is_quotable(const char *path) {
    for (const char *at = path; *at; at++)
        if (strchr("'\"$\n\r", *at) || (unsigned char)*at >= 0x80)
            return false;
    return true;
}

/// The end of a folder's whole path, by which it is called from here; NULL: it is not below, or
/// cannot be said.
static const char *find_name(const char *whole) {
    OWNED char *here = realpath(".", NULL);
    const size_t length = here ? strlen(here) : 0;
    if (whole == NULL || length == 0 || strncmp(whole, here, length) != 0 || whole[length] != '/')
        return NULL;
    return is_quotable(whole + length + 1) ? whole + length + 1 : NULL;
}

void mf_export_lammps_print_place(const char *folder, FILE *stream) {
    OWNED char *whole = realpath(folder, NULL);
    const char *name = find_name(whole);
    fprintf(stream, "variable above string $(!is_file(data.mesofit))\n");
    if (name)
        fprintf(stream,
                "if \"${above} == 1\" then \"print 'data and tables are those in %s'\" &\n"
                "  'shell cd \"%s\"'\n",
                name, name);
    fprintf(stream, "if \"$(is_file(data.mesofit)) == 0\" then &\n  \"print 'data.mesofit is not "
                    "found: start LAMMPS in the folder of this input'\" \"quit 1\"\n\n");
}

void mf_export_lammps_print_return(const char *folder, FILE *stream) {
    OWNED char *whole = realpath(folder, NULL);
    const char *name = find_name(whole);
    if (name == NULL)
        return;
    fprintf(stream, "if \"${above} == 1\" then 'shell cd \"..");
    for (const char *at = strchr(name, '/'); at; at = strchr(at + 1, '/'))
        fprintf(stream, "/..");
    fprintf(stream, "\"'\n");
}
