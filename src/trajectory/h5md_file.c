// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectory/h5md_file.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

// Units: products of powers -----------------------------------------------------------------------
//
// "nm ps-1", by symbols of the module "units": P. de Buyl, P. H. Colberg and F. Höfling, Comput.
// Phys. Commun. 185, 1546 (2014); https://h5md.nongnu.org.

/// One mole, and one gram in u: CODATA 2018.
#define MOLE 6.02214076e23
#define GRAM 6.02214076208e23

/// Powers of nm, ps and u in a unit.
enum { POWERS = 3 };

static const struct symbol {
    const char *name;
    double factor;
    int power[POWERS];
} symbols[] = {
    {"nm", 1, {1, 0, 0}},
    {"Angstrom", 0.1, {1, 0, 0}},
    {"angstrom", 0.1, {1, 0, 0}},
    {"A", 0.1, {1, 0, 0}},
    {"\xC3\x85", 0.1, {1, 0, 0}},
    {"\xE2\x84\xAB", 0.1, {1, 0, 0}},
    {"pm", 1e-3, {1, 0, 0}},
    {"um", 1e3, {1, 0, 0}},
    {"mm", 1e6, {1, 0, 0}},
    {"cm", 1e7, {1, 0, 0}},
    {"m", 1e9, {1, 0, 0}},
    {"fs", 1e-3, {0, 1, 0}},
    {"ps", 1, {0, 1, 0}},
    {"ns", 1e3, {0, 1, 0}},
    {"us", 1e6, {0, 1, 0}},
    {"ms", 1e9, {0, 1, 0}},
    {"s", 1e12, {0, 1, 0}},
    {"u", 1, {0, 0, 1}},
    {"amu", 1, {0, 0, 1}},
    {"Da", 1, {0, 0, 1}},
    {"kDa", 1e3, {0, 0, 1}},
    {"AKMA", 0.0488882129, {0, 1, 0}}, // sqrt(u Å²/(kcal/mol)), of CHARMM
    {"g", GRAM, {0, 0, 1}},
    {"kg", 1e3 * GRAM, {0, 0, 1}},
    {"mol", MOLE, {0, 0, 0}},
    {"kJ", MOLE, {2, -2, 1}}, // and so kJ mol-1 is u nm² ps⁻²
    {"kcal", 4.184 * MOLE, {2, -2, 1}},
    {"eV", 96.4853321233, {2, -2, 1}},
    {"N", 6.02214076208e11, {1, -2, 1}},
};

static const struct {
    const char *name;
    int power[POWERS];
} kinds[] = {[H5MD_LENGTH] = {"a length", {1, 0, 0}},
             [H5MD_TIME] = {"a time", {0, 1, 0}},
             [H5MD_SPEED] = {"a speed", {1, -1, 0}},
             [H5MD_FORCE] = {"a force", {1, -2, 1}},
             [H5MD_MASS] = {"a mass", {0, 0, 1}}};

static const struct symbol *find_symbol(const char *name, size_t length) {
    for (size_t k = 0; k < sizeof symbols / sizeof *symbols; k++)
        if (strlen(symbols[k].name) == length && strncmp(symbols[k].name, name, length) == 0)
            return &symbols[k];
    return NULL;
}

/// One factor of the product, "ps-1": a symbol and its power. @return where it ends; NULL if the
/// symbol is not known.
static const char *read_factor(const char *at, double *factor, int power[POWERS]) {
    const size_t length = strcspn(at, " +-0123456789");
    const struct symbol *const symbol = find_symbol(at, length);
    const char *end = at + length;
    long times = 1;
    if (*end != '\0' && *end != ' ')
        times = strtol(end, (char **)&end, 10);
    if (symbol == NULL || (*end != '\0' && *end != ' ') || labs(times) > 9)
        return NULL;
    *factor *= pow(symbol->factor, (double)times);
    for (int k = 0; k < POWERS; k++)
        power[k] += (int)times * symbol->power[k];
    return end;
}

