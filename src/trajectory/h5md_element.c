// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/h5md_element.h"

#include <math.h>
#include <string.h>

/// Compression makes of a file at most so many bytes from each of its own: deflate 1032.
enum { MAX_COMPRESSION = 2000, CHUNKS_IN_MEMORY = 1 << 26 };

// What HDF5 says ----------------------------------------------------------------------------------

static herr_t take_reason(unsigned n, const H5E_error2_t *error, void *reason) {
    if (n == 0)
        snprintf(reason, 200, "%s", error->desc);
    return 0;
}

enum status mf_h5md_element_fail(const char *file, const char *what) {
    char reason[200] = "HDF5 gives no reason";
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_reason, reason);
    return mf_status_fail(STATUS_BAD_INPUT, "%s: %s: %s", file, what, reason);
}

static enum status fail(const struct h5md_element *element, const char *what) {
    return mf_status_fail(STATUS_BAD_INPUT, "%s: \"%s\" %s", element->file, element->name, what);
}

// Opening -----------------------------------------------------------------------------------------

/// A file could name any other of its reader's, which would be taken for coordinates, or a pipe.
static herr_t refuse(const char *from, const char *group, const char *to, const char *object,
                     unsigned *access, hid_t how, void *context) {
    (void)from, (void)group, (void)to, (void)object, (void)access, (void)how, (void)context;
    return -1;
}

/// How to open what is in this file: no link is followed into another one.
static hid_t access_here(hid_t class) {
    const hid_t access = H5Pcreate(class);
    H5Pset_elink_cb(access, refuse, NULL);
    return access;
}

hid_t mf_h5md_element_group(hid_t place, const char *name) {
    const hid_t access = access_here(H5P_GROUP_ACCESS), group = H5Gopen(place, name, access);
    H5Pclose(access);
    return group;
}

static bool is_of_numbers(hid_t dataset) {
    const hid_t type = H5Dget_type(dataset);
    const H5T_class_t kind = H5Tget_class(type);
    H5Tclose(type);
    return kind == H5T_FLOAT || kind == H5T_INTEGER || kind == H5T_ENUM;
}

hid_t mf_h5md_element_text_type(hid_t type, size_t size) {
    const hid_t own = H5Tcopy(H5T_C_S1);
    H5Tset_size(own, size);
    H5Tset_cset(own, H5Tget_cset(type));
    return own;
}

/// The text of an attribute, of fixed or variable length; "" if there is none.
static void read_text(hid_t object, const char *name, char *text, size_t size) {
    text[0] = '\0';
    if (H5Aexists(object, name) <= 0)
        return;
    const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
    const hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
    char fixed[H5MD_UNIT_SIZE] = "", *variable = NULL;
    if (H5Tget_class(type) == H5T_STRING && H5Sget_simple_extent_npoints(space) == 1) {
        if (H5Tis_variable_str(type) > 0 && H5Aread(attribute, type, &variable) >= 0 && variable) {
            snprintf(text, size, "%s", variable);
            H5free_memory(variable);
        } else if (H5Tis_variable_str(type) == 0) {
            const hid_t own = mf_h5md_element_text_type(type, sizeof fixed);
            if (H5Aread(attribute, own, fixed) >= 0)
                snprintf(text, size, "%s", fixed);
            H5Tclose(own);
        }
    }
    H5Sclose(space);
    H5Tclose(type);
    H5Aclose(attribute);
}

static enum status read_number(const struct h5md_element *element, hid_t dataset, double *number) {
    if (!is_of_numbers(dataset) ||
        H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, number) < 0)
        return fail(element, "has a step or time that is not a number");
    return STATUS_OK;
}

/// The number before the first increment.
static void read_offset(hid_t dataset, double *begin) {
    if (H5Aexists(dataset, "offset") <= 0)
        return;
    const hid_t attribute = H5Aopen(dataset, "offset", H5P_DEFAULT);
    const hid_t space = H5Aget_space(attribute);
    if (H5Sget_simple_extent_npoints(space) == 1)
        H5Aread(attribute, H5T_NATIVE_DOUBLE, begin);
    H5Sclose(space);
    H5Aclose(attribute);
}

