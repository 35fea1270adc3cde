// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/scene_law.h"

#include "base/digest.h"
#include "base/memory.h"
#include "base/names.h"
#include "curves/sampled.h"
#include "curves/sum.h"
#include "curves/weight.h"
#include "io/data_table.h"
#include "io/votca.h"

#include <stdio.h>
#include <string.h>

// One curve ---------------------------------------------------------------------------------------

/// GROMACS's table of a pair (reference manual, "Tabulated interaction functions"): r, then f, g
/// and h, each with its negative derivative, without a name; V = q q f + C6 g + C12 h.
static bool is_of_gromacs(const struct data_table *table) {
    enum { COLUMNS = 7 };
    return table->columns == COLUMNS && mf_data_table_find(table, "r") == 0;
}

/// Move g or h, whichever is not 0, to the second column: a potential of its own has C6 or C12 = 1.
/// The rows of 0 at the beginning are what GROMACS has where nothing comes; the curve goes on
/// there.
static enum status take_gromacs(struct data_table *table, const char *file) {
    enum { F = 1, G = 3, H = 5 };
    size_t some[H + 1] = {0}, first = 0;
    for (size_t k = table->rows; k-- > 0;)
        for (int c = F; c <= H; c += 2)
            some[c] += table->values[k * table->columns + (size_t)c] != 0;
    if (some[F] > 0 || (some[G] > 0) == (some[H] > 0))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: seven columns, as GROMACS has a table of a pair, r f -f' g -g' h "
            "-h', of which f is to be 0 and one of g and h not: write r and the "
            "potential, C6 g + C12 h, in two columns",
            file);
    const size_t of = some[G] > 0 ? G : H;
    while (table->values[first * table->columns + of] == 0)
        first++;
    table->rows -= first;
    for (size_t k = 0; k < table->rows; k++) {
        const double *const from = table->values + (k + first) * table->columns;
        double *const to = table->values + k * table->columns;
        const double r = from[0], potential = from[of];
        to[0] = r;
        to[1] = potential;
        table->line[k] = table->line[k + first];
    }
    return STATUS_OK;
}

/// A table of LAMMPS may say its units in a comment, as its own do (manual, "pair_style table").
static enum status name_lammps_units(struct data_table *table, bool of_angles) {
    static const struct {
        const char *name, *length, *energy;
    } styles[] = {{"real", "A", "kcal/mol"}, {"metal", "A", "eV"}};
    enum { HEADER_SIZE = 64 };
    static const char key[] = "UNITS:";
    const char *at = table->lammps == DATA_LAMMPS_LAW ? strstr(table->comments, key) : NULL;
    if (at == NULL)
        return STATUS_OK;
    at += strlen(key);
    at += strspn(at, " \t");
    for (size_t k = 0; k < sizeof styles / sizeof *styles; k++) {
        const size_t length = strlen(styles[k].name);
        if (strncmp(at, styles[k].name, length) != 0 || strcspn(at, " \t,\n") != length)
            continue;
        mf_memory_free(table->header);
        TRY_ARRAY(table->header, HEADER_SIZE);
        snprintf(table->header, HEADER_SIZE, "q[%s] U[%s] F",
                 of_angles ? "degrees" : styles[k].length, styles[k].energy);
    }
    return STATUS_OK;
}

/// r and Φ, E or ω of a table; only Φ may begin with a core.
static enum status read_columns(const char *file, const char *const unit[2], double min, bool core,
                                const struct units *units, double **x, double **value,
                                size_t *count) {
    CLEARED_BY(mf_data_table_clear) struct data_table table = {0};
    TRY(core ? mf_data_table_read_core(&table, file) : mf_data_table_read(&table, file, 2));
    if (core && is_of_gromacs(&table))
        TRY(take_gromacs(&table, file));
    else if (is_of_gromacs(&table))
        return mf_status_fail(
            STATUS_BAD_INPUT,
            "%s: seven columns without names, as GROMACS has a potential of pairs, "
            "which this is not: leave two, the argument and the values",
            file);
    if (mf_data_table_is_numbered(&table))
        return mf_status_fail(STATUS_BAD_INPUT,
                              "%s: column 1 numbers the rows: leave it out, so that %s is first",
                              file, strcmp(unit[0], "degrees") == 0 ? "the angle" : "r");
    TRY(name_lammps_units(&table, strcmp(unit[0], "degrees") == 0));
    TRY(mf_data_table_check_increasing(&table, file, 0, min));
    TRY(mf_data_table_convert(&table, file, 0, unit[0], units));
    TRY(mf_data_table_convert(&table, file, 1, unit[1], units));
    TRY_ARRAY(*x, table.rows);
    TRY_ARRAY(*value, table.rows);
    for (size_t k = 0; k < table.rows; k++) {
        (*x)[k] = table.values[k * table.columns];
        (*value)[k] = table.values[k * table.columns + 1];
    }
    *count = table.rows;
    return STATUS_OK;
}