enum status mf_h5md_unit_find(const char *unit, enum h5md_kind kind, double *factor) {
    int power[POWERS] = {0};
    *factor = 1;
    for (const char *at = unit + strspn(unit, " "); *at; at += strspn(at, " ")) {
        at = read_factor(at, factor, power);
        if (at == NULL)
            return mf_status_fail(STATUS_BAD_INPUT, "the unit \"%.60s\" is not known", unit);
    }
    for (int k = 0; k < POWERS; k++)
        if (power[k] != kinds[kind].power[k])
            return mf_status_fail(STATUS_BAD_INPUT, "the unit \"%.60s\" is not that of %s", unit,
                                  kinds[kind].name);
    return STATUS_OK;
}

// The file ----------------------------------------------------------------------------------------

enum { NAMES_SIZE = 512 };

static enum status fail(const char *file, const char *what) {
    return mf_status_fail(STATUS_BAD_INPUT, "%s: %s", file, what);
}

void mf_h5md_file_close(struct h5md_file *h5md) {
    struct h5md_element *const all[] = {&h5md->position, &h5md->velocity, &h5md->force,
                                        &h5md->image,    &h5md->id,       &h5md->mass,
                                        &h5md->species,  &h5md->edges};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        mf_h5md_element_close(all[k]);
    if (h5md->group > 0)
        H5Gclose(h5md->group);
    if (h5md->file > 0)
        H5Fclose(h5md->file);
    *h5md = (struct h5md_file){0};
}

// Which particles ---------------------------------------------------------------------------------

static bool has_positions(hid_t particles, const char *name) {
    const hid_t group = mf_h5md_element_group(particles, name);
    const bool has = group >= 0 && H5Lexists(group, "position", H5P_DEFAULT) > 0;
    if (group >= 0)
        H5Gclose(group);
    return has;
}

/// The groups of particles that have positions: how many, the last, and all of their names.
struct groups {
    size_t count;
    char last[NAMES_SIZE], names[NAMES_SIZE];
};

static void list_groups(hid_t particles, struct groups *groups) {
    H5G_info_t info = {.nlinks = 0};
    H5Gget_info(particles, &info);
    for (hsize_t k = 0; k < info.nlinks; k++) {
        char name[NAMES_SIZE];
        const size_t length = strlen(groups->names);
        if (H5Lget_name_by_idx(particles, ".", H5_INDEX_NAME, H5_ITER_INC, k, name, sizeof name,
                               H5P_DEFAULT) < 0 ||
            !has_positions(particles, name))
            continue;
        groups->count++;
        snprintf(groups->last, NAMES_SIZE, "%s", name);
        snprintf(groups->names + length, NAMES_SIZE - length, "%s\"%.200s\"", length ? ", " : "",
                 name);
    }
}

static enum status choose_group(struct h5md_file *h5md, hid_t particles, const char *file,
                                const char *wanted) {
    struct groups groups = {0};
    list_groups(particles, &groups);
    const bool known = wanted && H5Lexists(particles, wanted, H5P_DEFAULT) > 0;
    if (groups.count == 0)
        return fail(file, "no group of \"particles\" in this file has positions");
    if (wanted && !(known && has_positions(particles, wanted)))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: no group of particles with positions is called \"%s\"; there is "
                              "%s",
                              file, wanted, groups.names);
    if (!wanted && groups.count > 1)
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: there are several groups of particles, %s: choose one by --file-group", file,
            groups.names);
    h5md->group = mf_h5md_element_group(particles, wanted ? wanted : groups.last);
    return h5md->group >= 0 ? STATUS_OK : fail(file, "the particles are not a group of this file");
}

static enum status open_group(struct h5md_file *h5md, const char *file, const char *wanted) {
    if (H5Lexists(h5md->file, "particles", H5P_DEFAULT) <= 0)
        return fail(file, "HDF5, but not H5MD: there is no group \"particles\" (NetCDF-4 becomes "
                          "readable NetCDF-3 by nccopy -6)");
    const hid_t particles = mf_h5md_element_group(h5md->file, "particles");
    if (particles < 0)
        return fail(file, "\"particles\" is not a group of this file");
    const enum status status = choose_group(h5md, particles, file, wanted);
    H5Gclose(particles);
    return status;
}

