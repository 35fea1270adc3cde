// SPDX-License-Identifier: GPL-3.0-or-later
#include "shared/german.h"

#include "shared/testing.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

bool german_make(const struct temporary_folder *folder) {
    char command[sizeof folder->path + 128];
    snprintf(command, sizeof command, "%s/locales", folder->path);
    assert_int_equal(mkdir(command, 0777), 0);
    assert_int_equal(setenv("LOCPATH", command, 1), 0);
    snprintf(command, sizeof command,
             "localedef -i de_DE -f UTF-8 '%s/locales/de_DE.UTF-8' >/dev/null 2>&1", folder->path);
    if (system(command) != 0) {
        print_message("localedef has no sources of de_DE (Debian: locales): skipped\n");
        return false;
    }
    assert_int_equal(system("test $(LC_ALL=de_DE.UTF-8 locale decimal_point) = ,"), 0);
    return true;
}
