// SPDX-License-Identifier: GPL-3.0-or-later
/// @file Elements of H5MD files (version 1.1, https://h5md.nongnu.org): what is stored of particles
/// or of their box, either a dataset, the same for all times, or a group with
///
///   value  [frames, …]: one more dimension than the dataset
///   step   [frames], or a number: that of the first frame is then its attribute "offset", or 0
///   time   likewise; may be missing
///
/// Everything is read frame by frame, and nothing that a file says of sizes is believed before a
/// file of its bytes could hold it. The HDF5 library is not for threads: one at a time.
#pragma once

#include "base/status.h"

#include <hdf5.h>
#include <stdbool.h>

enum { H5MD_MAX_RANK = 2, H5MD_UNIT_SIZE = 64 };

/// A step or time of each frame.
struct h5md_clock {
    hid_t dataset; ///< of numbers for each frame; −1: they are equally spaced
    bool there;
    double begin, increment;
    char unit[H5MD_UNIT_SIZE];
};

struct h5md_element {
    const char *file, *name; ///< borrowed
    bool there;
    bool timed;
    hid_t value;
    int rank;                    ///< of one frame
    hsize_t size[H5MD_MAX_RANK]; ///< of one frame, 1 beyond the rank
    hsize_t frames;              ///< 1 of what is the same for all times
    struct h5md_clock step, time;
    char unit[H5MD_UNIT_SIZE]; ///< "": the file does not say
    hsize_t at;                ///< where the last search ended
};

/// BAD_INPUT with what HDF5 says of its last failure: "file: what: reason".
enum status mf_h5md_element_fail(const char *file, const char *what);

/// Open a group of the file, and of no other that a link would lead to; negative if there is none.
hid_t mf_h5md_element_group(hid_t place, const char *name);

/// A type of texts of `size` bytes, in the characters of `type`, as which HDF5 reads those of fixed
/// length, however long: longer ones are cut. The caller closes it.
hid_t mf_h5md_element_text_type(hid_t type, size_t size);

/// Open an element of a group; `there` is false if the group has none of this name.
/// @param[in] bytes  of the file
/// Fails: BAD_INPUT for what is no element, or of numbers that the file cannot hold.
enum status mf_h5md_element_open(struct h5md_element *element, const char *file, hid_t group,
                                 const char *name, uint64_t bytes) MUST_USE;

void mf_h5md_element_close(struct h5md_element *element);

/// Numbers in one frame.
size_t mf_h5md_element_numbers(const struct h5md_element *element);

/// Read the numbers of a frame as `type`, native doubles or 64-bit integers. Fails: BAD_INPUT.
enum status mf_h5md_element_read(const struct h5md_element *element, hsize_t frame, hid_t type,
                                 void *numbers) MUST_USE;

/// The number of a clock at a frame; NAN if there is no such clock. Fails: BAD_INPUT.
enum status mf_h5md_element_clock(const struct h5md_element *element,
                                  const struct h5md_clock *clock, hsize_t frame,
                                  double *number) MUST_USE;

/// Find the frame of a step, which is not before that of the last search.
/// @param[in] guess  where it is if elements are written together
/// Fails: BAD_INPUT.
enum status mf_h5md_element_find(struct h5md_element *element, double step, hsize_t guess,
                                 bool *found) MUST_USE;