// What is known of them ---------------------------------------------------------------------------

/// Elements that have as many numbers for each particle as said.
static enum status check_sizes(const struct h5md_file *h5md) {
    const struct h5md_element *const position = &h5md->position;
    const struct {
        const struct h5md_element *element;
        hsize_t numbers;
    } all[] = {{&h5md->velocity, 3}, {&h5md->force, 3}, {&h5md->image, 3},
               {&h5md->id, 1},       {&h5md->mass, 1},  {&h5md->species, 1}};
    if (position->rank != 2 || position->size[1] != 3 || position->size[0] < 1)
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: \"position\" has frames of %llu times %llu numbers; it should "
                              "have 3 of each particle",
                              position->file, (unsigned long long)position->size[0],
                              (unsigned long long)position->size[1]);
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) {
        const struct h5md_element *const element = all[k].element;
        if (element->there && (element->size[0] != position->size[0] ||
                               element->size[1] != all[k].numbers || element->frames < 1))
            return mf_status_fail(STATUS_BAD_INPUT,
                                  "%s: \"%s\" has %llu frames of %llu times %llu numbers; "
                                  "\"position\" has %llu particles",
                                  element->file, element->name, (unsigned long long)element->frames,
                                  (unsigned long long)element->size[0],
                                  (unsigned long long)element->size[1],
                                  (unsigned long long)position->size[0]);
    }
    return STATUS_OK;
}

/// Whether each of the three texts of "boundary" says "periodic"; all do if there is no such
/// attribute.
static void read_boundary(hid_t box, bool periodic[3]) {
    char texts[3][32] = {"periodic", "periodic", "periodic"};
    if (H5Aexists(box, "boundary") > 0) {
        const hid_t attribute = H5Aopen(box, "boundary", H5P_DEFAULT);
        const hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute);
        const bool three = H5Sget_simple_extent_npoints(space) == 3;
        char *variable[3] = {NULL};
        if (three && H5Tis_variable_str(type) > 0 && H5Aread(attribute, type, variable) >= 0) {
            for (int i = 0; i < 3; i++)
                snprintf(texts[i], sizeof texts[i], "%s", variable[i] ? variable[i] : "");
            H5Dvlen_reclaim(type, space, H5P_DEFAULT, variable);
        } else if (three && H5Tget_class(type) == H5T_STRING) {
            const hid_t own = mf_h5md_element_text_type(type, sizeof texts[0]);
            H5Aread(attribute, own, texts);
            H5Tclose(own);
        }
        H5Sclose(space);
        H5Tclose(type);
        H5Aclose(attribute);
    }
    for (int i = 0; i < 3; i++)
        periodic[i] = strncmp(texts[i], "none", 4) != 0;
}

static enum status open_box(struct h5md_file *h5md, const char *file) {
    if (H5Lexists(h5md->group, "box", H5P_DEFAULT) <= 0)
        return STATUS_OK;
    const hid_t box = mf_h5md_element_group(h5md->group, "box");
    if (box < 0)
        return fail(file, "\"box\" is not a group of this file");
    read_boundary(box, h5md->periodic);
    const enum status status = mf_h5md_element_open(&h5md->edges, file, box, "edges", h5md->bytes);
    H5Gclose(box);
    TRY(status);
    const struct h5md_element *const edges = &h5md->edges;
    const bool vector = edges->rank == 1 && edges->size[0] == 3,
               matrix = edges->rank == 2 && edges->size[0] == 3 && edges->size[1] == 3;
    if (edges->there && !vector && !matrix)
        return fail(file, "expected 3 lengths or 3 vectors in \"edges\" of the box");
    return STATUS_OK;
}

static enum status open_elements(struct h5md_file *h5md, const char *file) {
    const struct {
        struct h5md_element *element;
        const char *name;
    } all[] = {{&h5md->position, "position"},
               {&h5md->velocity, "velocity"},
               {&h5md->force, "force"},
               {&h5md->image, "image"},
               {&h5md->id, "id"},
               {&h5md->mass, "mass"},
               {&h5md->species, "species"}};
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        TRY(mf_h5md_element_open(all[k].element, file, h5md->group, all[k].name, h5md->bytes));
    TRY(check_sizes(h5md));
    return open_box(h5md, file);
}

