// SPDX-License-Identifier: GPL-3.0-or-later
#include "targets/target_forces.h"

#define MEMBER(name) .offset = offsetof(struct target_forces_files, name)
const struct field mf_target_forces_fields[] = {
    {"file", FIELD_FILE, MEMBER(file), .required = true, .unit = "", .help = "forces.tsv"},
    {"gram_file", FIELD_FILE, MEMBER(gram_file), .required = true, .unit = "",
     .help = "forces_gram.tsv"},
    FIELD_END,
};

enum status mf_target_forces_read(struct target_forces *forces, struct json_object *target,
                                  const struct units *units) {
    static const double joules = 1e-3 * UNITS_BOLTZMANN * UNITS_AVOGADRO; // kJ/mol of a kelvin
    struct json_object object = mf_json_child_of(target, "forces", false, "file");
    const size_t faults = mf_json_fault_count(target->document);
    if (object.item == NULL)
        return STATUS_OK;
    forces->given = true;
    mf_json_fields(&object, mf_target_forces_fields, &forces->files);
    mf_json_finish(&object);
    if (!mf_units_known(units))
        mf_json_fault(&object, NULL, "forces are in nm and kJ/mol: the file needs \"units\"");
    if (mf_json_fault_count(target->document) > faults)
        return STATUS_OK;
    const enum status status =
        mf_force_equations_read(&forces->equations, forces->files.file, forces->files.gram_file);
    if (status == STATUS_NO_MEMORY)
        return status;
    if (status != STATUS_OK)
        mf_json_fault(&object, NULL, "%s", mf_status_marked());
    else
        mf_force_equations_scale(&forces->equations, units->length, joules * units->temperature);
    return STATUS_OK;
}

void mf_target_forces_clear(struct target_forces *forces) {
    mf_force_equations_clear(&forces->equations);
}

void mf_target_forces_write(const struct target_forces *forces, struct json_writer *writer) {
    if (!forces->given)
        return;
    mf_json_begin(writer, "forces");
    mf_json_write_fields(writer, mf_target_forces_fields, &forces->files);
    mf_json_end(writer);
}