/// Open a dataset whose numbers are in this file, with room for the chunks that a frame is in, so
/// that each is unpacked once. It is negative if there is none.
static enum status open_dataset(const struct h5md_element *element, hid_t place, const char *name,
                                hid_t *dataset) {
    const hid_t access = access_here(H5P_DATASET_ACCESS);
    H5Pset_chunk_cache(access, 10007, CHUNKS_IN_MEMORY, 1);
    *dataset = H5Dopen(place, name, access);
    H5Pclose(access);
    if (*dataset < 0)
        return STATUS_OK;
    const hid_t how = H5Dget_create_plist(*dataset);
    const bool here = H5Pget_external_count(how) == 0 && H5Pget_layout(how) != H5D_VIRTUAL;
    H5Pclose(how);
    return here ? STATUS_OK : fail(element, "has its numbers in other files, which are not read");
}

static enum status open_clock(const struct h5md_element *element, hid_t group, const char *name,
                              struct h5md_clock *clock) {
    *clock = (struct h5md_clock){.dataset = -1};
    if (H5Lexists(group, name, H5P_DEFAULT) <= 0)
        return STATUS_OK;
    TRY(open_dataset(element, group, name, &clock->dataset));
    const hid_t dataset = clock->dataset;
    if (dataset < 0)
        return fail(element, "has a step or time that is not a dataset of this file");
    const hid_t space = H5Dget_space(dataset);
    const int rank = H5Sget_simple_extent_ndims(space);
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    enum status status = STATUS_OK;
    H5Sclose(space);
    clock->there = true;
    read_text(dataset, "unit", clock->unit, sizeof clock->unit);
    if (rank == 0) {
        status = read_number(element, dataset, &clock->increment);
        read_offset(dataset, &clock->begin);
        H5Dclose(dataset);
        clock->dataset = -1;
    } else if (rank != 1 || count != (hssize_t)element->frames || !is_of_numbers(dataset)) {
        status = fail(element, "does not have one step and one time for each frame");
    }
    return status;
}

/// Sizes of a frame and the number of them.
static enum status find_sizes(struct h5md_element *element, uint64_t bytes) {
    hsize_t size[H5MD_MAX_RANK + 1] = {1, 1, 1};
    const hid_t space = H5Dget_space(element->value);
    const int rank = H5Sget_simple_extent_ndims(space), first = element->timed ? 1 : 0;
    const bool fits = rank >= first && rank <= H5MD_MAX_RANK + first;
    if (fits)
        H5Sget_simple_extent_dims(space, size, NULL);
    H5Sclose(space);
    if (!fits || !is_of_numbers(element->value))
        return fail(element,
                    "is not an array of numbers, of one or two dimensions and optionally frames");
    element->frames = element->timed ? size[0] : 1;
    element->rank = rank - first;
    double all = sizeof(float);
    for (int k = 0; k < H5MD_MAX_RANK; k++) {
        element->size[k] = k < element->rank ? size[k + first] : 1;
        all *= (double)element->size[k];
    }
    if (all > MAX_COMPRESSION * (double)bytes)
        return fail(element, "has more numbers in a frame than fit into the file");
    return STATUS_OK;
}

static enum status open_timed(struct h5md_element *element, hid_t group, uint64_t bytes) {
    element->timed = true;
    if (H5Lexists(group, "value", H5P_DEFAULT) > 0)
        TRY(open_dataset(element, group, "value", &element->value));
    if (element->value < 0)
        return fail(element, "is a group without a dataset \"value\" of this file");
    TRY(find_sizes(element, bytes));
    TRY(open_clock(element, group, "step", &element->step));
    return open_clock(element, group, "time", &element->time);
}

