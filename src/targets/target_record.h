// SPDX-License-Identifier: GPL-3.0-or-later
/// @file The record of a reader of targets: how the object of a kind is read, kept, written back
/// and shown.
///
/// One reader serves all kinds of the same form. A form of its own is a file with a record, and
/// that in the list of target_files.c. Tested: test_target_files.
#pragma once

#include "forces/molecules.h"
#include "io/json_write.h"
#include "problem/targets.h"

struct target_files;

/// What targets are read for.
struct target_scene {
    const struct box *box;
    const struct composition *composition; ///< no types: not known
    const struct molecules *molecules;     ///< or NULL
    const struct units *units;             ///< of the scene: they convert VOTCA's tables
};

/// Some values of a target that stand in one table beside the result.
struct target_table {
    char name[128];                          ///< of its file, without ".tsv"
    size_t part;                             ///< number of the pair type or group
    size_t first, count;                     ///< its values among those of the target; 0: none
    size_t places;                           ///< columns of where they are
    const char *place[2];                    ///< "r[lambda]"
    bool beside, values_beside;              ///< which of them have physical units beside
    const char *place_format, *value_format; ///< NULL: as usual
    const double *given;                     ///< values as the file has them; NULL: the same
};

struct target_record {
    const char *topic, *summary;   ///< of `mesofit describe`
    const char *chief;             ///< key that is proposed where a value is written for the object
    const struct field *fields[4]; ///< of its object, for `describe`; NULL-terminated
    enum observable_form form;     ///< of the kinds that it reads
    const char *kinds[8];          ///< which of these by their names; none: all that no other names
    size_t size;                   ///< of what it keeps of a kind, zeroed before

    /// Read the object of a target, whose struct target_use and settings are read before. Faults go
    /// to the document. Fails: NO_MEMORY.
    enum status (*read)(struct target_files *files, int kind, struct json_object *object,
                        const struct target_scene *scene);
    /// Let follow what does from parameters, and from a composition, that were chosen after it was
    /// read. Faults go to the document. Fails: NO_MEMORY. NULL: nothing does.
    enum status (*complete)(struct target_files *files, int kind, struct json_object *object,
                            const struct target_scene *scene);
    void (*clear)(void *own); ///< NULL: nothing is to be freed
    /// NULL: the first of `fields`, which are at the beginning of what it keeps.
    void (*write)(const struct target_files *files, int kind, struct json_writer *writer);
    /// Values and errors, as a fit takes them.
    struct target (*values)(const struct target_files *files, int kind);
    /// Table of part n, false beyond the last; and where its value number k is. NULL: none.
    bool (*table)(const struct target_files *files, int kind, size_t n, struct target_table *table);
    void (*place)(const struct target_files *files, int kind, const struct target_table *table,
                  size_t k, double at[2]);
};