enum status mf_scene_read_columns(const char *file, const char *const unit[2], double min,
                                  const struct units *units, double **x, double **value,
                                  size_t *count) {
    return read_columns(file, unit, min, false, units, x, value, count);
}

/// VOTCA's points, from nm and kJ/mol.
static enum status read_votca(const char *file, const struct units *units, double **r,
                              double **value, size_t *count) {
    CLEARED_BY(mf_votca_clear) struct votca_table table = {0};
    TRY(mf_votca_read(&table, file));
    TRY_ARRAY(*r, table.rows);
    TRY_ARRAY(*value, table.rows);
    for (size_t k = 0; k < table.rows; k++) {
        if (table.x[k] < 0)
            return mf_status_fail(STATUS_BAD_INPUT, "%s:%zu: r = %g is negative", file,
                                  table.line[k], table.x[k]);
        (*r)[k] = table.x[k] / units->length;
        (*value)[k] = table.y[k] / mf_units_energy_kj_per_mol(units);
    }
    *count = table.rows;
    return STATUS_OK;
}

/// Points of a table file for a curve of the law "table".
static enum status load_points(struct curve *curve, const char *unit, struct json_object *object,
                               const struct units *units) {
    struct sampled_parameters *parameters = curve->parameters;
    double *r = NULL, *value = NULL;
    size_t count = 0;
    enum status status = STATUS_OK;
    if (parameters->format == SAMPLED_VOTCA && !mf_units_known(units)) {
        mf_json_fault(object, "format", "VOTCA's nm and kJ/mol need \"units\" in the scene");
        return STATUS_OK;
    }
    status = parameters->format == SAMPLED_VOTCA
                 ? read_votca(parameters->file, units, &r, &value, &count)
                 : read_columns(parameters->file, (const char *[]){"lambda", unit}, 0,
                                curve->family == &mf_sampled_family, units, &r, &value, &count);
    if (status != STATUS_OK)
        mf_json_fault(object, "file", "%s", mf_status_marked());
    else if (mf_sampled_set_points(curve, r, value, count) != STATUS_OK)
        mf_json_fault(object, "file", "%s: %s", parameters->file, mf_status_marked());
    mf_memory_free(r);
    mf_memory_free(value);
    return status == STATUS_NO_MEMORY ? status : STATUS_OK;
}

/// A table that could not be loaded has no points, and parameters may not go together: clear the
/// curve, the fault is recorded.
static bool is_usable(const struct curve *curve) {
    if (curve_is_sampled(curve->family))
        return ((const struct sampled_parameters *)curve->parameters)->spline != NULL;
    if (curve->family == &mf_sum_family)
        return ((const struct sum_parameters *)curve->parameters)->parts > 0;
    return mf_curve_check(curve) == STATUS_OK;
}

/// "of": {"core": {"law": …}, …}, the laws of a sum.
static enum status read_parts(struct sum_parameters *sum, struct json_object *object,
                              const struct curve_family *const *list, const struct units *units) {
    const size_t faults = mf_json_fault_count(object->document);
    struct json_object of = mf_json_child(object, "of", true);
    const char *name;
    for (size_t n = 0; of.item && (name = mf_json_key(&of, n)); n++) {
        struct curve part = {0};
        if (sum->parts == SUM_MAX_PARTS || strlen(name) >= SUM_NAME_SIZE) {
            mf_json_fault(&of, name, "expected at most %d laws, with names of at most %d bytes",
                          SUM_MAX_PARTS, SUM_NAME_SIZE - 1);
            break;
        }
        TRY(mf_scene_read_curve(&part, &of, name, list, units));
        strcpy(sum->name[sum->parts], name);
        if (part.family)
            sum->part[sum->parts++] = part;
    }
    if (of.item)
        mf_json_finish(&of);
    if (of.item && sum->parts == 0 && mf_json_fault_count(object->document) == faults)
        mf_json_fault(object, "of", "is empty: expected laws, as {\"core\": {\"law\": …}, …}");
    return STATUS_OK;
}

