// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/h5md_file.h"

#include "base/memory.h"

#include <string.h>

enum { TEXT = 64, MOST_TEXTS = 1 << 20, NAME_SIZE = 1024 };

/// Texts of a dataset or an attribute, each cut where it is longer than any name.
struct texts {
    char (*text)[TEXT];
    size_t count;
};

/// Numbers of the particles of a kind of molecules, as doubles.
enum property { MASS, NAME, RESIDUE, RESIDUE_NAME, PROPERTIES };
static const char *const properties[] = {"mass", "particle_name", "residue_id", "residue_name"};

/// The topology of one kind, of which a molecule has `atoms` particles.
struct kind {
    size_t atoms;
    double *number[PROPERTIES]; ///< NULL: the file does not say
    struct texts names, residue_names;
};

static enum status fail(const char *file, const char *what, const char *name) {
    return mf_status_fail(STATUS_BAD_INPUT, "%s: its topology: \"%s\" %s", file, name, what);
}

// Texts -------------------------------------------------------------------------------------------

/// What reads an attribute or a dataset.
static herr_t read_any(hid_t object, bool attribute, hid_t type, void *to) {
    return attribute ? H5Aread(object, type, to)
                     : H5Dread(object, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, to);
}

static enum status take_variable(hid_t object, bool attribute, hid_t type, hid_t space,
                                 struct texts *texts) {
    OWNED char **variable = NULL;
    TRY_ARRAY(variable, texts->count);
    if (read_any(object, attribute, type, variable) < 0)
        return STATUS_BAD_INPUT;
    for (size_t k = 0; k < texts->count; k++)
        snprintf(texts->text[k], TEXT, "%s", variable[k] ? variable[k] : "");
    H5Dvlen_reclaim(type, space, H5P_DEFAULT, variable);
    return STATUS_OK;
}

/// BAD_INPUT, without a message, for what are no texts.
static enum status take_texts(hid_t object, bool attribute, hid_t type, hid_t space,
                              struct texts *texts) {
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    if (H5Tget_class(type) != H5T_STRING || count < 1 || count > MOST_TEXTS)
        return STATUS_BAD_INPUT;
    texts->count = (size_t)count;
    texts->text = mf_memory_zeroed(texts->count, sizeof *texts->text);
    if (texts->text == NULL)
        return STATUS_NO_MEMORY;
    if (H5Tis_variable_str(type) > 0)
        return take_variable(object, attribute, type, space, texts);
    const hid_t own = mf_h5md_element_text_type(type, TEXT);
    const herr_t result = read_any(object, attribute, own, texts->text);
    H5Tclose(own);
    for (size_t k = 0; k < texts->count; k++)
        texts->text[k][TEXT - 1] = '\0';
    return result < 0 ? STATUS_BAD_INPUT : STATUS_OK;
}

static enum status read_texts(const char *file, hid_t group, const char *name, bool attribute,
                              struct texts *texts) {
    const hid_t object =
        attribute ? H5Aopen(group, name, H5P_DEFAULT) : H5Dopen(group, name, H5P_DEFAULT);
    if (object < 0)
        return fail(file, "is missing", name);
    const hid_t type = attribute ? H5Aget_type(object) : H5Dget_type(object),
                space = attribute ? H5Aget_space(object) : H5Dget_space(object);
    const enum status status = take_texts(object, attribute, type, space, texts);
    H5Sclose(space);
    H5Tclose(type);
    if (attribute)
        H5Aclose(object);
    else
        H5Dclose(object);
    return status == STATUS_BAD_INPUT ? fail(file, "are no texts that can be read", name) : status;
}

// Kinds -------------------------------------------------------------------------------------------

static void clear_kind(struct kind *kind) {
    for (int k = 0; k < PROPERTIES; k++)
        mf_memory_free(kind->number[k]);
    mf_memory_free(kind->names.text);
    mf_memory_free(kind->residue_names.text);
    *kind = (struct kind){0};
}