// Units -------------------------------------------------------------------------------------------

/// That of a text of the file; what is there stays if it is "".
static enum status find_unit(const char *file, const char *name, const char *unit,
                             enum h5md_kind kind, double *factor) {
    if (unit[0] == '\0')
        return STATUS_OK;
    const enum status status = mf_h5md_unit_find(unit, kind, factor);
    return status == STATUS_OK ? status : mf_status_prefix(status, "%s: \"%s\"", file, name);
}

static enum status find_units(struct h5md_file *h5md, struct trajectory *trajectory) {
    struct trajectory_scale *const scale = &trajectory->scale;
    const char *const file = trajectory->file;
    const bool given = scale->length > 0, says = h5md->position.unit[0] != '\0';
    if (given && says)
        return mf_status_fail(STATUS_BAD_INPUT, "%s: the file has positions in \"%s\"", file,
                              h5md->position.unit);
    if (!given)
        *scale = (struct trajectory_scale){1, 1, 1, 1, 1};
    if (!given && !says)
        snprintf(trajectory->note, sizeof trajectory->note,
                 "%.200s: has no unit of positions: nm, ps and u are assumed (--file-units)", file);
    TRY(find_unit(file, "position", h5md->position.unit, H5MD_LENGTH, &scale->length));
    TRY(find_unit(file, "time", h5md->position.time.unit, H5MD_TIME, &scale->time));
    if (!given)
        scale->speed = scale->length / scale->time;
    TRY(find_unit(file, "velocity", h5md->velocity.unit, H5MD_SPEED, &scale->speed));
    if (trajectory->forces && h5md->force.there && says && h5md->force.unit[0] == '\0')
        return fail(file, "\"force\" has no unit: its values want the attribute \"unit\", as \"kJ "
                          "mol-1 nm-1\"");
    TRY(find_unit(file, "force", h5md->force.unit, H5MD_FORCE, &scale->force));
    h5md->edge_length = scale->length;
    TRY(find_unit(file, "edges", h5md->edges.unit, H5MD_LENGTH, &h5md->edge_length));
    h5md->mass_unit = scale->mass;
    return find_unit(file, "mass", h5md->mass.unit, H5MD_MASS, &h5md->mass_unit);
}

enum status mf_h5md_file_open(struct h5md_file *h5md, struct trajectory *trajectory) {
    const char *const file = trajectory->file;
    struct stat is;
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL); // what fails is told by our own lines
    if (trajectory->source.unpack || stat(file, &is) != 0 || !S_ISREG(is.st_mode))
        return fail(file, "HDF5 is read from files only, neither compressed nor a pipe");
    *h5md = (struct h5md_file){.bytes = (uint64_t)is.st_size, .periodic = {true, true, true}};
    h5md->file = H5Fopen(file, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (h5md->file < 0)
        return mf_h5md_element_fail(file, "HDF5 cannot open it; it may be truncated");
    TRY(open_group(h5md, file, trajectory->group));
    TRY(open_elements(h5md, file));
    return find_units(h5md, trajectory);
}

void mf_h5md_file_species(const struct h5md_file *h5md, int64_t species,
                          char name[STRUCTURE_NAME]) {
    const hid_t type = H5Dget_type(h5md->species.value);
    snprintf(name, STRUCTURE_NAME, "%lld", (long long)species);
    if (H5Tget_class(type) == H5T_ENUM) {
        const hid_t base = H5Tget_super(type);
        int64_t value = species;
        char found[64];
        if (H5Tconvert(H5T_NATIVE_INT64, base, 1, &value, NULL, H5P_DEFAULT) >= 0 &&
            H5Tenum_nameof(type, &value, found, sizeof found) >= 0)
            snprintf(name, STRUCTURE_NAME, "%.*s", STRUCTURE_NAME - 1, found);
        H5Tclose(base);
    }
    H5Tclose(type);
}