enum status mf_scene_read_curve(struct curve *curve, struct json_object *parent, const char *key,
                                const struct curve_family *const *list, const struct units *units) {
    const char **names;
    const char *unit = list == mf_curve_potentials ? "k_B T_0"
                       : list == mf_weight_laws    ? ""
                                                   : "sqrt(mu/tau)";
    struct json_object object = mf_json_child_of(parent, key, false, "law");
    if (object.item == NULL)
        return STATUS_OK;
    TRY(mf_names_collect(list, "none", &names));
    const char *law = mf_json_choice(&object, "law", names, NULL);
    mf_memory_free(names);
    const struct curve_family *family = law ? mf_curve_find(list, law) : NULL;
    if (family) {
        const size_t faults = mf_json_fault_count(object.document);
        TRY(mf_curve_create(curve, family));
        mf_json_fields(&object, family->fields, curve->parameters);
        mf_json_fields_need_scale(&object, family->fields);
        if (curve_is_sampled(family) && mf_json_fault_count(object.document) == faults)
            TRY(load_points(curve, unit, &object, units));
        if (family == &mf_sum_family)
            TRY(read_parts(curve->parameters, &object, list, units));
        mf_curve_scale(curve, mf_units_factor(units, "lambda"), mf_units_factor(units, unit));
        if (mf_json_fault_count(object.document) == faults && mf_curve_check(curve) != STATUS_OK)
            mf_json_fault(&object, NULL, "%s", mf_status_marked());
        if (!is_usable(curve))
            mf_curve_clear(curve);
    }
    if (law && list == mf_curve_omegas && mf_json_has(&object, "gamma"))
        mf_json_fault(&object, "gamma",
                      "omega is the square root of a friction: \"sigma\" is sqrt(gamma), and Groot "
                      "and Warren's noise is sqrt(2 k_B T) times that");
    if (law)
        mf_json_finish(&object);
    return STATUS_OK;
}

void mf_scene_write_curve(const struct curve *curve, struct json_writer *writer, const char *key) {
    mf_json_begin(writer, key);
    mf_json_write_text(writer, "law", curve->family ? curve->family->name : "none");
    if (curve->family)
        mf_json_write_fields(writer, curve->family->fields, curve->parameters);
    if (curve->family == &mf_sum_family) {
        const struct sum_parameters *sum = curve->parameters;
        mf_json_begin(writer, "of");
        for (int k = 0; k < sum->parts; k++)
            mf_scene_write_curve(&sum->part[k], writer, sum->name[k]);
        mf_json_end(writer);
    }
    mf_json_end(writer);
}

// A curve for all pairs, or one for each pair type ------------------------------------------------

/// {"A-A": {"law": …}, "A-B": {"law": …}, …}, each pair type once, in any order.
static enum status read_pairs(struct scene_law *law, struct json_object *object,
                              const struct curve_family *const *list,
                              const struct composition *composition, const struct units *units) {
    char name[COMPOSITION_MAX_PAIRS][COMPOSITION_PAIR_NAME_SIZE];
    const char *key[COMPOSITION_MAX_PAIRS];
    const bool known = mf_scene_pair_names_find(object, composition, key);
    for (int pair = 0; pair < mf_composition_pairs(composition); pair++) {
        mf_composition_pair_name(composition, pair, name[pair]);
        if (key[pair])
            TRY(mf_scene_read_curve(&law->curve[pair], object, key[pair], list, units));
        else if (!mf_json_has(object, name[pair]) && known)
            mf_json_fault(object, name[pair],
                          "missing: expected an object, such as {\"law\": \"none\"}");
        if (law->curve[pair].family)
            law->curves = mf_composition_pairs(composition);
    }
    mf_json_finish(object);
    return STATUS_OK;
}

enum status mf_scene_law_read(struct scene_law *law, struct json_object *parent, const char *key,
                              const struct curve_family *const *list,
                              const struct composition *composition, const struct units *units) {
    if (composition->types == 0) {
        mf_json_has(parent,
                    key); // the fault is one of the types: those of their pairs would mislead
        return STATUS_OK;
    }
    if (composition_is_mixed(composition)) {
        struct json_object object = mf_json_child_of(parent, key, false, "law");
        if (object.item == NULL)
            return STATUS_OK;
        if (!mf_json_has(&object, "law"))
            return read_pairs(law, &object, list, composition, units);
    }
    struct json_object only = mf_json_child_of(parent, key, false, "law");
    const char *pair = mf_json_key(&only, 0);
    if (pair && strchr(pair, '-') && !mf_json_has(&only, "law")) {
        mf_json_fault(&only, pair,
                      "pairs are named in mixtures alone, and there is one type: write "
                      "\"%s\": {\"law\": …}",
                      key);
        return STATUS_OK;
    }
    TRY(mf_scene_read_curve(&law->curve[0], parent, key, list, units));
    law->curves = law->curve[0].family != NULL;
    return STATUS_OK;
}