enum status mf_h5md_element_open(struct h5md_element *element, const char *file, hid_t group,
                                 const char *name, uint64_t bytes) {
    enum status status = STATUS_OK;
    *element = (struct h5md_element){
        .file = file, .name = name, .value = -1, .step = {.dataset = -1}, .time = {.dataset = -1}};
    if (H5Lexists(group, name, H5P_DEFAULT) <= 0)
        return STATUS_OK;
    const hid_t access = access_here(H5P_LINK_ACCESS), object = H5Oopen(group, name, access);
    H5Pclose(access);
    const H5I_type_t kind = object < 0 ? H5I_BADID : H5Iget_type(object);
    element->there = true;
    if (kind == H5I_GROUP)
        status = open_timed(element, object, bytes);
    else if (kind == H5I_DATASET) {
        status = open_dataset(element, group, name, &element->value);
        if (status == STATUS_OK)
            status = find_sizes(element, bytes);
    } else
        status = fail(element, "is neither a group nor a dataset of this file");
    if (object >= 0)
        H5Oclose(object);
    if (status == STATUS_OK)
        read_text(element->value, "unit", element->unit, sizeof element->unit);
    else
        mf_h5md_element_close(element);
    return status;
}

static void close_dataset(hid_t dataset) {
    if (dataset > 0)
        H5Dclose(dataset);
}

void mf_h5md_element_close(struct h5md_element *element) {
    close_dataset(element->value);
    close_dataset(element->step.dataset);
    close_dataset(element->time.dataset);
    *element = (struct h5md_element){.value = -1};
}

// Reading -----------------------------------------------------------------------------------------

size_t mf_h5md_element_numbers(const struct h5md_element *element) {
    return (size_t)(element->size[0] * element->size[1]);
}

/// Read a stretch of `count` numbers along the dimensions after the first.
static herr_t read_slab(hid_t dataset, hsize_t frame, const hsize_t *size, int rank, hid_t type,
                        void *numbers) {
    hsize_t begin[H5MD_MAX_RANK + 1] = {frame}, count[H5MD_MAX_RANK + 1] = {1}, all = 1;
    for (int k = 0; k < rank; k++) {
        count[k + 1] = size[k];
        all *= size[k];
    }
    const hid_t in_file = H5Dget_space(dataset), in_memory = H5Screate_simple(1, &all, NULL);
    herr_t result = H5Sselect_hyperslab(in_file, H5S_SELECT_SET, begin, NULL, count, NULL);
    if (result >= 0)
        result = H5Dread(dataset, type, in_memory, in_file, H5P_DEFAULT, numbers);
    H5Sclose(in_memory);
    H5Sclose(in_file);
    return result;
}

enum status mf_h5md_element_read(const struct h5md_element *element, hsize_t frame, hid_t type,
                                 void *numbers) {
    const herr_t result =
        element->timed
            ? read_slab(element->value, frame, element->size, element->rank, type, numbers)
            : H5Dread(element->value, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers);
    char what[128];
    snprintf(what, sizeof what, "frame %llu: \"%.40s\" cannot be read", (unsigned long long)frame,
             element->name);
    return result >= 0 ? STATUS_OK : mf_h5md_element_fail(element->file, what);
}

enum status mf_h5md_element_clock(const struct h5md_element *element,
                                  const struct h5md_clock *clock, hsize_t frame, double *number) {
    char what[128];
    *number = clock->there ? clock->begin + (double)frame * clock->increment : NAN;
    if (clock->dataset < 0 ||
        read_slab(clock->dataset, frame, NULL, 0, H5T_NATIVE_DOUBLE, number) >= 0)
        return STATUS_OK;
    snprintf(what, sizeof what, "frame %llu: step or time of \"%.40s\" cannot be read",
             (unsigned long long)frame, element->name);
    return mf_h5md_element_fail(element->file, what);
}

enum status mf_h5md_element_find(struct h5md_element *element, double step, hsize_t guess,
                                 bool *found) {
    double own = NAN;
    *found = !element->timed;
    if (!element->timed)
        return STATUS_OK;
    if (guess < element->frames) {
        TRY(mf_h5md_element_clock(element, &element->step, guess, &own));
        *found = own == step || isnan(own) || isnan(step);
        if (*found)
            element->at = guess;
    }
    while (!*found && element->at < element->frames) {
        TRY(mf_h5md_element_clock(element, &element->step, element->at, &own));
        if (own >= step) {
            *found = own == step;
            return STATUS_OK;
        }
        element->at++;
    }
    return STATUS_OK;
}