static enum status read_property(const struct h5md_file *h5md, const char *file, hid_t group,
                                 enum property property, struct kind *kind) {
    struct h5md_element element;
    TRY(mf_h5md_element_open(&element, file, group, properties[property], h5md->bytes));
    enum status status = STATUS_OK;
    const size_t count = element.there ? (size_t)element.size[0] : 0;
    if (element.there && (element.timed || element.rank != 1 || count < 1 ||
                          (kind->atoms > 0 && kind->atoms != count)))
        status = fail(file, "is not one number of each particle", properties[property]);
    else if (element.there) {
        kind->atoms = count;
        kind->number[property] = mf_memory_zeroed(count, sizeof(double));
        status = kind->number[property]
                     ? mf_h5md_element_read(&element, 0, H5T_NATIVE_DOUBLE, kind->number[property])
                     : STATUS_NO_MEMORY;
    }
    mf_h5md_element_close(&element);
    return status;
}

/// Numbers that are places in a table of texts.
static enum status check_places(const char *file, const struct kind *kind, enum property property,
                                const struct texts *texts) {
    for (size_t k = 0; k < kind->atoms; k++)
        if (!(kind->number[property][k] >= 0 && kind->number[property][k] < (double)texts->count))
            return fail(file, "is not of its table", properties[property]);
    return STATUS_OK;
}

static enum status read_kind(const struct h5md_file *h5md, const char *file, hid_t group,
                             struct kind *kind) {
    for (int k = 0; k < PROPERTIES; k++)
        TRY(read_property(h5md, file, group, (enum property)k, kind));
    if (kind->number[NAME]) {
        TRY(read_texts(file, group, "particle_name_table", false, &kind->names));
        TRY(check_places(file, kind, NAME, &kind->names));
    }
    if (kind->number[RESIDUE] && kind->number[RESIDUE_NAME]) {
        TRY(read_texts(file, group, "residue_name_table", false, &kind->residue_names));
        TRY(check_places(file, kind, RESIDUE_NAME, &kind->residue_names));
    }
    return kind->atoms > 0 ? STATUS_OK : fail(file, "has no particle", "a molecule");
}

// Structure ---------------------------------------------------------------------------------------

static void place_atom(const struct h5md_file *h5md, const struct kind *kind, size_t k,
                       struct structure_atom *atom) {
    if (kind->number[MASS])
        atom->mass = kind->number[MASS][k] * h5md->mass_unit;
    if (kind->names.text)
        snprintf(atom->name, STRUCTURE_NAME, "%.*s", STRUCTURE_NAME - 1,
                 kind->names.text[(size_t)kind->number[NAME][k]]);
    if (kind->residue_names.text) {
        atom->residue_number = (int64_t)kind->number[RESIDUE][k];
        snprintf(atom->residue_name, STRUCTURE_NAME, "%.*s", STRUCTURE_NAME - 1,
                 kind->residue_names.text[(size_t)kind->number[RESIDUE_NAME][k]]);
    }
}

/// Where molecules have been placed.
struct placing {
    size_t atoms;
    int64_t molecules;
    bool fits; ///< so far there were atoms for all
};

static void place_kind(const struct h5md_file *h5md, const struct kind *kind, int64_t count,
                       struct structure *structure, struct placing *placing) {
    const size_t left = structure->atoms - placing->atoms;
    placing->fits = placing->fits && count >= 0 && (uint64_t)count <= left / kind->atoms;
    for (int64_t n = 0; placing->fits && n < count; n++) {
        placing->molecules++;
        for (size_t k = 0; k < kind->atoms; k++) {
            struct structure_atom *const atom = &structure->atom[placing->atoms++];
            place_atom(h5md, kind, k, atom);
            atom->molecule = placing->molecules;
        }
    }
    structure->has_masses = structure->has_masses || kind->number[MASS];
    structure->has_names = structure->has_names || kind->names.text;
    structure->has_residues = structure->has_residues || kind->residue_names.text;
}

