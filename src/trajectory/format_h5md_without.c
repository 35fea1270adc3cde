// SPDX-License-Identifier: GPL-3.0-or-later
//
// What stands for the reader of H5MD where the HDF5 library was not there: files are known, and
// refused with what is to be done.
#include "trajectory/trajectory.h"

#include <string.h>

static bool recognise(const unsigned char *begin, size_t size) {
    return size >= 8 && memcmp(begin, "\x89HDF\r\n\x1A\n", 8) == 0;
}

static enum status open(struct trajectory *trajectory) {
    return mf_status_fail(STATUS_BAD_INPUT,
                          "%s: it is HDF5, which this mesofit was built without: install "
                          "libhdf5-dev (Debian's name) and build it again (make)",
                          trajectory->file);
}

static const char *const extensions[] = {"h5md", "h5", "hdf5", NULL};

const struct trajectory_format mf_format_h5md = {
    .name = "h5md",
    .extensions = extensions,
    .summary = "H5MD, once mesofit is built with the HDF5 library",
    .unit_source = TRAJECTORY_UNITS_GIVEN,
    .state_size = 1,
    .recognise = recognise,
    .open = open,
};