enum status mf_scene_law_tabulate(struct scene_law *law, scene_law_table *tabulate) {
    struct table part[COMPOSITION_MAX_PAIRS] = {{0}};
    enum status status = STATUS_OK;
    if (law->curves <= 1)
        return law->curves ? tabulate(&law->table, &law->curve[0]) : STATUS_OK;
    for (int pair = 0; pair < law->curves; pair++)
        if (law->curve[pair].family)
            CHECK(tabulate(&part[pair], &law->curve[pair]));
    CHECK(mf_table_stack(&law->table, part, law->curves));
done:
    for (int pair = 0; pair < law->curves; pair++)
        mf_table_clear(&part[pair]);
    return status;
}

const struct curve *mf_scene_law_curve(const struct scene_law *law, int pair) {
    const struct curve *curve = &law->curve[law->curves > 1 ? pair : 0];
    return curve->family ? curve : NULL;
}

void mf_scene_law_clear(struct scene_law *law) {
    for (int pair = 0; pair < COMPOSITION_MAX_PAIRS; pair++)
        mf_curve_clear(&law->curve[pair]);
    mf_table_clear(&law->table);
}

void mf_scene_law_write(const struct scene_law *law, const struct composition *composition,
                        struct json_writer *writer, const char *key) {
    if (law->curves <= 1) {
        mf_scene_write_curve(&law->curve[0], writer, key);
        return;
    }
    mf_json_begin(writer, key);
    for (int pair = 0; pair < law->curves; pair++) {
        char name[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(composition, pair, name);
        mf_scene_write_curve(&law->curve[pair], writer, name);
    }
    mf_json_end(writer);
}

void mf_scene_law_digest(const struct scene_law *law, uint64_t *digest) {
    const struct table *table = &law->table;
    const size_t rows = (size_t)table->curves * (TABLE_INTERVALS + 1);
    mf_digest_add(digest, table->coefficient, rows * (size_t)table->terms * sizeof(double));
}

static void fault_unknown(struct json_object *object, const struct composition *composition,
                          const char *key) {
    char names[COMPOSITION_MAX_PAIRS * (COMPOSITION_PAIR_NAME_SIZE + 2)] = "";
    for (int pair = 0; pair < mf_composition_pairs(composition); pair++) {
        char name[COMPOSITION_PAIR_NAME_SIZE];
        mf_composition_pair_name(composition, pair, name);
        strcat(names, pair ? ", " : "");
        strcat(names, name);
    }
    mf_json_fault(object, key, "unknown pair; expected %s", names);
}

bool mf_scene_pair_names_find(struct json_object *object, const struct composition *composition,
                              const char *key[COMPOSITION_MAX_PAIRS]) {
    const char *member;
    bool all = true;
    for (int pair = 0; pair < COMPOSITION_MAX_PAIRS; pair++)
        key[pair] = NULL;
    for (size_t n = 0; (member = mf_json_key(object, n)); n++) {
        const int pair = mf_composition_find_pair(composition, member);
        if (pair >= 0 && key[pair] == NULL) {
            key[pair] = member;
            continue;
        }
        if (pair >= 0)
            mf_json_fault(object, member, "duplicate pair, in both orders");
        else if (mf_json_is_object(object, member))
            fault_unknown(object, composition, member);
        else
            continue;
        mf_json_has(object, member); // it has had its line
        all = false;
    }
    return all;
}

bool mf_scene_pair_names_refuse(struct json_object *object, const struct composition *composition,
                                const char *instead) {
    const char *key;
    for (size_t n = 0; (key = mf_json_key(object, n)); n++) {
        if (!mf_json_is_object(object, key))
            continue;
        mf_json_fault(object, key, "pairs are named in mixtures, and there is only %s; write %s",
                      composition->name[0][0] ? composition->name[0] : "one type", instead);
        return true;
    }
    return false;
}