/// Blocks of molecules, each of one kind, by the names of these and how many there are.
static enum status place_blocks(const struct h5md_file *h5md, const char *file, hid_t group,
                                const struct texts *blocks, const int64_t *counts,
                                struct structure *structure, struct placing *placing) {
    for (size_t k = 0; k < blocks->count; k++) {
        struct kind kind = {0};
        const hid_t own = mf_h5md_element_group(group, blocks->text[k]);
        if (own < 0)
            return fail(file, "is not there", blocks->text[k]);
        const enum status status = read_kind(h5md, file, own, &kind);
        H5Gclose(own);
        if (status == STATUS_OK)
            place_kind(h5md, &kind, counts[k], structure, placing);
        clear_kind(&kind);
        TRY(status);
    }
    placing->fits = placing->fits && placing->atoms == structure->atoms;
    return STATUS_OK;
}

static enum status read_counts(const char *file, hid_t group, size_t count, int64_t *counts) {
    static const char name[] = "molecule_block_counts";
    const hid_t attribute = H5Aopen(group, name, H5P_DEFAULT);
    if (attribute < 0)
        return fail(file, "is missing", name);
    const hid_t space = H5Aget_space(attribute);
    const bool fits = H5Sget_simple_extent_npoints(space) == (hssize_t)count;
    const bool good = fits && H5Aread(attribute, H5T_NATIVE_INT64, counts) >= 0;
    H5Sclose(space);
    H5Aclose(attribute);
    return good ? STATUS_OK : fail(file, "is not one number of each block", name);
}

/// Into a structure of its own, which takes the place of the trajectory's if it is of its atoms.
static enum status read_group(const struct h5md_file *h5md, struct trajectory *trajectory,
                              hid_t group, const struct texts *blocks) {
    enum status status;
    struct structure made = {0};
    struct placing placing = {.fits = true};
    int64_t *counts = NULL;
    NEW_ARRAY(counts, blocks->count);
    CHECK(read_counts(trajectory->file, group, blocks->count, counts));
    CHECK(mf_structure_init(&made, trajectory->structure.atoms));
    memcpy(made.atom, trajectory->structure.atom, made.atoms * sizeof *made.atom);
    made.has_masses = trajectory->structure.has_masses;
    made.has_types = trajectory->structure.has_types;
    CHECK(place_blocks(h5md, trajectory->file, group, blocks, counts, &made, &placing));
    made.has_molecules = true;
    if (placing.fits) {
        const struct structure other = trajectory->structure;
        trajectory->structure = made;
        made = other;
    } else if (trajectory->note[0] == '\0')
        snprintf(trajectory->note, sizeof trajectory->note,
                 "%.200s: its topology is of another number of particles and is not used",
                 trajectory->file);
done:
    mf_memory_free(counts);
    mf_structure_clear(&made);
    return status;
}

/// Where the particle stands that a bond is of, which has its id where there are ids.
static uint32_t find_place(const struct structure *structure, int64_t particle) {
    const size_t place = structure->has_ids ? mf_structure_find(structure, particle)
                         : particle >= 0    ? (size_t)particle
                                            : structure->atoms;
    return place < structure->atoms ? (uint32_t)place : UINT32_MAX;
}

/// Whether bonds are of the group of particles that is read: if they say of which one.
static bool are_bonds_of(hid_t connectivity, hid_t group) {
    char own[NAME_SIZE] = "", wanted[NAME_SIZE] = "";
    hobj_ref_t reference;
    const hid_t attribute =
        H5Lexists(connectivity, "bonds", H5P_DEFAULT) > 0 &&
                H5Aexists_by_name(connectivity, "bonds", "particles_group", H5P_DEFAULT) > 0
            ? H5Aopen_by_name(connectivity, "bonds", "particles_group", H5P_DEFAULT, H5P_DEFAULT)
            : -1;
    if (attribute < 0)
        return true;
    const hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
    const bool told = H5Tequal(type, H5T_STD_REF_OBJ) > 0 &&
                      H5Sget_simple_extent_npoints(space) == 1 &&
                      H5Aread(attribute, H5T_STD_REF_OBJ, &reference) >= 0 &&
                      H5Rget_name(connectivity, H5R_OBJECT, &reference, wanted, NAME_SIZE) > 0 &&
                      H5Iget_name(group, own, NAME_SIZE) > 0;
    H5Sclose(space);
    H5Tclose(type);
    H5Aclose(attribute);
    return !told || strcmp(own, wanted) == 0;
}

static enum status read_bonds(const struct h5md_file *h5md, struct trajectory *trajectory,
                              hid_t connectivity) {
    enum status status;
    struct h5md_element bonds;
    int64_t *particle = NULL;
    uint32_t(*bond)[2] = NULL;
    TRY(mf_h5md_element_open(&bonds, trajectory->file, connectivity, "bonds", h5md->bytes));
    const size_t count = bonds.there ? (size_t)bonds.size[0] : 0;
    if (count == 0 || bonds.timed || bonds.rank != 2 || bonds.size[1] != 2) {
        mf_h5md_element_close(&bonds);
        return STATUS_OK;
    }
    NEW_ARRAY(particle, 2 * count);
    NEW_ARRAY(bond, count);
    CHECK(mf_h5md_element_read(&bonds, 0, H5T_NATIVE_INT64, particle));
    for (size_t k = 0; k < 2 * count; k++)
        if ((bond[k / 2][k % 2] = find_place(&trajectory->structure, particle[k])) == UINT32_MAX) {
            status = mf_status_fail(STATUS_BAD_INPUT,
                                    "%s: bond %zu is of a particle %lld, which is not there",
                                    trajectory->file, k / 2 + 1, (long long)particle[k]);
            goto done;
        }
    status = mf_structure_join(&trajectory->structure, (const uint32_t(*)[2])bond, count);
    if (status == STATUS_BAD_INPUT)
        status = mf_status_prefix(status, "%s", trajectory->file);
done:
    mf_memory_free(particle);
    mf_memory_free(bond);
    mf_h5md_element_close(&bonds);
    return status;
}

/// A group by the names on the way to it; negative if there is none.
static hid_t open_path(hid_t place, const char *const *names) {
    hid_t at = place;
    for (size_t k = 0; names[k] && at >= 0; k++) {
        const hid_t next =
            H5Lexists(at, names[k], H5P_DEFAULT) > 0 ? mf_h5md_element_group(at, names[k]) : -1;
        if (at != place)
            H5Gclose(at);
        at = next;
    }
    return at;
}

enum status mf_h5md_topology_read(const struct h5md_file *h5md, struct trajectory *trajectory) {
    static const char *const topology[] = {"h5md", "modules", "gromacs_topology", NULL};
    struct texts blocks = {0};
    enum status status = STATUS_OK;
    const hid_t group = open_path(h5md->file, topology);
    if (group >= 0 && H5Aexists(group, "molecule_block_names") > 0) {
        status = read_texts(trajectory->file, group, "molecule_block_names", true, &blocks);
        if (status == STATUS_OK)
            status = read_group(h5md, trajectory, group, &blocks);
        mf_memory_free(blocks.text);
    }
    if (group >= 0)
        H5Gclose(group);
    return status;
}

enum status mf_h5md_topology_bonds(const struct h5md_file *h5md, struct trajectory *trajectory) {
    static const char *const connectivity[] = {"connectivity", NULL};
    const hid_t bonds =
        trajectory->structure.has_molecules ? -1 : open_path(h5md->file, connectivity);
    if (bonds < 0)
        return STATUS_OK;
    const enum status status =
        are_bonds_of(bonds, h5md->group) ? read_bonds(h5md, trajectory, bonds) : STATUS_OK;
    H5Gclose(bonds);
    return status;
}
